"""Equal frequencies, mechanisms, dependent basis vectors, many derivatives, no loads."""
import math

import numpy

from contrasts import one_body
from floe import Floe, relative
from reference import beam_in_segments
from scenes import cantilever, pendulum, plate, spatial_cantilever, tip_force
from study import Answer, Miss, Point, Study


def nearly_square(floe: Floe, gap, formulation, command):
    """Two bending modes whose frequencies differ by `gap`: the answers are those of the square section."""
    def answer(eps):
        h = 0.02
        scene = spatial_cantilever(h, h * (1 + eps), 8, modes=4, E=12 / h**4,
                                   rho=1 / h**2, loads=tip_force(0, "0.1*sin(5*t)", "0.07*sin(3*t)"))
        if command == "static":
            return floe.static(scene, formulation, "--at", "0.3", "--steps", "1").vector("tip")[-1]
        return floe.run(scene, formulation).vector("tip")
    return relative(answer(gap), answer(0.0))


def turned(floe: Floe, angle, formulation):
    """A square section whose equal modes may lie anyhow: rotated about the beam, the same motion."""
    def answer(a):
        h = 0.02
        scene = spatial_cantilever(h, h, 8, modes=4, E=12 / h**4, rho=1 / h**2,
                                   loads=tip_force(0, "0.1*sin(5*t)", "0.07*sin(3*t)"))
        scene["bodies"]["beam"]["section"]["orientation"] = [0, math.cos(a), math.sin(a)]
        return floe.run(scene, formulation).vector("tip")
    return relative(answer(angle), answer(0.0))


def split_pair(floe: Floe, count):
    """A square plate clamped all around has modes 2 and 3 of one frequency; a count that parts them takes both or says
    so, and the motion has the symmetry of its load."""
    scene = plate(1, 1, (8, 8), 0.01, "quadrilaterals", E=7e10, rho=2700, modes=count, loads={
        "a": {"type": "force", "at": {"body": "plate", "node": [0.25, 0.25, 0]}, "force": [0, 0, "sin(100*t)"]}},
        motion={"end": 0.05, "step": 2e-4})
    scene["joints"] = {e: {"type": "fixed", "between": ["ground", f"plate.{e}"]} for e in ("left", "right", "bottom", "top")}
    scene["probes"] = {"one": {"at": {"body": "plate", "node": [0.75, 0.25, 0]}},
                       "two": {"at": {"body": "plate", "node": [0.25, 0.75, 0]}}}
    moved = floe.run(scene, "vm+md")
    warned = moved.warned("frequency") or moved.warned("mode")
    symmetric = relative(moved.probes["one.z"], moved.probes["two.z"])
    return Answer(0.0 if warned else symmetric, next((w for w in moved.warnings if "mode" in w), ""))


def torsion_spring(floe: Floe, k, formulation):
    """A rigid bar that a hinge holds, and a spring of so little or so much stiffness: angle M/k = 0.1."""
    scene = pendulum(elements=2, loads={"m": {"type": "moment", "at": "rod.end", "moment": f"{0.1 * k!r}*t"}})
    del scene["gravity"]
    scene["bodies"]["rod"]["rigid"] = True
    scene["joints"]["spring"] = {"type": "spring", "between": ["ground", "rod.start"], "torsional_stiffness": k}
    scene["probes"]["tip"]["quantity"] = "rotation"
    moved = floe.static(scene, formulation, "--at", "1", "--steps", "1")
    return abs(moved.probes["tip.angle"][-1] / 0.1 - 1) if "tip.angle" in moved.probes else abs(
        list(moved.probes.values())[0][-1] / 0.1 - 1)


def flexible_on_spring(floe: Floe, k, formulation):
    """The same with a flexible bar: K is nearly singular when the hinge's spring is weak."""
    scene = pendulum(elements=4, loads={"m": {"type": "moment", "at": "rod.start", "moment": f"{0.1 * k!r}*t"}})
    del scene["gravity"]
    scene["joints"]["spring"] = {"type": "spring", "between": ["ground", "rod.start"], "torsional_stiffness": k}
    scene["probes"] = {"turn": {"at": "rod.start", "quantity": "rotation"}}
    moved = floe.static(scene, formulation, "--at", "1", "--steps", "1")
    return abs(list(moved.probes.values())[0][-1] / 0.1 - 1)


def mechanism(floe: Floe, formulation):
    """Nothing holds a hinged bar against a moment."""
    scene = pendulum(elements=4, loads={"m": {"type": "moment", "at": "rod.start", "moment": "t"}})
    del scene["gravity"]
    floe.static(scene, formulation, "--at", "1", "--steps", "1")
    return float("nan")


