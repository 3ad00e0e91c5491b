"""A scene written in other units. Numbers and formulas of t are multiplied by what their dimension says."""
import json
import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Units:
    """How many new units a metre, a kilogram and a second are."""
    length: float
    mass: float
    time: float

    def factor(self, dimension):
        a, b, c = dimension
        return self.length**a * self.mass**b * self.time**c


NONE, LENGTH, TIME = (0, 0, 0), (1, 0, 0), (0, 0, 1)
FORCE, MOMENT, PRESSURE = (1, 1, -2), (2, 1, -2), (-1, 1, -2)
SPEED, RATE, ACCELERATION = (1, 0, -1), (0, 0, -1), (1, 0, -2)

# By section and key; a key of several meanings is told by the type of its joint or load.
DIMENSIONS = {
    "line": {"from": LENGTH, "to": LENGTH}, "polyline": {"points": LENGTH},
    "plate": {"origin": LENGTH, "along": LENGTH, "across": LENGTH},
    "section": {"A": (2, 0, 0), "I": (4, 0, 0), "EA": FORCE, "EI": (3, 1, -2), "rhoA": (-1, 1, 0), "rhoI": (1, 1, 0),
                "thickness": LENGTH, "width": LENGTH, "height": LENGTH, "radius": LENGTH, "wall": LENGTH},
    "material": {"E": PRESSURE, "rho": (-3, 1, 0)},
    "damping": {"mass": RATE, "stiffness": TIME, "modal": NONE},
    "initial": {"position": LENGTH, "velocity": SPEED, "angular_velocity": RATE, "rotation": NONE, "angle": NONE},
    "joint": {"angle": NONE, "axis": NONE, "second_axis": NONE, "position": LENGTH, "stiffness": (0, 1, -2),
              "viscosity": (0, 1, -1), "length": LENGTH, "torsional_stiffness": MOMENT,
              "torsional_viscosity": (2, 1, -1), "translation": (0, 1, -2), "rotation": MOMENT},
    "turn": {"lower": NONE, "upper": NONE, "stiffness": MOMENT, "damping": (2, 1, -1), "width": NONE},
    "slide": {"lower": LENGTH, "upper": LENGTH, "stiffness": (0, 1, -2), "damping": (0, 1, -1), "width": LENGTH},
    "force": {"force": FORCE}, "moment": {"moment": MOMENT}, "distributed": {"force": (0, 1, -2)},
    "pressure": {"pressure": PRESSURE},
    "motion": {"end": TIME, "step": TIME, "tolerance": NONE, "spectral_radius": NONE, "every": NONE},
}
QUANTITIES = {"position": LENGTH, "displacement": LENGTH, "deflection": LENGTH, "velocity": SPEED, "rotation": NONE}


def multiplied(value, factor, units):
    if isinstance(value, list):
        return [multiplied(v, factor, units) for v in value]
    if isinstance(value, str):
        return f"{factor!r}*({re.sub(r'(?<![a-zA-Z_])t(?![a-zA-Z_0-9])', f'(t/{units.time!r})', value)})"
    return value * factor


def _rewrite(mapping, kind, units):
    for key, dimension in DIMENSIONS[kind].items():
        if key in mapping:
            mapping[key] = multiplied(mapping[key], units.factor(dimension), units)


def _places(tree, units):
    if isinstance(tree, dict):
        if set(tree) == {"body", "node"}:
            tree["node"] = multiplied(tree["node"], units.factor(LENGTH), units)
        for value in tree.values():
            _places(value, units)
    elif isinstance(tree, list):
        for value in tree:
            _places(value, units)


def in_units(scene, units):
    scene = json.loads(json.dumps(scene))  # no part of it twice
    _places(scene, units)
    for key in ("gravity",):
        if key in scene:
            scene[key] = multiplied(scene[key], units.factor(ACCELERATION), units)
    if "ground" in scene:
        scene["ground"]["acceleration"] = multiplied(scene["ground"]["acceleration"], units.factor(ACCELERATION), units)
    for body in scene["bodies"].values():
        for kind, mesh in body["mesh"].items():
            _rewrite(mesh, kind, units)
        for kind in ("section", "material", "damping", "initial"):
            _rewrite(body.get(kind, {}), kind, units)
    for joint in scene.get("joints", {}).values():
        if "speed" in joint:
            joint["speed"] = multiplied(joint["speed"], units.factor(RATE if joint["type"] == "driven" else SPEED), units)
        _rewrite(joint, "joint", units)
        turns = joint["type"] == "revolute"
        _rewrite(joint.get("limits", {}), "turn" if turns else "slide", units)
    for load in scene.get("loads", {}).values():
        _rewrite(load, load["type"], units)
    for event in scene.get("events", {}).values():
        for key, dimension in (("at", TIME), ("crosses", LENGTH)):
            if key in event:
                event[key] *= units.factor(dimension)
    _rewrite(scene.get("motion", {}), "motion", units)
    return scene
