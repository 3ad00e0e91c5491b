#!/usr/bin/env bash
# make manual: the manual as HTML, build/manual/index.html. BUILD: the build folder, with floe in it.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
out=$1/manual
export FLOE=$PWD/$1/floe PYTHONDONTWRITEBYTECODE=1
[[ $1 = /* ]] && export FLOE=$1/floe
/usr/bin/python3 -m sphinx -q -W --keep-going -b html -c docs . "$out"
printf '<!doctype html><meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">floe</a>\n' \
  >"$out/index.html"
for script in examples/cluster/*.sbatch; do bash -n "$script"; done
echo "The manual: $out/index.html"