def mechanism_in_space(floe: Floe, formulation, skew):
    """The same in space, about an axis of the mesh or about none, at the end of the bar."""
    z = numpy.array([0.36, -0.48, 0.8] if skew else [0.0, 0.0, 1.0])
    x = numpy.cross([0.0, 1.0, 0.0] if not skew else [0.6, 0.8, 0.0], z)
    x /= numpy.linalg.norm(x)
    scene = spatial_cantilever(0.02, 0.02, 8, modes=4, E=7e10, rho=2700, loads={
        "m": {"type": "moment", "at": "beam.end", "moment": [f"{100 * a!r}*t" for a in z.tolist()]}})
    scene["bodies"]["beam"]["mesh"]["line"]["to"] = x.tolist()
    scene["bodies"]["beam"]["section"]["orientation"] = z.tolist()
    scene["joints"] = {"hinge": {"type": "revolute", "between": ["ground", "beam.start"], "axis": z.tolist()}}
    floe.static(scene, formulation, "--at", "1", "--steps", "1")
    return float("nan")


def first_rest(start, k):
    """Where a pendulum of 4.905 N m weight and a spring that is loose at the start comes to rest if it creeps [rad]."""
    def torque(angle):
        return -4.905 * math.cos(angle) - k * (angle - start)
    way = math.copysign(1e-3, torque(start))
    low, high = start, start + way
    while torque(high) * way > 0:
        low, high = high, high + way
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if torque(middle) * way > 0 else (low, middle)
    return (low + high) / 2


def hanging(floe: Floe, start, k, formulation):
    """A stiff pendulum, let down from an angle; a spring at its hinge may hold it on the way."""
    scene = pendulum(elements=4, EA=1e9)
    scene["bodies"]["rod"]["section"]["EI"] = 1e6
    scene["bodies"]["rod"]["initial"] = {"angle": start}
    if k > 0:
        scene["joints"]["spring"] = {"type": "spring", "between": ["ground", "rod.start"], "torsional_stiffness": k}
    end = floe.static(scene, formulation, "--at", "1", "--steps", "1").vector("tip")[-1]
    angle = first_rest(start, k)
    return float(numpy.hypot(end[0] - math.cos(angle), end[1] - math.sin(angle)))


def hanging_in_space(floe: Floe, start, formulation):
    """The same without a spring, about an axis askew."""
    z, x = numpy.array([0.36, -0.48, 0.8]), numpy.array([0.8, 0.6, 0.0])
    y = numpy.cross(z, x)
    along = math.cos(start) * x + math.sin(start) * y
    scene = spatial_cantilever(0.02, 0.02, 4, modes=4, E=7e10, rho=2700, gravity=(-9.81 * y).tolist())
    scene["bodies"]["beam"]["mesh"]["line"]["to"] = along.tolist()
    scene["bodies"]["beam"]["section"]["orientation"] = z.tolist()
    scene["joints"] = {"hinge": {"type": "revolute", "between": ["ground", "beam.start"], "axis": z.tolist()}}
    scene["probes"] = {"tip": {"at": "beam.end", "quantity": "position"}}
    end = floe.static(scene, formulation, "--at", "1", "--steps", "1").vector("tip")[-1]
    return float(numpy.linalg.norm(end + y))


STARTS = (-3.0, -1.2, -0.3, -0.02, 0.0, 1e-3, 0.02, 0.3)


def far_bar(arm, k, k_turn, rigid):
    """A bar on a bushing, its mesh so far from the mesh's origin, under 10 N m about z."""
    start = [arm, 0.3 * arm, 0.1 * arm]
    return {
        "bodies": {"bar": {
            "mesh": {"line": {"from": start, "to": [arm + 1, *start[1:]], "elements": 2}}, "rigid": rigid,
            "section": {"shape": "rectangle", "width": 0.02, "height": 0.02, "orientation": [0, 0, 1]},
            "material": {"E": 7e10, "nu": 0.3, "rho": 2700}, "reduction": {"modes": 4}}},
        "joints": {"bushing": {"type": "bushing", "between": ["ground", "bar.start"], "translation": [k, k, k],
                               "rotation": [1e3, 1e3, k_turn]}},
        "loads": {"m": {"type": "moment", "at": "bar.start", "moment": [0, 0, "10*t"]}},
        "motion": {"end": 1, "step": 0.1},
        "probes": {"turn": {"at": "bar.start", "quantity": "rotation"}}}


