#!/usr/bin/env bash
# Builds with the address and undefined-behaviour sanitizers and runs the unit tests under them. JOBS: how many at once.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-sanitize jobs=${JOBS:-$(nproc)}
source makefiles/mpi_environment.sh
cmake -S . -B $build -G Ninja -DFLOE_SANITIZE=ON >$build.log 2>&1 || { cat $build.log; exit 1; }
rm -f $build.log
cmake --build $build -j "$jobs" --target unit_tests
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1  # Open MPI leaks
ctest --test-dir $build -R unit -j "$jobs" --output-on-failure
