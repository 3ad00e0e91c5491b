# make demo | make check | make build; everything else is named in README.md.
BUILD ?= build
SHELL := /bin/bash
.PHONY: all references readme-pictures build program setup demo check check-look verify-ranks check64 clean bench-planar bench-offline bench-online bench-peers bench-scaling bench-subdomains tradeoff totals extremes petsc-options sanitize valgrind install package \
	manual api verification format format-check lint coverage fuzz mutate setup-manual setup-maintain
all: build

setup:
	@bash makefiles/setup.sh

$(BUILD)/build.ninja: CMakeLists.txt | setup
	@cmake -S . -B $(BUILD) -G Ninja >$(BUILD).log 2>&1 || { cat $(BUILD).log; exit 1; }; rm -f $(BUILD).log

build: setup $(BUILD)/build.ninja
	@cmake --build $(BUILD)

program: setup $(BUILD)/build.ninja
	@cmake --build $(BUILD) --target floe

demo: program
	@bash makefiles/demo.sh $(BUILD)

check: build
	@jobs=$$(nproc); source makefiles/mpi_environment.sh; ctest --test-dir $(BUILD) -j "$$jobs" --output-on-failure  # nproc counts OMP_NUM_THREADS

# Pictures, reports and files for ParaView as VTK and a browser see them, which make check skips where they are missing.
check-look: build
	@bash makefiles/setup.sh packages_look.txt
	@source makefiles/mpi_environment.sh; ctest --test-dir $(BUILD) -L look --verbose

verify-ranks: build
	@bash makefiles/verify_ranks.sh $(BUILD)

bench-planar: build
	@bash makefiles/bench_planar.sh $(BUILD)

bench-offline: build
	@bash makefiles/setup.sh packages_benchmark.txt
	@bash makefiles/bench_offline.sh $(BUILD)

# The offline stage on 1, 2, 4, ... ranks, as many as there are cores.
bench-scaling: build
	@bash makefiles/bench_scaling.sh $(BUILD)

bench-subdomains: build
	@bash makefiles/bench_subdomains.sh $(BUILD)

# The same decks in CalculiX and in floe, side by side.
bench-peers: program
	@bash makefiles/setup.sh packages_benchmark.txt
	@bash makefiles/bench_peers.sh $(BUILD)

check64:
	@bash makefiles/setup.sh packages64.txt
	@bash makefiles/check64.sh

tradeoff: build
	@bash makefiles/tradeoff.sh $(BUILD)

totals: build
	@bash makefiles/totals.sh $(BUILD)

extremes: build
	@bash makefiles/extremes.sh $(BUILD)

# What verification tests take from independent computations, recomputed without floe.
references: setup
	@/usr/bin/python3 tests/verification/references/run.py

readme-pictures: program
	@bash makefiles/readme_pictures.sh $(BUILD)

petsc-options: build
	@source makefiles/mpi_environment.sh; PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tests/failure/petsc_options.py $(BUILD)/floe all

bench-online: build
	@bash makefiles/bench_online.sh $(BUILD)

sanitize: setup
	@bash makefiles/sanitize.sh

valgrind: program setup-maintain
	@bash makefiles/valgrind.sh $(BUILD)

setup-manual:
	@bash makefiles/setup.sh packages_manual.txt

setup-maintain:
	@bash makefiles/setup.sh packages_maintain.txt

manual: build setup-manual
	@bash makefiles/manual.sh $(BUILD)

api: setup-manual
	@bash makefiles/api.sh $(BUILD)

verification: build
	@bash makefiles/verification.sh $(BUILD)

format: setup-maintain
	@bash makefiles/format.sh

format-check: setup-maintain
	@bash makefiles/format.sh --check

lint: setup-maintain $(BUILD)/build.ninja
	@bash makefiles/lint.sh $(BUILD)

coverage: setup-maintain
	@bash makefiles/coverage.sh

fuzz: setup-maintain
	@bash makefiles/fuzz.sh

mutate: setup
	@bash makefiles/mutate.sh

PREFIX ?= /usr/local
install: build
	@source makefiles/mpi_environment.sh; cmake --build $(BUILD) --target pages && cmake --install $(BUILD) --prefix $(PREFIX)

package: build
	@source makefiles/mpi_environment.sh; cmake --build $(BUILD) --target pages && cd $(BUILD) && cpack -G DEB && ls -1 $$PWD/*.deb

clean:
	rm -rf $(BUILD)
