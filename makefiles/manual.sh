#!/usr/bin/env bash
# make manual: the manual as HTML, build/manual/index.html. BUILD: the build folder, with floe in it.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
build=$(cd "$1" && pwd) out=$1/manual
export FLOE=$build/floe PYTHONDONTWRITEBYTECODE=1
# -E: afresh, for the program and new pages are sources that Sphinx does not see.
/usr/bin/python3 -m sphinx -q -E -W --keep-going -b html -c docs . "$out"
printf '<!doctype html><meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">floe</a>\n' \
  >"$out/index.html"
"$FLOE" check examples/start/scene.yaml >/dev/null  # the first scene of the manual
for script in examples/cluster/*.sbatch; do bash -n "$script"; done
echo "The manual: $out/index.html"
