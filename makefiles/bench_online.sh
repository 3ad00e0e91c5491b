#!/usr/bin/env bash
# make bench-online: times single steps and writes docs/benchmarks/online.md.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
exec /usr/bin/python3 tests/benchmark/online.py --floe "${1:-build}/floe" --out docs/benchmarks "${@:2}"
