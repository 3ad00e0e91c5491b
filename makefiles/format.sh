#!/usr/bin/env bash
# make format: lays the C++ code out as .clang-format says. --check: only names what is not, and fails.
# The version is a fixed one: others lay out differently.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(git ls-files '*.h' '*.cpp')
if [ "${1:-}" = --check ]; then
  clang-format-14 --dry-run --Werror "${files[@]}" && echo "${#files[@]} files are as .clang-format says"
else
  clang-format-14 -i "${files[@]}"
  git diff --stat -- '*.h' '*.cpp'
fi
