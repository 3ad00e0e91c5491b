"""Beams on hubs that rotate at up to ten times their first frequency."""
import math

from floe import Floe, relative
from reference import CANTILEVER, rotating_beam, stretch
from scenes import cantilever, spatial_cantilever
from study import Miss, Point, Study

EA = 1e8  # stretch and Coriolis' coupling are of order gamma^2 / EA
FASTER = [0, 0.1, 0.5, 0.9, 1.1, 2, 5, 10]


def hub(speed, **more):
    scene = cantilever(48, EA=EA, modes=14, **more)
    scene["joints"]["clamp"] = {"type": "driven", "between": ["ground", "beam.start"], "angle": f"{speed!r}*t"}
    return scene


def lagging(floe: Floe, share, formulation):
    """Vibration in the plane of rotation: lag^2 = flap^2 - gamma^2, without Coriolis' coupling, which a stiff axis leaves out."""
    gamma = share * CANTILEVER
    exact = math.sqrt(rotating_beam(gamma)**2 - gamma**2)
    return abs(floe.campbell(hub(gamma), repr(gamma), formulation)[0][0][0] / exact - 1)


def flapping(floe: Floe, share, formulation):
    """Out of the plane of rotation."""
    gamma = share * CANTILEVER
    h = 12**0.5 / 10000
    scene = spatial_cantilever(2 * h, h, 24, modes=20, E=12 / (2 * h**4), rho=1 / (2 * h * h))
    scene["joints"]["clamp"] = {"type": "driven", "between": ["ground", "beam.start"], "axis": [0, 0, 1],
                                "angle": f"{gamma!r}*t"}
    scene["bodies"]["beam"]["frame"] = {"type": "clamped", "at": "start"}
    exact = rotating_beam(gamma)
    found = floe.campbell(scene, repr(gamma), formulation)[0]
    return min(abs(omega / exact - 1) for omega, _ in found)


def spun_up(floe: Floe, share, formulation):
    """From rest to so many first frequencies without a jerk, in the motion: the deflection against the path of nlffr, and
    at full order the stretch at the end against its closed form."""
    gamma, ramp, soft = share * CANTILEVER, 20.0, 1e6
    scene = cantilever(12, EA=soft, modes=6, motion={"end": 24.0, "step": 5e-3, "every": 20})
    scene["bodies"]["beam"]["damping"] = {"mass": 0.2}
    scene["joints"]["clamp"] = {
        "type": "driven", "between": ["ground", "beam.start"],
        "angle": f"t < {ramp} ? {gamma / ramp!r}*(t^2/2 + ({ramp}/(2*pi))^2*(cos(2*pi*t/{ramp}) - 1)) : "
                 f"{gamma!r}*(t - {ramp / 2})"}
    scene["probes"]["tip"]["quantity"] = "deflection"
    full = floe.run(scene, "nlffr")
    if formulation == "nlffr":
        return abs(full.end("tip.x") / stretch(gamma, soft) - 1)
    return relative(floe.run(scene, formulation).probes["tip.y"], full.probes["tip.y"])


def linear_fails(floe: Floe, share):
    """A linear elastic force beyond the first frequency has no stable rotation: growth sqrt(gamma^2 - omega^2) is reported."""
    gamma = share * CANTILEVER
    found = floe.campbell(hub(gamma), repr(gamma), "lffr")[0]
    growth = max(g for _, g in found)
    return abs(growth / math.sqrt(gamma**2 - CANTILEVER**2) - 1)


def linear_warns(floe: Floe, share):
    """The motion of such a body is kilometres long, or ends; floe says why."""
    scene = hub(share * CANTILEVER, motion={"end": 1, "step": 1e-3})
    scene["bodies"]["beam"]["initial"] = {"angular_velocity": share * CANTILEVER}
    moved = floe.run(scene, "lffr")
    assert moved.warned("rotates at"), f"no warning of the spin: {moved.warnings}"
    return 0.0


FEWER = Miss("drop_tolerance 1e-7 drops basis vectors with an independent part of 1e-7; 1e-9 satisfies this limit (and keeps noise elsewhere)", 0.02)
STUDIES = [
    Study("spin, in the plane", "speeds up to 10 first frequencies", "Rayleigh-Ritz in numpy",
          [Point(f"{s:g}, {f}", lambda floe, s=s, f=f: lagging(floe, s, f), 2e-4 if f == "nlffr" else 2e-3,
                 quick=(s, f) == (10, "vm+md"), misses=FEWER if (s, f) == (10, "vm+md") else None)
           for f in ("nlffr", "vm+md") for s in FASTER],
          "lag^2 = flap^2 - gamma^2 is a small difference at high speeds"),
    Study("spin, out of the plane", "speeds up to 10 first frequencies", "Rayleigh-Ritz in numpy",
          [Point(f"{s:g}, {f}", lambda floe, s=s, f=f: flapping(floe, s, f), 2e-4 if f == "nlffr" else 2e-3,
                 quick=(s, f) == (10, "vm+md")) for f in ("nlffr", "vm+md") for s in FASTER]),
    Study("spin-up", "from rest to 10 first frequencies", "closed form of the stretch; nlffr",
          [Point(f"{s:g}, {f}", lambda floe, s=s, f=f: spun_up(floe, s, f), 1e-3 if f == "nlffr" else 1e-2, quick=(s, f) == (10, "vm+md"),
                 misses=FEWER if (s, f) == (10, "vm+md") else None)
           for f in ("nlffr", "vm+md") for s in (0.5, 2, 10)]),
    Study("spin of a linear body", "beyond its first frequency", "closed form of the growth",
          [Point(f"{s:g}", lambda floe, s=s: linear_fails(floe, s), 1e-3, quick=s == 10) for s in (1.1, 2, 10)]),
    Study("spin of a linear body in motion", "0.5 to 10 first frequencies", "a warning with number and limit",
          [Point(f"{s:g}", lambda floe, s=s: linear_warns(floe, s), 1e-12, quick=s == 10) for s in (0.5, 2, 10)]),
]
