#!/usr/bin/env bash
# make api: the documentation of the public headers, build/api/html/index.html. BUILD: the build folder.
set -euo pipefail
cd "$(dirname "$0")/.."
export FLOE_API_OUT=$1/api FLOE_VERSION
FLOE_VERSION=$(sed -n 's/^project(floe VERSION \([^ ]*\).*/\1/p' CMakeLists.txt)
mkdir -p "$FLOE_API_OUT"
log=$FLOE_API_OUT/doxygen.log
doxygen docs/Doxyfile 2>"$log"
# Types and functions say what they are. Members of a type and its overrides may leave that to the type and their names.
if grep -vE 'Member .* of (class|struct) .* is not documented' "$log"; then exit 1; fi
echo "The headers' documentation: $FLOE_API_OUT/html/index.html"
