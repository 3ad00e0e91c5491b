"""Neighbours that differ: stiffness and mass by 1e8, tips that weigh a millionth or a million times the beam."""
import numpy

from floe import Floe
from reference import beam_in_segments, with_tip_mass
from scenes import cantilever
from study import Answer, Point, Study

CONTRASTS = [1e-12, 1e-8, 1e-4, 1, 1e4, 1e8, 1e12]


def two_beams(stiffness, mass=1.0, modes=8):
    """Of length 1 each, in one line; the outer one so many times as stiff and as heavy."""
    def beam(x, s, m):
        return {"mesh": {"line": {"from": [x, 0], "to": [x + 1, 0], "elements": 8}},
                "section": {"EA": 1e4 * s, "EI": s, "rhoA": m}, "frame": {"type": "clamped", "at": "start"},
                "reduction": {"modes": modes, "derivatives": "all", "attachment": "all"}}
    scene = cantilever()
    scene["bodies"] = {"beam": beam(0, 1.0, 1.0), "outer": beam(1, stiffness, mass)}
    scene["joints"]["weld"] = {"type": "fixed", "between": ["beam.end", "outer.start"]}
    scene["probes"] = {"tip": {"at": "outer.end"}}
    return scene


def bent(floe: Floe, c, formulation):
    """w = P (7/3 + 1/(3c)), so small that nothing is nonlinear."""
    exact = 7 / 3 + 1 / (3 * c)
    P = 1e-7 / exact
    scene = two_beams(c)
    scene["loads"] = {"tip": {"type": "force", "at": "outer.end", "force": [0, f"{P!r}*t"]}}
    return abs(floe.static(scene, formulation, "--at", "1", "--steps", "1").end("tip.y") / (P * exact) - 1)


def standing(scene):
    """A hub that could rotate, for floe campbell."""
    scene["joints"]["clamp"] = {"type": "driven", "between": ["ground", "beam.start"], "angle": "0*t"}
    return scene


def frequency_error(points, exact):
    """Of the first vibration; or a message that so low a frequency cannot be distinguished from zero."""
    first = points[0]["vibrations"][0]
    if not first["zero"]:
        return abs(first["rad_per_s"] / exact - 1)
    assert first["below_rad_per_s"] > exact, f"indistinguishable from zero below {first['below_rad_per_s']}, and it is {exact}"
    return Answer(0.0, f"{exact:.1e} rad/s: \"rigid-body mode, or below {first['below_rad_per_s']:.2g} rad/s\"")


def vibrating(floe: Floe, stiffness, mass, formulation):
    exact = beam_in_segments([(1, 1, 1), (1, stiffness, mass)])
    return frequency_error(floe.campbell_points(standing(two_beams(stiffness, mass)), "0", formulation), exact)


DECK = """*NODE
{nodes}
*ELEMENT, TYPE=B31, ELSET=INNER
{inner}
*ELEMENT, TYPE=B31, ELSET=OUTER
{outer}
*MATERIAL, NAME=INNER
*ELASTIC
{E[0]!r}, 0.3
*DENSITY
{rho[0]!r}
*MATERIAL, NAME=OUTER
*ELASTIC
{E[1]!r}, 0.3
*DENSITY
{rho[1]!r}
*BEAM SECTION, SECTION=RECT, ELSET=INNER, MATERIAL=INNER
1e-3, 1.5e-3
0, 1, 0
*BEAM SECTION, SECTION=RECT, ELSET=OUTER, MATERIAL=OUTER
1e-3, 1.5e-3
0, 1, 0
*NSET, NSET=ROOT
1
*NSET, NSET=TIP
17
"""


def one_body(stiffness, mass, inner_mass=1.0):
    """The two beams as parts of one mesh in space, with flat sections of a thousandth of the length."""
    def cells(first):
        return "\n".join(f"{i}, {i}, {i + 1}" for i in range(first, first + 8))
    b, h = 1.5e-3, 1e-3  # the softer way
    deck = DECK.format(nodes="\n".join(f"{i + 1}, {i / 8!r}, 0.0, 0.0" for i in range(17)), inner=cells(1), outer=cells(9),
                       E=[12 / (b * h**3), 12 * stiffness / (b * h**3)], rho=[inner_mass / (b * h), mass / (b * h)])
    return {"bodies": {"beam": {"mesh": {"file": {"path": "beam.inp"}}, "reduction": {"modes": 3}}},
            "joints": {"root": {"type": "fixed", "between": ["ground", "beam.ROOT"]}}}, {"beam.inp": deck}