def far_mesh(floe: Floe, arm, k, k_turn, formulation, rigid):
    moved = floe.static(far_bar(arm, k, k_turn, rigid), formulation, "--at", "1", "--steps", "1")
    return abs(moved.end("turn.rz") / (10 / k_turn) - 1)


def far_and_loose(floe: Floe, arm, k):
    floe.static(far_bar(arm, k, 0, True), "vm+md", "--at", "1", "--steps", "1")
    return float("nan")


def repeated(floe: Floe, copies):
    """Attachments of loads at one place, many times, and at its neighbours: linearly dependent basis vectors."""
    loads = {f"l{i}": {"type": "force", "at": {"body": "beam", "node": [1 - (i % 4) / 16, 0]},
                       "force": [0, "sin(5*t)" if i == 0 else "0*t"]} for i in range(copies)}
    moved = floe.run(cantilever(16, EA=1e4, attachment="all", loads=loads), "vm+md")
    full = floe.run(cantilever(16, EA=1e4, loads=tip_force(0, "sin(5*t)")), "nlffr")
    basis = moved.summary["bodies"][0]["basis"]
    return Answer(relative(moved.vector("tip"), full.vector("tip")),
                  f"{sum(not c['kept'] for c in basis)} vectors dropped, {sum(c['kept'] for c in basis)} kept")


def tolerances(floe: Floe, tolerance):
    """Nearly dependent basis vectors, kept according to drop_tolerance: the solution of the full-order model all the same."""
    def scene(value=None):
        s = cantilever(16, EA=1e4, modes=8, loads=tip_force(0, "sin(5*t)"))
        if value is not None:
            s["bodies"]["beam"]["reduction"]["drop_tolerance"] = value
        return s
    moved = floe.run(scene(tolerance), "vm+md")
    kept = sum(c["kept"] for c in moved.summary["bodies"][0]["basis"])
    return Answer(relative(moved.vector("tip"), floe.run(scene(), "nlffr").vector("tip")), f"{kept} vectors kept")


_full = {}


def derivatives(floe: Floe, modes):
    """m modes with all p = m (m + 1)/2 derivatives, against the full model."""
    def scene():
        return cantilever(48, EA=1e4, modes=modes, loads=tip_force(0, "sin(5*t)"), motion={"end": 1, "step": 2e-3})
    if "nlffr" not in _full:
        _full["nlffr"] = floe.run(scene(), "nlffr").vector("tip")
    moved = floe.run(scene(), "vm+md")
    basis = moved.summary["bodies"][0]["basis"]
    p = [c for c in basis if c["kind"] == "derivative"]
    return Answer(relative(moved.vector("tip"), _full["nlffr"]),
                  f"p = {len(p)}, {sum(c['kept'] for c in p)} kept, {moved.summary['unknowns']['coordinates']} coordinates")


def derivatives_in_space(floe: Floe, modes):
    def scene(m):
        return spatial_cantilever(0.02, 0.03, 16, modes=m, E=1e8, loads=tip_force(0, "sin(5*t)", "sin(4*t)"),
                                  motion={"end": 1, "step": 2e-3})
    if "space" not in _full:
        _full["space"] = floe.run(scene(3), "nlffr").vector("tip")
    moved = floe.run(scene(modes), "vm+md")
    p = [c for c in moved.summary["bodies"][0]["basis"] if c["kind"] == "derivative"]
    return Answer(relative(moved.vector("tip"), _full["space"]),
                  f"p = {len(p)}, {sum(c['kept'] for c in p)} kept")


def no_modes(floe: Floe, formulation):
    """Attachment modes only: static deflections under a tip force are exact."""
    scene = cantilever(8, modes=0, attachment="all", loads=tip_force(0, "0.5*t"))
    end = floe.static(scene, formulation, "--at", "1", "--steps", "1").vector("tip")[-1]
    return abs(end[1] * 6 - 1)


def no_columns(floe: Floe):
    scene = cantilever(8, modes=0, loads=tip_force(0, "0.5*t"))
    scene["bodies"]["beam"]["reduction"]["attachment"] = "none"
    moved = floe.run(scene, "vm+md")
    return float(abs(moved.vector("tip")).max())


def no_loads(floe: Floe, formulation):
    """Nothing moves, to the bit, and the error of nothing is nothing."""
    moved = floe.run(cantilever(8, loads=tip_force(0, 0)), formulation, estimate=True)
    estimate = moved.summary.get("estimate", {})
    return float(abs(moved.vector("tip")).max() + abs(moved.energy).max() + estimate.get("deformation", 0))


