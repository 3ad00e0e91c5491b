#!/usr/bin/env bash
# make totals: estimated, required and true total errors; writes docs/totals.md and docs/benchmarks/events.md.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
/usr/bin/python3 tests/benchmark/event_parts.py --floe "${1:-build}/floe"
exec /usr/bin/python3 tests/benchmark/totals.py --floe "${1:-build}/floe" "${@:2}"
