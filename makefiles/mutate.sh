#!/usr/bin/env bash
# make mutate: random one-token mutants of src in a copy of the tree (build-mutate), each against the tests until one fails;
# survivors with file and line. A stopped campaign goes on where it was.
# COUNT: of mutants that compile (20). SEED (1). ROOM: some of the rooms. FILES: patterns such as "src/fem/shell_*.cpp".
# TESTS: regular expression of the tests' names. RETRY=1: survivors again, in the tree as it is now.
# FRESH=1: begins anew with the sources as they are now. JOBS.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(nproc)}
source makefiles/mpi_environment.sh
set -f  # patterns are for the program
arguments=(--count "${COUNT:-20}" --seed "${SEED:-1}" --jobs "$jobs" --tests "${TESTS:-}")
[ -z "${ROOM:-}" ] || arguments+=(--room ${ROOM})
[ -z "${FILES:-}" ] || arguments+=(--files ${FILES})
[ -z "${RETRY:-}" ] || arguments+=(--retry)
[ -z "${FRESH:-}" ] || arguments+=(--fresh)
export PYTHONDONTWRITEBYTECODE=1
exec nice -n 10 /usr/bin/python3 tests/mutation/mutate.py "${arguments[@]}"
