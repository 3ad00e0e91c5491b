"""The scenes that are written in many units, each with all that is asked of it, made free of units."""
import dataclasses
import math

from scenes import cantilever, pendulum, plate, tip_force
from units import QUANTITIES


@dataclasses.dataclass
class Machine:
    text: str
    answers: object  # of a Floe, a function that writes a scene in units, and these units
    limit: float = 1e-8


def free_of_units(scene, outcome, units):
    """Times, probes and energies in metres, kilograms and seconds."""
    all_values = {"t": outcome.t / units.time, "energy": outcome.energy / units.factor((2, 1, -2))}
    for name, probe in scene["probes"].items():
        dimension = QUANTITIES[probe.get("quantity", "displacement")]
        all_values[name] = outcome.vector(name) / units.factor(dimension)
    return all_values


def motion(scene, formulation="vm+md", command="run", *words):
    def answers(floe, convert, units):
        outcome = getattr(floe, command)(convert(scene), formulation, *words)
        return free_of_units(scene, outcome, units)
    return answers


def crank():
    """A driven crank, a flexible rod, a slider between stops, pushed back by a spring."""
    d = 0.006
    round_bar = {"A": math.pi * d**2 / 4, "I": math.pi * d**4 / 64}
    steel = {"E": 2e11, "rho": 7870}
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "crank": {"rigid": True, "mesh": {"line": {"from": [0, 0], "to": [0.15, 0], "elements": 1}},
                      "section": round_bar, "material": steel, "initial": {"angular_velocity": 150}},
            "rod": {"mesh": {"line": {"from": [0, 0], "to": [0.3, 0], "elements": 8}}, "section": round_bar,
                    "material": steel, "frame": "pinned", "damping": {"stiffness": 1e-6},
                    "reduction": {"modes": 2, "derivatives": "all"},
                    "initial": {"position": [0.15, 0], "velocity": [0, 22.5], "angular_velocity": -75}},
            "slider": {"rigid": True, "mesh": {"line": {"from": [-0.02, 0], "to": [0.02, 0], "elements": 2}},
                       "section": {"rhoA": 0.83}, "initial": {"position": [0.45, 0]}}},
        "joints": {
            "motor": {"type": "driven", "between": ["ground", "crank.start"], "speed": "150 + 20*sin(100*t)"},
            "crank-pin": {"type": "revolute", "between": ["crank.end", "rod.start"]},
            "slider-pin": {"type": "revolute", "between": ["rod.end", "slider.middle"]},
            "guide": {"type": "prismatic", "between": ["ground", "slider.middle"], "axis": [1, 0],
                      "limits": {"lower": -0.28, "stiffness": 1e5, "damping": 10}},
            "back": {"type": "spring", "between": [{"body": "ground", "node": [0.6, 0.1]}, "slider.end"],
                     "stiffness": 500, "viscosity": 1, "length": 0.1}},
        "loads": {"push": {"type": "force", "at": "slider.middle", "force": ["5*sin(80*t)", 0]}},
        "motion": {"end": 0.02, "step": 5e-5, "every": 8},
        "probes": {"middle": {"at": "rod.middle", "quantity": "deflection"},
                   "slider": {"at": "slider.middle"},
                   "speed": {"at": "rod.end", "quantity": "velocity"},
                   "turn": {"at": "rod.end", "quantity": "rotation"}}}


def arm_in_space():
    """A flexible arm with a bend on a driven hub, a hinge with stops and a ball joint at its end, under gravity."""
    square = {"shape": "rectangle", "width": 0.02, "height": 0.03, "orientation": [0, 1, 0.3]}
    plastic = {"E": 2e9, "nu": 0.3, "rho": 1000}
    return {
        "gravity": [0, 0, -9.81],
        "bodies": {
            "arm": {"mesh": {"polyline": {"points": [[0, 0, 0], [0.8, 0, 0], [1, 0.2, 0.1]], "elements": [5, 3]}},
                    "section": square, "material": plastic, "frame": {"type": "clamped", "at": "start"},
                    "reduction": {"modes": 3, "derivatives": "all"}},
            "hand": {"mesh": {"line": {"from": [1, 0.2, 0.1], "to": [1.3, 0.2, 0.1], "elements": 3}},
                     "section": square, "material": plastic, "reduction": {"modes": 2, "derivatives": "all"}},
            "load": {"rigid": True, "mesh": {"line": {"from": [1.3, 0.2, 0.1], "to": [1.3, 0.2, -0.2], "elements": 2}},
                     "section": square, "material": plastic}},
        "joints": {
            "hub": {"type": "driven", "between": ["ground", "arm.start"], "axis": [0, 0, 1], "angle": "2*(1 - cos(3*t))"},
            "wrist": {"type": "revolute", "between": ["arm.end", "hand.start"], "axis": [0, 1, 0],
                      "limits": {"lower": -0.2, "upper": 0.2, "stiffness": 200, "damping": 0.5}},
            "ball": {"type": "spherical", "between": ["hand.end", "load.start"]}},
        "loads": {"wind": {"type": "force", "at": "load.end", "force": ["0.3*sin(20*t)", "0.2", 0]}},
        "motion": {"end": 0.25, "step": 5e-4, "every": 10},  # one hit; steps of 1 ms go 5 widths of the stop at once
        "probes": {"end": {"at": "load.end", "quantity": "position"}, "arm": {"at": "arm.end", "quantity": "deflection"},
                   "speed": {"at": "hand.end", "quantity": "velocity"},
                   "turn": {"at": "load.end", "quantity": "rotation"}}}


def wing():
    return plate(1, 0.5, (6, 3), 5e-3, E=7e10, rho=2700, modes=3, ground={"acceleration": ["3*sin(40*t)", 0, "5*t"]},
                 loads={"lift": {"type": "pressure", "body": "plate", "pressure": "300*sin(30*t)"}},
                 motion={"end": 0.2, "step": 1e-3, "every": 4})


