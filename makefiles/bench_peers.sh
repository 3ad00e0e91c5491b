#!/usr/bin/env bash
# make bench-peers: decks in CalculiX and in floe; writes docs/benchmarks/peers.md.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
exec /usr/bin/python3 tests/benchmark/peers.py --floe "${1:-build}/floe" --out docs/benchmarks "${@:2}"
