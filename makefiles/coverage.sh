#!/usr/bin/env bash
# make coverage: builds with gcov, runs the unit tests on one rank, sums up lines and branches of src by room.
# Branches are counted on lines that decide something (if, for, while, switch, case, ?:, &&, ||); others have only those of
# inlined code of libraries, of PETSc's error macros, and of what an exception would clean up.
# ROOMS: some of the rooms. JOBS.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-coverage jobs=${JOBS:-$(nproc)}
rooms=${ROOMS:-$(sed -n 's/^floe_room(\([a-z]*\) .*/\1/p' makefiles/rooms.cmake)}
source makefiles/mpi_environment.sh
export OMPI_MCA_mpi_yield_when_idle=0
cmake -S . -B $build -G Ninja -DFLOE_COVERAGE=ON -DFLOE_UNITY=OFF >$build.log 2>&1 || { cat $build.log; exit 1; }
rm -f $build.log
targets=() names=
for room in $rooms; do
  [ ! -d tests/unit/"$room" ] || targets+=("test_unit_$room")
  names+="${names:+|}$room"
done
cmake --build $build -j "$jobs" --target "${targets[@]}"
find $build -name '*.gcda' -delete
ctest --test-dir $build -R "^unit/($names)\.np1$" -j "$jobs" --output-on-failure
undecided='^(?!.*(\b(if|for|while|switch|case|do)\b|\?|&&|\|\|)).*$'
gcovr --root . --object-directory $build --filter "src/($names)/" --filter "include/floe/($names)/" \
  --exclude-throw-branches --exclude-unreachable-branches --exclude-branches-by-pattern "$undecided" --gcov-ignore-parse-errors \
  --json-summary $build/coverage.json --json-summary-pretty \
  --html-details $build/coverage.html -j "$jobs" >/dev/null
/usr/bin/python3 - $build/coverage.json <<'PYTHON'
import json, sys, collections
sums = collections.defaultdict(lambda: [0, 0, 0, 0])
for file in json.load(open(sys.argv[1]))["files"]:
    parts = file["filename"].split("/")
    room = parts[1] if parts[0] == "src" else parts[2]
    for name in (room, "all"):
        for i, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            sums[name][i] += file[key]
print(f"{'room':10} {'lines':>8} {'covered':>8} {'branches':>9} {'covered':>8}")
for room in sorted(sums, key=lambda name: (name == "all", name)):
    a, b, c, d = sums[room]
    print(f"{room:10} {b:8} {100 * a / max(b, 1):6.1f} % {d:9} {100 * c / max(d, 1):6.1f} %")
PYTHON
echo "Line by line: $build/coverage.html"