def massless_inner(density):
    """A deck refuses a material without density; a scene's own material may have none."""
    scene, files = one_body(1, 1)
    b, h = 1.5e-3, 1e-3
    scene["bodies"]["beam"]["parts"] = {"INNER": {
        "section": {"shape": "rectangle", "width": h, "height": b, "orientation": [0, 1, 0]},
        "material": {"E": 12 / (b * h**3), "nu": 0.3, "rho": density / (b * h)}}}
    return scene, files


def massless_part(floe: Floe):
    """The inner half without mass: its outer half on a massless spring of three coordinates."""
    scene, files = massless_inner(0.0)
    return abs(floe.modes(scene, files=files)[0] / beam_in_segments([(1, 1, 1e-30), (1, 1, 1)]) - 1)


def massless_in_motion(floe: Floe, formulation):
    """The same in motion under a step load: against density 1e-9 there."""
    def history(rho):
        scene, files = massless_inner(rho)
        scene |= {"loads": {"tip": {"type": "force", "at": "beam.TIP", "force": [0, 0, "1e-3*sin(t)"]}},
                  "motion": {"end": 3, "step": 5e-3}, "probes": {"tip": {"at": "beam.TIP"}}}
        return floe.run(scene, formulation, files=files).vector("tip")
    return relative(history(0), history(1e-9))


def massless_body(floe: Floe, command):
    scene = spatial_cantilever(0.02, 0.02, 4, rho=0, loads=tip_force(0, 1, 0))
    if command == "modes":
        floe.modes(scene)
    else:
        floe.run(scene, command)
    return float("nan")


