#!/usr/bin/env bash
# make bench-offline: times the offline stage and writes docs/benchmarks/offline.md and offline.png.
# The comparison with CalculiX needs ccx (packages_benchmark.txt); it is left out where that is missing.
# Without the large plates it takes less time: makefiles/bench_offline.sh build --small
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
cmake --build "${1:-build}" --target offline_stage floe
exec /usr/bin/python3 tests/benchmark/offline.py --stage "${1:-build}/tests/offline_stage" \
  --floe "${1:-build}/floe" --out docs/benchmarks "${@:2}"