def flight():
    """A plate that nothing holds, spinning, pushed at a corner."""
    scene = plate(1, 0.5, (4, 2), 5e-3, "quadrilaterals", E=7e10, rho=2700, modes=3,
                  loads={"push": {"type": "force", "at": "plate.p3", "force": [0, "2*t", "20*sin(50*t)"]}},
                  motion={"end": 0.2, "step": 1e-3, "every": 4})
    scene["joints"] = {}
    scene["bodies"]["plate"]["initial"] = {"position": [3, 2, 1], "rotation": [0.2, -0.4, 1], "velocity": [1, 0, 2],
                                           "angular_velocity": [0.5, 9, 1]}
    scene["probes"] = {"corner": {"at": "plate.p3", "quantity": "position"},
                       "bending": {"at": "plate.p3", "quantity": "deflection"}}
    return scene


def four_bar():
    """Four hinges with parallel axes in space: three of their rows repeat others."""
    bar = {"section": {"shape": "rectangle", "width": 0.02, "height": 0.02, "orientation": [0, 0, 1]},
           "material": {"E": 7e10, "nu": 0.3, "rho": 2700}}
    along = (1.7**2 - 1.2**2 + 4.25) / (2 * 4.25**0.5)
    off = (1.7**2 - along**2)**0.5
    d = 4.25**0.5
    far = [along * 2 / d + off * 0.5 / d, 0.5 - along * 0.5 / d + off * 2 / d, 0]
    knee = [0, 0.5, 0]

    def line(a, b, elements):
        return {"line": {"from": a, "to": b, "elements": elements}}
    hinge = {"type": "revolute", "axis": [0, 0, 1]}
    return {
        "gravity": [0, -9.81, 0],
        "bodies": {"crank": {**bar, "rigid": True, "mesh": line([0, 0, 0], knee, 2)},
                   "coupler": {**bar, "mesh": line(knee, far, 4), "frame": "pinned",
                               "reduction": {"modes": 2, "derivatives": "all"}},
                   "rocker": {**bar, "rigid": True, "mesh": line(far, [2, 0, 0], 2)}},
        "joints": {"a": {**hinge, "between": ["ground", "crank.start"]}, "b": {**hinge, "between": ["crank.end", "coupler.start"]},
                   "c": {**hinge, "between": ["coupler.end", "rocker.start"]},
                   "d": {**hinge, "between": ["ground", "rocker.end"]}},
        "motion": {"end": 0.5, "step": 2e-3, "every": 5},
        "probes": {"middle": {"at": "coupler.middle", "quantity": "position"}}}


def adaptive():
    """Steps by tolerance, and an event where a probe passes a value."""
    return pendulum(motion={"end": 1, "step": 1e-3, "tolerance": 1e-4},
                    events={"stop": {"stop": True, "probe": "tip.x", "crosses": -0.5}})


def resting(scene, formulation):
    def answers(floe, convert, units):
        outcome = floe.static(convert(scene), formulation, "--at", repr(scene["motion"]["end"] * units.time), "--steps", "2")
        return free_of_units(scene, outcome, units)
    return answers


def spectra(floe, convert, units):
    """Vibrations of a turning beam and plate, and modes."""
    beam = cantilever(8, EA=1e4)
    beam["joints"]["clamp"] = {"type": "driven", "between": ["ground", "beam.start"], "angle": "2*t"}
    turning = floe.campbell(convert(beam), f"{2 / units.time!r},{4 / units.time!r}")
    shell = plate(1, 0.5, (6, 3), 5e-3, E=7e10, rho=2700, motion={"end": 1e-3, "step": 1e-3})
    modes = floe.run(convert(shell), "vm").summary["bodies"][0]["frequencies"]  # with all digits
    return {"campbell": [[omega * units.time for omega, _ in at[:4]] for at in turning],
            "modes": [mode["rad_per_s"] * units.time for mode in modes]}


def estimates(floe, convert, units):
    """What floe run says of its own error: to a hundredth of it."""
    scene = cantilever(8, EA=1e4, modes=2, loads=tip_force(0, "0.5*sin(9*t)"), motion={"end": 2, "step": 5e-3})
    estimate = floe.run(convert(scene), "vm+md", estimate=True).summary["estimate"]
    return {"estimate": [estimate["deformation"], estimate["probes"]["tip"]]}


MACHINES = {
    "crank": Machine("crank, flexible rod, slider, stops and springs, reduced", motion(crank())),
    "full-order crank": Machine("the same, nlffr", motion(crank(), "nlffr")),
    "crank, exact beams": Machine("the same, cfr", motion(crank(), "cfr")),
    "arm in space": Machine("driven arm, hinge with stops, ball joint, gravity, reduced", motion(arm_in_space())),
    "full-order arm in space": Machine("the same, nlffr", motion(arm_in_space(), "nlffr")),
    "wing": Machine("plate under follower pressure on a moving ground, reduced", motion(wing())),
    "flight": Machine("free spinning plate, pushed at a corner, reduced", motion(flight())),
    "four-bar": Machine("four-bar in space with redundant constraints", motion(four_bar())),
    "adaptive": Machine("pendulum, adaptive steps, stopped by a probe event", motion(adaptive())),
    "equilibria": Machine("beam bent by PL^2/EI = 1", resting(cantilever(8, loads=tip_force(0, "t")), "vm+md")),
    "full-order equilibria": Machine("the same, nlffr", resting(cantilever(8, loads=tip_force(0, "t")), "nlffr")),
    "spectra": Machine("Campbell diagram and modes", spectra),
    "estimates": Machine("estimated errors", estimates, 1e-2),
}
