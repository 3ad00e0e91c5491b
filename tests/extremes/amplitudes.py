"""From motions of 1e-12 of the length, which must be linear to round-off, to loads that no model follows."""
from floe import Floe, relative
from scenes import cantilever, pendulum, spatial_cantilever, tip_force
from study import Answer, Miss, Point, Study

SWINGS = ("the accuracy of accelerations in a step is eps of the angle over h^2, which accumulates to 3e-12 rad; "
          "motions below 6e-11 rad are not resolved")
SMALL = [1e-150, 1e-100, 1e-30, 1e-16, 1e-12, 1e-9, 1e-6]


def pushed(amplitude, **more):
    return cantilever(8, EA=1e4, loads=tip_force(0, f"{amplitude!r}*sin(3*t)"), **more)


def linear(floe: Floe, amplitude, formulation):
    """The tip over the amplitude, against lffr at amplitude 1: they differ by the square of the amplitude."""
    moved = floe.run(pushed(amplitude), formulation).probes["tip.y"] / amplitude
    return relative(moved, floe.run(pushed(1), "lffr").probes["tip.y"])


def proportional(floe: Floe, amplitude, formulation):
    """The tip over the amplitude, against the same formulation at 1e-6."""
    known = floe.run(pushed(1e-6), formulation).probes["tip.y"] / 1e-6
    return relative(floe.run(pushed(amplitude), formulation).probes["tip.y"] / amplitude, known)


def shortening(floe: Floe, amplitude, formulation):
    """The second-order answer u = -a^2/15 L, which a sum of first order would lose."""
    scene = cantilever(8, EA=1e4, attachment="all", loads=tip_force(0, f"{amplitude!r}*t"))
    scene["probes"]["tip"]["quantity"] = "deflection"  # displacements carry the round-off of positions
    u = floe.static(scene, formulation, "--at", "1", "--steps", "1").end("tip.x")
    return abs(u / (-amplitude**2 / 15) - 1)


def in_space(floe: Floe, amplitude, formulation):
    def history(a):
        scene = spatial_cantilever(0.02, 0.03, 8, E=1e8, loads=tip_force(0, f"{a!r}*sin(9*t)", f"{a!r}*sin(7*t)"))
        return floe.run(scene, formulation).vector("tip")[:, 1:] / a
    return relative(history(amplitude), history(1e-6))


def swung(floe: Floe, amplitude, formulation):
    """A pendulum that hangs, let go at an angle: the first period's path over the angle, against 1e-4."""
    def history(a):
        scene = pendulum()
        scene["bodies"]["rod"]["initial"] = {"angle": f"-pi/2 + {a!r}"}
        return floe.run(scene, formulation).probes["tip.x"] / a
    return relative(history(amplitude), history(1e-4))


def driven(floe: Floe, amplitude, formulation):
    """The clamp turns by a (1 - cos 3t): the deflection over a, against a = 1e-5."""
    def history(a):
        scene = cantilever(8, EA=1e4)
        scene["joints"]["clamp"] = {"type": "driven", "between": ["ground", "beam.start"],
                                    "angle": f"{a!r}*(1 - cos(3*t))"}
        scene["probes"]["tip"]["quantity"] = "deflection"
        return floe.run(scene, formulation).probes["tip.y"] / a
    return relative(history(amplitude), history(1e-5))


def overloaded(floe: Floe, load, formulation, frame):
    """A weight that is let go at once. Energy: work of the weight and what the scheme damps, so that the total never
    rises above where it began; elastic energy never below zero; and a warning that tells what is wrong."""
    scene = cantilever(10, EA=1e5, frame=frame, gravity=[0, -load], motion={"end": 2, "step": 1e-3})
    moved = floe.run(scene, formulation)
    kinetic, elastic, potential = moved.energy.T
    greatest = max(kinetic.max(), elastic.max())
    assert kinetic.min() >= 0 and elastic.min() >= 0, "an energy is negative"
    words = [w for w in moved.warnings if "slopes of up to" in w or "membrane energy of quadratic strains" in w]
    assert words, f"no warning of slopes or stretching: {moved.warnings}"
    total = kinetic + elastic + potential
    slopes = words[0]
    return Answer(float((total - total[0]).max() / greatest), slopes)


STUDIES = [
    Study("small amplitudes", "tip force from 1e-150 to 1e-6 EI/L^2, nlffr", "the linear model (lffr) at amplitude 1",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: linear(floe, a, f), 1e-8, quick=(a, f) == (1e-12, "nlffr"))
           for f in ("nlffr",) for a in SMALL]),
    Study("small amplitudes, other models", "tip force from 1e-150 to 1e-9 EI/L^2; vm+md, vm, cfr", "itself at amplitude 1e-6",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: proportional(floe, a, f), 1e-8, quick=(a, f) == (1e-12, "vm+md"))
           for f in ("vm+md", "vm", "cfr") for a in SMALL[:-1]]),
    Study("shortening by small loads", "tip force from 1e-12 to 1 EI/L^2, second-order", "closed form -a^2/15",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: shortening(floe, a, f), 1e-5, quick=(a, f) == (1e-6, "vm+md"))
           for f in ("nlffr", "vm+md") for a in (1e-12, 1e-9, 1e-6, 1e-3, 1)]),
    Study("small amplitudes in space", "tip forces from 1e-30 to 1e-9", "itself at amplitude 1e-6",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: in_space(floe, a, f), 1e-8, quick=False)
           for f in ("nlffr", "vm+md") for a in (1e-30, 1e-12, 1e-9)]),
    Study("small oscillations", "a pendulum released from 1e-10 to 1e-6 rad", "itself at 1e-4 rad",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: swung(floe, a, f), max(1e-7, 1e-15 / a), misses=Miss(SWINGS, 3e-11 / a))
           for f in ("nlffr", "vm+md") for a in (1e-10, 1e-9, 1e-6)],
          "limit: the round-off of an angle near pi/2, once"),
    Study("small drives", "a clamp rotated by 1e-30 to 1e-8 rad", "itself at 1e-5 rad",
          [Point(f"{a:g}, {f}", lambda floe, a=a, f=f: driven(floe, a, f), 1e-7, quick=(a, f) == (1e-12, "vm+md"))
           for f in ("nlffr", "vm+md") for a in (1e-30, 1e-16, 1e-12, 1e-8)]),
    Study("overload", "weight applied suddenly, 10 to 1e5 EI/L^3", "total energy does not rise; elastic energy >= 0",
          [Point(f"{w:g}, {f}, {r}", lambda floe, w=w, f=f, r=r: overloaded(floe, w, f, r), 1e-3, "did not converge",
                 quick=(w, f, r) == (1e3, "vm+md", "clamped"))
           for f in ("nlffr", "vm+md", "vm") for r in ("clamped", "pinned") for w in (1e1, 1e2, 1e3, 1e4, 1e5)]),
]