def modes_of_parts(floe: Floe, stiffness, mass):
    scene, files = one_body(stiffness, mass)
    return abs(floe.modes(scene, files=files)[0] / beam_in_segments([(1, 1, 1), (1, stiffness, mass)]) - 1)


def tip_mass(floe: Floe, ratio, formulation):
    scene = cantilever()
    scene["bodies"]["tip"] = {"rigid": True, "mesh": {"line": {"from": [1 - 5e-5, 0], "to": [1 + 5e-5, 0], "elements": 2}},
                              "section": {"rhoA": ratio / 1e-4}}
    scene["joints"]["weld"] = {"type": "fixed", "between": ["beam.end", "tip.middle"]}
    return frequency_error(floe.campbell_points(standing(scene), "0", formulation), with_tip_mass(ratio))


def in_motion(floe: Floe, ratio, formulation):
    """Tip mass pushed by a force that is switched on: w = F/k (1 - cos omega t), to the share of the higher modes."""
    omega, F = with_tip_mass(ratio), 1e-6
    scene = cantilever(loads={"push": {"type": "force", "at": "tip.middle", "force": [0, F]}})
    scene["bodies"]["tip"] = {"rigid": True, "mesh": {"line": {"from": [1 - 5e-5, 0], "to": [1 + 5e-5, 0], "elements": 2}},
                              "section": {"rhoA": ratio / 1e-4}}
    scene["joints"]["weld"] = {"type": "fixed", "between": ["beam.end", "tip.middle"]}
    period = 2 * numpy.pi / omega
    scene["motion"] = {"end": period, "step": period / 2000}
    moved = floe.run(scene, formulation)
    exact = F / 3 * (1 - numpy.cos(omega * moved.t))
    return float(abs(moved.probes["tip.y"] - exact).max() / (2 * F / 3))


STUDIES = [
    Study("contrast of stiffness", "two beams in line, the outer one 1e-12 to 1e12 times as stiff", "closed form",
          [Point(f"{c:g}, {f}", lambda floe, c=c, f=f: bent(floe, c, f), 1e-7, quick=(c, f) in ((1e-8, "vm+md"), (1e8, "nlffr")))
           for f in ("nlffr", "vm+md") for c in CONTRASTS]),
    Study("contrast of stiffness and mass", "the same, 1e-8 to 1e8 in both, first frequency", "own beam elements in numpy",
          [Point(f"stiffness {s:g}, mass {m:g}, {f}", lambda floe, s=s, m=m, f=f: vibrating(floe, s, m, f), 1e-4,
                 quick=(s, m, f) in ((1e8, 1e8, "nlffr"), (1e8, 1e-8, "vm+md")))
           for f in ("nlffr", "vm+md") for s in (1e-8, 1, 1e8) for m in (1e-8, 1, 1e8)]),
    Study("contrast within a body", "parts of one mesh in space, 1e-8 to 1e8 in stiffness and mass", "the same",
          [Point(f"stiffness {s:g}, mass {m:g}", lambda floe, s=s, m=m: modes_of_parts(floe, s, m), 1e-4,
                 quick=(s, m) == (1e-8, 1e8)) for s in (1e-8, 1, 1e8) for m in (1e-8, 1, 1e8)]),
    Study("tip mass", "1e-6 to 1e6 times the beam's, first frequency", "closed form",
          [Point(f"{r:g}, {f}", lambda floe, r=r, f=f: tip_mass(floe, r, f), 1e-5, quick=r == 1e6)
           for f in ("nlffr", "vm+md") for r in (1e-6, 1e-3, 1, 1e3, 1e6, 1e9)]),
    Study("tip mass in motion", "1e2 to 1e6 times the beam's, a period of a step load", "closed form of one mode",
          [Point(f"{r:g}, {f}", lambda floe, r=r, f=f: in_motion(floe, r, f), 1e-2 if r < 1e3 else 1e-3, quick=False)
           for f in ("nlffr", "vm+md") for r in (1e2, 1e4, 1e6)]),
]
