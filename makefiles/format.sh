#!/usr/bin/env bash
# make format: lays the C++ code out as .clang-format says. --check: only names what is not, and fails.
# The version is a fixed one: others lay out differently. 77: it is not installed (a test of make check skips it then).
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-format-14 >/dev/null || { echo "clang-format-14 is not installed" >&2; exit 77; }
git rev-parse --is-inside-work-tree >/dev/null 2>&1 || { echo "this is not a checkout of git" >&2; exit 77; }
mapfile -t files < <(git ls-files '*.h' '*.cpp')
if [ "${1:-}" = --check ]; then
  clang-format-14 --dry-run --Werror "${files[@]}" && echo "${#files[@]} files are as .clang-format says"
else
  clang-format-14 -i "${files[@]}"
  git diff --stat -- '*.h' '*.cpp'
fi
