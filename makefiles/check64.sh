#!/usr/bin/env bash
# make check64: builds with indices of 64 bits (-DFLOE_INDEX64=ON) and runs the unit tests on 1 and 2 ranks. JOBS: how
# many processors.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-64 jobs=${JOBS:-$(nproc)}
source makefiles/mpi_environment.sh
cmake -S . -B $build -G Ninja -DFLOE_INDEX64=ON >$build.log 2>&1 || { cat $build.log; exit 1; }
rm -f $build.log
cmake --build $build -j "$jobs" --target floe unit_tests
ctest --test-dir $build -R '^unit/.*np[12]$' -j "$jobs" --output-on-failure