STUDIES = [
    Study("nearly equal frequencies", "sections off the square by 1e-15 to 1e-6", "the square section",
          [Point(f"{g:g}, {f}, {c}", lambda floe, g=g, f=f, c=c: nearly_square(floe, g, f, c), max(1e-7, 50 * g),
                 quick=(g, f, c) == (1e-9, "vm+md", "run"),
                 misses=Miss("modes this close are mixed by round-off, which leaves a derivative in torsion; with it the "
                             "basis has one vector more", 6e-6) if (g, f, c) == (1e-8, "vm+md", "run") else None)
           for f in ("vm+md", "nlffr") for c in ("static", "run") for g in (1e-15, 1e-12, 1e-9, 1e-8, 1e-6)] +
          [Point(f"{g:g}, vm, run", lambda floe, g=g: nearly_square(floe, g, "vm", "run"), max(1e-7, 50 * g))
           for g in (1e-9, 1e-6)]),
    Study("equal frequencies", "square section rotated about the beam axis", "itself, not rotated",
          [Point(f"{a:g} rad, {f}", lambda floe, a=a, f=f: turned(floe, a, f), 1e-7, quick=(a, f) == (0.3, "vm+md"))
           for f in ("vm+md", "nlffr") for a in (1e-9, 0.3, 0.7853981633974483)]),
    Study("a pair of equal modes, cut", "1 to 6 modes of a clamped square plate", "the symmetry of its load, or a warning",
          [Point(f"{m}", lambda floe, m=m: split_pair(floe, m), 1e-6, quick=m == 2) for m in (1, 2, 3, 4, 5, 6)]),
    Study("weak and strong springs", "a hinge's spring of 1e-30 to 1e30 N m/rad, rigid and flexible bar", "closed form M/k",
          [Point(f"{k:g}, rigid", lambda floe, k=k: torsion_spring(floe, k, "nlffr"), 1e-9, quick=k == 1e-12)
           for k in (1e-30, 1e-12, 1e-6, 1, 1e6, 1e12, 1e30)] +
          [Point(f"{k:g}, {f}", lambda floe, k=k, f=f: flexible_on_spring(floe, k, f), 1e-6, quick=k == 1e-6)
           for f in ("nlffr", "vm+md") for k in (1e-9, 1e-6, 1, 1e3)]),
    Study("pendulums at rest", "released from -3 to 0.3 rad, springs of 0 to 100 N m/rad", "the rest position of a slow rod",
          [Point(f"{a:g} rad, {k:g} N m/rad, {f}", lambda floe, a=a, k=k, f=f: hanging(floe, a, k, f), 1e-5,
                 quick=(a, k, f) in ((0.0, 0.0, "nlffr"), (1e-3, 1e-3, "vm+md"), (-0.3, 0.0, "cfr")))
           for f in ("nlffr", "vm+md", "cfr") for a in STARTS for k in (0.0, 1e-3, 1.0, 100.0)] +
          [Point(f"in space, {a:g} rad, {f}", lambda floe, a=a, f=f: hanging_in_space(floe, a, f), 1e-6,
                 quick=(a, f) == (0.0, "nlffr")) for f in ("nlffr", "vm+md") for a in STARTS]),
    Study("a mechanism", "no spring", "a refusal",
          [Point(f, lambda floe, f=f: mechanism(floe, f), None, "singular tangent stiffness", quick=True)
           for f in ("nlffr", "vm+md", "cfr")] +
          [Point(f"in space, {a}, {f}", lambda floe, s=a == "skew", f=f: mechanism_in_space(floe, f, s), None,
                 "singular tangent stiffness", quick=True) for f in ("nlffr", "vm+md") for a in ("along an axis", "skew")]),
    Study("a mesh far from its origin", "a bar on a bushing, 0 to 1e6 of its lengths away", "closed form M/k",
          [Point(f"{arm:g}, k = {k:g}, {t:g} N m/rad, {f}, {'rigid' if r else 'flexible'}",
                 lambda floe, arm=arm, k=k, t=t, f=f, r=r: far_mesh(floe, arm, k, t, f, r), 1e-6,
                 quick=(arm, k, t) == (1e4, 1e8, 10))
           for arm in (0, 1e2, 1e4, 1e6) for k in (1e6, 1e8) for t in (10, 100)
           for f, r in (("vm+md", True), ("vm+md", False), ("nlffr", False))] +
          [Point(f"{arm:g}, k = {k:g}, free", lambda floe, arm=arm, k=k: far_and_loose(floe, arm, k), None, "singular tangent stiffness",
                 quick=(arm, k) == (1e4, 1e9)) for arm in (0, 1e2, 1e4, 1e6) for k in (1e5, 1e9)]),
    Study("dependent basis vectors", "2 to 200 loads with attachment modes at four places", "nlffr",
          [Point(f"{n}", lambda floe, n=n: repeated(floe, n), 1e-4, quick=n == 20) for n in (2, 20, 200)]),
    Study("nearly dependent basis vectors", "drop_tolerance from 1e-1 to 1e-15", "nlffr",
          [Point(f"{t:g}", lambda floe, t=t: tolerances(floe, t), 1e-3, quick=t == 1e-12)
           for t in (1e-1, 1e-3, 1e-7, 1e-10, 1e-12, 1e-15)]),
    Study("derivatives", "1 to 21 modes with all their derivatives, p = 1 to 231", "nlffr",
          [Point(f"m = {m}", lambda floe, m=m: derivatives(floe, m), 1e-1 if m < 3 else 2e-2 if m < 6 else 1e-3, quick=m in (1, 6))
           for m in (1, 2, 3, 4, 6, 8, 12, 16, 20, 21)]),
    Study("derivatives in space", "1 to 20 modes with all their derivatives, p = 1 to 210", "nlffr",
          [Point(f"m = {m}", lambda floe, m=m: derivatives_in_space(floe, m), 1e-1 if m < 8 else 5e-3, quick=False,
                 misses=Miss("one mode bends in one direction, the load acts in two; the estimate is 39 %", 0.5)
                 if m == 1 else None)
           for m in (1, 2, 4, 8, 12, 16, 20)]),
    Study("no modes", "attachment modes only, or no basis vectors", "closed form; no motion",
          [Point("attachments", lambda floe: no_modes(floe, "vm+md"), 1e-8, quick=True),
           Point("no basis vectors", no_columns, 1e-15, quick=True)]),
    Study("no loads", "forces of zero", "0, to the bit",
          [Point(f, lambda floe, f=f: no_loads(floe, f), 1e-300, quick=f == "vm+md") for f in ("nlffr", "vm+md", "vm", "cfr")]),
    Study("no density", "a part, or all, of a body without mass", "own beam elements; density 1e-9; a refusal",
          [Point("part, modes", massless_part, 1e-4, quick=True)] +
          [Point("part, motion, vm+md", lambda floe: massless_in_motion(floe, "vm+md"), 1e-6, quick=True),
           Point("part, motion, nlffr", lambda floe: massless_in_motion(floe, "nlffr"), None, "a body has no mass",
                 quick=True)] +
          [Point(f"body, {c}", lambda floe, c=c: massless_body(floe, c), None, "mass", quick=c == "vm+md")
           for c in ("modes", "vm+md", "nlffr")]),
]
