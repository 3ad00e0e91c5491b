#!/usr/bin/env bash
# make verification: runs tests/verification and tests/convergence and writes docs/verification.md from what they compare.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
export OMPI_MCA_mpi_yield_when_idle=0 PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 tests/verification/table.py --build "${1:-build}"
