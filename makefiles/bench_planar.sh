#!/usr/bin/env bash
# make bench-planar: times the planar program and writes docs/benchmarks/planar.md and planar.png.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
exec /usr/bin/python3 tests/benchmark/planar.py --floe "${1:-build}/floe" --out docs/benchmarks "${@:2}"
