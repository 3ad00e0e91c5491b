"""Steps from 1e-8 to 1e2 of the first period, a million of them, a thousand revolutions."""
import math

import numpy

from floe import Floe, relative
from reference import CANTILEVER, stretch
from scenes import cantilever, pendulum, tip_force
from study import Answer, Point, Study

PERIOD = 2 * math.pi / CANTILEVER


def one_mode(floe: Floe, h, steps=1000):
    """One mode under a step load is an oscillator: w = 4F/omega^2 (1 - cos omega t), for the square of its shape at the
    tip is 4. Error of the scheme: (omega h)^2 / 6 in phase, at most."""
    F = 1e-9
    scene = cantilever(40, EA=1e4, loads=tip_force(0, F), motion={"end": steps * h * PERIOD, "step": h * PERIOD})
    scene["bodies"]["beam"]["reduction"] = {"modes": {"count": 1, "alone": 1}, "derivatives": "none", "attachment": "none"}
    moved = floe.run(scene, "vm")
    exact = 8 * F / CANTILEVER**2 * numpy.sin(CANTILEVER * moved.t / 2)**2
    assert len(moved.t) == steps + 1, f"{len(moved.t) - 1} steps, not {steps}"
    return relative(moved.probes["tip.y"], exact)


def falling(floe: Floe, h, formulation="vm+md", steps=200):
    """A rigid pendulum, horizontal: y = -3/4 g t^2 at the tip, while t is short. Constraints and multipliers in force."""
    scene = pendulum(motion={"end": steps * h, "step": h})
    scene["bodies"]["rod"]["rigid"] = True
    moved = floe.run(scene, formulation)
    assert len(moved.t) == steps + 1, f"{len(moved.t) - 1} steps, not {steps}"
    violation = moved.summary["constraints"]["greatest_violation"]
    assert violation < 1e-14, f"constraints are off by {violation}"
    return relative(moved.probes["tip.y"], -0.75 * 9.81 * moved.t**2)


def slow(floe: Floe, h, formulation):
    """A load that changes in 1000 steps of h periods each: equilibria follow one another, w = F/3."""
    F, end = 1e-3, 1000 * h * PERIOD
    scene = cantilever(8, EA=1e4, loads=tip_force(0, f"{F}*(1 - cos(2*pi*t/{end!r}))/2"),
                       motion={"end": end, "step": h * PERIOD})
    moved = floe.run(scene, formulation)
    return relative(moved.probes["tip.y"], F / 6 * (1 - numpy.cos(2 * numpy.pi * moved.t / end)))


def coarse(floe: Floe, h, formulation):
    """A load put on at once, in steps of h periods: no step resolves what happens, and floe says so. What it still must
    do: keep energy bounded by the work done, and come to rest at the equilibrium, because the scheme damps."""
    F = 0.1
    scene = cantilever(8, EA=1e4, loads=tip_force(0, F), motion={"end": 200 * h * PERIOD, "step": h * PERIOD})
    moved = floe.run(scene, formulation)
    assert moved.warned("steps per period"), f"no warning of the step: {moved.warnings}"
    kinetic, elastic, _ = moved.energy.T
    assert elastic.min() >= 0 and kinetic.min() >= 0 and elastic.max() < 20 * F * F / 6, f"elastic energy {elastic.max():.3g}"
    warning = next(w for w in moved.warnings if "steps per period" in w)
    return Answer(abs(moved.end("tip.y") / (F / 3) - 1), warning)


