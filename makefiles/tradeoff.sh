#!/usr/bin/env bash
# make tradeoff: error against time for all examples; writes docs/tradeoff.md and its pictures.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
exec /usr/bin/python3 tests/benchmark/tradeoff.py --floe "${1:-build}/floe" "${@:2}"
