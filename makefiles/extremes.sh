#!/usr/bin/env bash
# make extremes: floe at its numerical limits, all points; writes docs/extremes.md.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
export PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 tests/extremes/run.py "${1:-build}/floe" --write docs/extremes.md "${@:2}"
