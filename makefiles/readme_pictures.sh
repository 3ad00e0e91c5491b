#!/usr/bin/env bash
# make readme-pictures: pictures of README.md (that of the trade-off: make tradeoff). BUILD: the build folder.
set -euo pipefail
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
"$1/floe" run examples/satellite/scene.yaml -o results/satellite --force --no-estimate >/dev/null
"$1/floe" plot results/satellite --kind animation --out docs/satellite.gif --frames 48 --fps 10 --dpi 55
"$1/floe" compare examples/cantilever/scene.yaml -o results/demo --force >/dev/null
cp results/demo/compare.png docs/paper_cantilever.png
