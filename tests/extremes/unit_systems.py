"""The same scene in other units: the same numbers, as far as they have none."""

from floe import Floe, relative
from units import Units, in_units
from machines import MACHINES
from study import Point, Study

METRE = Units(1, 1, 1)
SYSTEMS = {"mm, t, s": Units(1e3, 1e-3, 1)}
SYSTEMS |= {f"stiffness 1e{p}": Units(1, 10.0**p, 1) for p in (-9, -3, 6, 15)}
SYSTEMS |= {f"stiffness 1e{p} by time": Units(1, 1, 10.0**(-p / 2)) for p in (-9, 15)}
SYSTEMS |= {f"length 1e{p}": Units(10.0**p, 1, 1) for p in (-9, -6, 6)}
SYSTEMS |= {f"time 1e{p}": Units(1, 1, 10.0**p) for p in (-9, 9)}
SYSTEMS["nm, pg, ns"] = Units(1e9, 1e15, 1e9)
SYSTEMS["light years"] = Units(1e-16, 1e-30, 1e-7)

_known = {}  # the answers in metres, kilograms and seconds


def answers(floe: Floe, machine, units):
    return MACHINES[machine].answers(floe, lambda scene: in_units(scene, units), units)


def same(floe: Floe, machine, units):
    if machine not in _known:
        _known[machine] = answers(floe, machine, METRE)
    mine, known = answers(floe, machine, units), _known[machine]
    assert mine.keys() == known.keys()
    return max(relative(mine[name], known[name]) for name in known)


QUICK = {"crank": ("stiffness 1e-9", "stiffness 1e15", "mm, t, s"), "arm in space": ("length 1e-9", "stiffness 1e15"),
         "wing": ("stiffness 1e-9", "stiffness 1e15 by time"), "adaptive": ("nm, pg, ns",)}
STUDIES = [
    Study(f"units: {name}", f"{machine.text}, stiffness from 1e-9 to 1e15, lengths and times by 1e-16 to 1e9",
          "itself in m, kg, s",
          [Point(label, lambda floe, u=u, name=name: same(floe, name, u), machine.limit,
                 quick=label in QUICK.get(name, ())) for label, u in SYSTEMS.items()])
    for name, machine in MACHINES.items()]
