#!/usr/bin/env bash
# make lint: clang-tidy by .clang-tidy over src, tests or one room. BUILD: the build folder. ROOM: a room (all). JOBS.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 jobs=${JOBS:-$(nproc)} room=${ROOM:-}
mapfile -t files < <(git ls-files "src/${room:+$room/}*.cpp")
command -v clang-tidy-16 >/dev/null || { echo "clang-tidy-16 is not there" >&2; exit 1; }
[ ${#files[@]} -gt 0 ] || { echo "no room $room" >&2; exit 2; }
log=$build/lint.log
# clang-tidy does not read precompiled headers of GCC.
cmake -S . -B "$build/lint" -G Ninja -DFLOE_PRECOMPILE=OFF -DFLOE_UNITY=OFF >"$build/lint-configure.log" 2>&1 || { cat "$build/lint-configure.log"; exit 1; }
cmake --build "$build/lint" --target floe_version >/dev/null
# GCC's own options mean nothing to clang; headers of Eigen and PETSc are not ours to judge. Of products that are widened
# those count that are PETSc's or offsets of pointers, not the small ones (3 i) that Eigen's blocks take as a long.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" \
  clang-tidy-16 -p "$build/lint" --quiet --extra-arg=-Wno-unknown-warning-option >"$log" 2>"$log.errors" || true
ours=$(grep -E '(warning|error):' "$log" | grep -v "^/usr/\|widening conversion to type 'Index'.* in type 'int'" | sort -u || true)
failed=$(grep -E '^(Error|Stack dump|xargs:)' "$log.errors" | head -3 || true)
count=$(printf '%s' "$ours" | grep -c '' || true)
[ "$count" -eq 0 ] || printf '%s\n' "$ours"
echo "${#files[@]} files, $count findings; all of clang-tidy's words: $log"
[ -z "$failed" ] || { printf '%s\n' "$failed" >&2; exit 1; }
[ "$count" -eq 0 ]
