#!/usr/bin/env bash
# make valgrind: memcheck of whole runs: a planar mechanism, shells in space, held and free, from their mesh to a motion and
# the estimate of its error, on one rank
# and on two; a Campbell diagram. Ends with the number of errors of each; what valgrind says of them is in BUILD/valgrind.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 out=$1/valgrind
source makefiles/mpi_environment.sh
rm -rf "$out" && mkdir -p "$out"
sed 's/^motion: .*/motion: {end: 0.1, step: 5e-4}/' examples/pendulum/scene.yaml >"$out"/pendulum.yaml
cat >"$out"/plate.yaml <<'SCENE'
gravity: [0, 0, -9.81]
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.3, 0], elements: [8, 3]}}
    section: {thickness: 0.002}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3, derivatives: all}
joints:
  hinge: {type: revolute, between: [ground, plate.left], axis: [0, 1, 0]}
motion: {end: 0.02, step: 1e-3}
SCENE
cat >"$out/shaft.yaml" <<'SCENE'
bodies:
  shaft:
    mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 6}}
    section: {A: 1, Iy: 1e-8, Iz: 1.5e-8, J: 2e-8, orientation: [0, 1, 0]}
    material: {E: 1e8, G: 4e7, rho: 1}
    damping: {mass: 0.01, stiffness: 1e-5}
    reduction: {modes: 4, derivatives: all}
joints: {root: {type: driven, between: [ground, shaft.start], axis: [1, 0, 0], angle: "t"}}
SCENE
cat >"$out/free.yaml" <<'SCENE'
bodies:
  plate:
    mesh: {plate: {along: [0.5, 0, 0], across: [0, 0.3, 0], elements: [4, 3]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.33, rho: 2700}
    frame: mean-axis
    reduction: {modes: 3, derivatives: 2}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, 5]}}
motion: {end: 0.02, step: 1e-3}
SCENE
failed=0
check() {  # NAME RANKS WORDS...: floe WORDS
  local name=$1 ranks=$2 errors
  shift 2
  local memcheck=(valgrind --num-callers=25 --error-exitcode=9 --suppressions=/usr/share/openmpi/openmpi-valgrind.supp
    --suppressions=makefiles/valgrind.supp --log-file="$out/$name.%p.log" "$build"/floe "$@")
  [ "$ranks" = 1 ] || memcheck=(mpirun -n "$ranks" "${memcheck[@]}")
  "${memcheck[@]}" >"$out/$name.txt" 2>&1 || { failed=1; tail -n 5 "$out/$name.txt"; }
  errors=$(sed -n 's/.*ERROR SUMMARY: \([0-9]*\) errors.*/\1/p' "$out/$name".*.log | awk '{sum += $1} END {print sum + 0}')
  echo "$name on $ranks: $errors errors"
}
for ranks in 1 2; do
  check pendulum_$ranks $ranks run "$out"/pendulum.yaml -o "$out"/pendulum_$ranks
  check plate_$ranks $ranks run "$out"/plate.yaml -o "$out"/plate_$ranks
  check free_$ranks $ranks run "$out"/free.yaml -o "$out"/free_$ranks
done
check shaft 1 campbell "$out"/shaft.yaml --speeds 3,3.9,6 -o "$out"/shaft
exit $failed
