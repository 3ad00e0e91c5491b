#!/usr/bin/env bash
# make bench-scaling: the offline stage on 1, 2, 4, ... ranks; writes docs/benchmarks/scaling.md and scaling.png.
# Other ranks and sizes: makefiles/bench_scaling.sh build --ranks 1 2 4 8 16 --strong 316 --weak 140
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
cmake --build "${1:-build}" --target offline_stage
exec /usr/bin/python3 tests/benchmark/scaling.py --stage "${1:-build}/tests/offline_stage" --out docs/benchmarks "${@:2}"
