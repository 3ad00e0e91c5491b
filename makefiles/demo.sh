#!/usr/bin/env bash
# The main job on the paper's example: five formulations, one table, one picture.
set -euo pipefail
build=$1
cd "$(dirname "$0")/.."
source makefiles/mpi_environment.sh
"$build/floe" compare examples/cantilever/scene.yaml -o results/demo --force
