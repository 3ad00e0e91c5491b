#!/usr/bin/env python3
"""Recomputes, without floe, the numbers that verification tests take from independent computations (make references).

Each module is a method of its own in NumPy: Ritz's method over the whole body, or geometrically exact elements in absolute
coordinates. A row fails where the recomputed number is further from the one of the test than the row allows, or where no test of
TESTS holds that number any more.
"""
import os
import re
import sys

sys.dont_write_bytecode = True
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import exact_beam
import lateral_buckling
import plate
import rotating
import shear_beam
import von_karman

# The tests that take the numbers of a module.
TESTS = {
    rotating: ("campbell_test", "rotating_beam_test", "spatial_plate_test"),
    plate: ("static_plate_test", "pressure_test"),
    exact_beam: ("cantilever_test", "flexible_pendulum_test", "moment_arm_test", "slider_crank_test"),
    von_karman: ("cantilever_test", "spin_up_test"),
    lateral_buckling: ("../unit/fem/spatial_beam_second_order_test",),
    shear_beam: ("flying_spaghetti_test",),
}


def numbers_of(tests):
    texts = (open(os.path.join(HERE, "..", name + ".cpp"), encoding="utf-8").read() for name in tests)
    return {float(x) for text in texts for x in re.findall(r"\d*\.\d+|\d+", text)}


def main():
    failed = 0
    print("| quantity | module | recomputed | in the test | off |\n|---|---|--:|--:|--:|")
    for module, tests in TESTS.items():
        held = numbers_of(tests)
        for quantity, found, expected, allowed in module.rows():
            off = abs(found / expected - 1)
            missing = abs(expected) not in held
            verdict = " **too far**" if off > allowed else " **in no test**" if missing else ""
            failed += bool(verdict)
            print(f"| {quantity} | `{module.__name__}.py` | {found:.7g} | {expected:.7g} | {off:.0e}{verdict} |", flush=True)
    print(f"\n{failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
