#!/usr/bin/env bash
# The whole of tests/verification and tests/convergence on 2, 3 and 4 ranks. BUILD: the build folder.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
failed=0
for ranks in 2 3 4; do
  for folder in convergence verification; do
    log=$(mktemp)
    if mpirun -n "$ranks" "$1/tests/test_$folder" >"$log" 2>&1; then
      printf '%s on %s ranks: %s\n' "$folder" "$ranks" "$(grep -a -m1 -o 'All tests passed.*' "$log")"
    else
      failed=1
      printf '%s on %s ranks failed:\n' "$folder" "$ranks"
      grep -a -A6 'FAILED' "$log" | head -n 40
    fi
    rm -f "$log"
  done
done
exit $failed