def long_swing(floe: Floe, steps, formulation="vm+md"):
    """A rigid pendulum in so many steps of 1/100 of its small period. Energy: what the scheme damps only."""
    period = 2 * math.pi * math.sqrt(2 / 3 / 9.81)
    scene = pendulum(motion={"end": steps * period / 100, "step": period / 100, "every": max(1, steps // 1000)})
    scene["bodies"]["rod"]["rigid"] = True
    scene["bodies"]["rod"]["initial"] = {"angle": "-pi/2 + 0.5"}
    moved = floe.run(scene, formulation)
    assert moved.summary["integration"]["steps"] == steps, f"{moved.summary['integration']['steps']} steps, not {steps}"
    total = moved.energy.sum(axis=1)
    swing = moved.energy[:, 0].max()
    drift = moved.summary["constraints"]["greatest_violation"]
    return Answer(drift, f"total energy changed by {(total[-1] - total[0]) / swing:.1e} of the kinetic")


def dissipated(steps, steps_per_period, rho=0.8):
    """Part of the energy of an oscillator that generalised-alpha dissipates: its amplification matrix."""
    m, f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma, beta, k = 0.5 - m + f, 0.25 * (1 - m + f)**2, (2 * math.pi / steps_per_period)**2
    left = numpy.array([[1, 0, -beta], [0, 1, -gamma], [(1 - f) * k, 0, 1 - m]])
    right = numpy.array([[1, 1, 0.5 - beta], [0, 1, 1 - gamma], [-f * k, 0, -m]])
    return 1 - abs(numpy.linalg.eigvals(numpy.linalg.solve(left, right))).max()**(2 * steps)


def long_vibration(floe: Floe, steps, formulation):
    """A beam released in the shape of its first mode, in so many steps of 1/200 of its period: what is dissipated."""
    scene = cantilever(6, EA=1e4, modes=2, motion={"end": steps * PERIOD / 200, "step": PERIOD / 200,
                                                   "every": max(1, steps // 100000)})
    b = math.sqrt(CANTILEVER)
    c = (math.cosh(b) + math.cos(b)) / (math.sinh(b) + math.sin(b))
    scene["bodies"]["beam"]["initial"] = {
        "deformation": [0, f"1e-3*(cosh({b!r}*x) - cos({b!r}*x) - {c!r}*(sinh({b!r}*x) - sin({b!r}*x)))"]}
    scene["bodies"]["beam"]["reduction"] = {"modes": {"count": 1, "alone": 1}, "derivatives": "none", "attachment": "none"}
    moved = floe.run(scene, formulation)
    total = moved.energy.sum(axis=1)
    lost = 1 - total[-1] / total[0]
    return Answer(abs(lost - dissipated(steps, 200)), f"dissipated {100 * lost:.3f} %; {len(moved.t)} rows stored")


def turning(floe: Floe, turns, formulation):
    """The stretch of a damped beam on a hub at half its first frequency after so many turns, and what constraints are off.
    The ramp leaves a vibration, which damping takes away."""
    gamma, EA, ramp = CANTILEVER / 2, 1e4, 40.0
    scene = cantilever(8, EA=EA, modes=3, motion={"end": ramp + turns * 2 * math.pi / gamma, "step": 2e-2, "every": 100})
    scene["bodies"]["beam"]["damping"] = {"mass": 0.6}
    scene["joints"]["clamp"] = {
        "type": "driven", "between": ["ground", "beam.start"],
        "angle": f"t < {ramp} ? {gamma / ramp!r}*(t^2/2 + ({ramp}/(2*pi))^2*(cos(2*pi*t/{ramp}) - 1)) : "
                 f"{gamma!r}*(t - {ramp / 2})"}
    scene["probes"]["tip"]["quantity"] = "deflection"
    moved = floe.run(scene, formulation)
    return moved.end("tip.x"), moved.summary["constraints"]["greatest_violation"]


def revolutions(floe: Floe, turns, formulation):
    """At full order the closed form of the stretch; of the reduced model, whose columns do not hold all of it, the same as
    after 20 turns."""
    x, drift = turning(floe, turns, formulation)
    known = stretch(CANTILEVER / 2, 1e4) if formulation == "nlffr" else turning(floe, 20, formulation)[0]
    return Answer(abs(x / known - 1), f"constraints within {drift:.1e}")


def box(omega, **more):
    """A free rigid box in space: principal moments 5, 10/4 ..., from its shape."""
    return {"bodies": {"box": {"rigid": True, "mesh": {"line": {"from": [-0.5, 0, 0], "to": [0.5, 0, 0], "elements": 8}},
                               "section": {"shape": "rectangle", "width": 0.6, "height": 0.2, "orientation": [0, 1, 0]},
                               "material": {"E": 1, "nu": 0.3, "rho": 1000}, "initial": {"angular_velocity": omega}}},
            "probes": {"corner": {"at": "box.end", "quantity": "position"}}, **more}


def tumbling(floe: Floe, turns):
    """A free body about its middle axis, which tips over again and again: unit quaternions, energy, momentum of rest."""
    omega = [0.01, 0, 5]
    end = turns * 2 * math.pi / 5
    scene = box(omega, motion={"end": end, "step": 2 * math.pi / 5 / 100, "every": max(1, turns // 10)})
    moved = floe.run(scene, "vm+md")
    norms = abs(numpy.linalg.norm(moved.attitude.reshape(len(moved.t), 4), axis=1) - 1).max()
    kinetic = moved.energy[:, 0]
    return Answer(float(norms), f"kinetic energy within {abs(kinetic / kinetic[0] - 1).max():.1e}")


def awkward(floe: Floe, end, step, expected):
    """As many steps as there have to be, the last one at the end."""
    scene = pendulum(motion={"end": end, "step": step, "every": 1000})
    scene["bodies"]["rod"]["rigid"] = True
    moved = floe.run(scene, "vm+md")
    steps = moved.summary["integration"]["steps"]
    assert steps == expected, f"{steps} steps, not {expected}"
    return abs(moved.t[-1] / end - 1)


STUDIES = [
    Study("steps, one mode", "1e-8 to 1e-2 of the first period, 1000 steps each", "closed form 4F/omega^2 (1 - cos omega t)",
          [Point(f"{h:g} T", lambda floe, h=h: one_mode(floe, h), max(1e-5, 1000 * 2 * math.pi * h * (2 * math.pi * h)**2 / 6), quick=h in (1e-8, 1e-3))
           for h in (1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)]),
    Study("steps, constraints", "1e-10 to 1e-4 s, a pendulum's first 200 steps", "closed form -3/4 g t^2",
          [Point(f"{h:g} s, {f}", lambda floe, h=h, f=f: falling(floe, h, f), 1e-8 + 100 * (200 * h)**4 + 1e-6,
                 quick=(h, f) == (1e-8, "vm+md"))
           for f in ("vm+md", "nlffr") for h in (1e-12, 1e-10, 1e-8, 1e-6, 1e-4)]),
    Study("long steps under slow loads", "1 to 1e4 first periods per step", "closed form F/3",
          [Point(f"{h:g} T, {f}", lambda floe, h=h, f=f: slow(floe, h, f), 1e-4, quick=(h, f) == (1e2, "vm+md"))
           for f in ("nlffr", "vm+md") for h in (1e0, 1e1, 1e2, 1e4)]),
    Study("long steps under sudden loads", "1 to 1e4 first periods per step",
          "a warning, bounded energy, and the final equilibrium",
          [Point(f"{h:g} T, {f}", lambda floe, h=h, f=f: coarse(floe, h, f), 1e-2, "did not converge",
                 quick=(h, f) == (1e2, "vm+md"))
           for f in ("nlffr", "vm+md") for h in (1e0, 1e1, 1e2, 1e4)]),
    Study("many steps", "1e4 to 1e6 steps of a pendulum", "constraints met to round-off",
          [Point(f"{n:g}, {f}", lambda floe, n=n, f=f: long_swing(floe, n, f), 1e-13, quick=(n, f) == (10**4, "vm+md"))
           for f, n in [("vm+md", 10**4), ("vm+md", 10**6), ("nlffr", 10**5)]]),
    Study("many vibrations", "1e6 steps of 1/200 period", "energy that the scheme dissipates, closed form",
          [Point(f"{n:g}, {f}", lambda floe, n=n, f=f: long_vibration(floe, n, f), 1e-4, quick=False)
           for f, n in [("vm", 10**5), ("vm", 10**6)]]),
    Study("revolutions", "10 to 1000 revolutions of a flexible beam on a hub", "closed form of its stretch; 20 revolutions",
          [Point(f"{n}, {f}", lambda floe, n=n, f=f: revolutions(floe, n, f), 1e-5, quick=(n, f) == (100, "vm+md"))
           for f, n in [("vm+md", 100), ("vm+md", 1000), ("nlffr", 1000)]]),
    Study("tumbling", "10 to 1000 revolutions about the intermediate axis", "unit quaternions",
          [Point(f"{n}", lambda floe, n=n: tumbling(floe, n), 1e-14, quick=n == 100) for n in (10, 100, 1000)]),
    Study("ends and steps that do not fit", "1e3 to 1e6 steps", "their number, and the time at the end",
          [Point(f"{end:g} by {step!r}", lambda floe, end=end, step=step, n=n: awkward(floe, end, step, n), 1e-12,
                 quick=n < 20000)
           for end, step, n in [(1, 1e-3, 1000), (1, 1 / 3000, 3000), (0.3, 1e-4, 3000), (1, 0.7e-3, 1429),
                                (1e-9, 1e-13, 10000), (1, 1e-5, 100000), (10, 1e-5, 10**6), (7, 7e-6, 10**6)]]),
]
