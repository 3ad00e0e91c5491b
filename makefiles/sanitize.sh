#!/usr/bin/env bash
# make sanitize: builds with the address and undefined-behaviour sanitizers and runs the tests under them: units,
# verification, bad input, extremes, restarts, examples, on one rank and on two. JOBS: how many at once. TESTS: some of them, as ctest -R.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-sanitize jobs=${JOBS:-$(nproc)}
source makefiles/mpi_environment.sh
cmake -S . -B $build -G Ninja -DFLOE_SANITIZE=ON >$build.log 2>&1 || { cat $build.log; exit 1; }
rm -f $build.log
cmake --build $build -j "$jobs"
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1  # Open MPI leaks
ctest --test-dir $build -R "${TESTS:-^(unit|worked|verification|convergence|failure|extremes|restart|examples|exchange)}" -E 'np[34]' -j "$jobs" \
  --output-on-failure
