#!/usr/bin/env bash
# make bench-offline: times the offline stage and writes docs/benchmarks/offline.md and offline.png.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
cmake --build "${1:-build}" --target offline_stage
exec /usr/bin/python3 tests/benchmark/offline.py --stage "${1:-build}/tests/offline_stage" --out docs/benchmarks "${@:2}"
