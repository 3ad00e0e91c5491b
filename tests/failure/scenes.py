"""The scenes of the failure tests: one small cantilever, changed in one place each (JSON is YAML)."""
import copy
import json

BASE = {
    "bodies": {"beam": {
        "mesh": {"line": {"from": [0, 0], "to": [1, 0], "elements": 8}},
        "section": {"EA": 12000, "EI": 1, "rhoA": 1},
        "frame": "pinned",
        "reduction": {"modes": 3, "derivatives": "all"}}},
    "joints": {"clamp": {"type": "fixed", "between": ["ground", "beam.start"]}},
    "loads": {"tip": {"type": "force", "at": "beam.end", "force": [0, "0.5*sin(9*t)"]}},
    "motion": {"end": 0.05, "step": 0.001},
    "probes": {"tip": {"at": "beam.end"}},
}



def rod(section="", modes=None, more=""):
    """A round rod in space, of three elements: its bending frequencies come in pairs. Text, with `more` at its end."""
    reduction = f", reduction: {{modes: {modes}}}" if modes else ""
    return ("bodies: {f: {mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 3}}, section: {shape: circle, radius: 0.01, "
            f"orientation: [0, 1, 0]{section}}}, material: {{E: 7e10, nu: 0.3, rho: 2700}}{reduction}}}}}\n{more}")


HELD_ROD = "joints: {root: {type: fixed, between: [ground, f.start]}}\n"


def scene(changes=None):
    """BASE with some entries replaced (`motion.end`: 1), added, or removed (None)."""
    tree = copy.deepcopy(BASE)
    for path, value in (changes or {}).items():
        *folders, name = path.split(".")
        place = tree
        for folder in folders:
            place = place.setdefault(folder, {})
        if value is None:
            place.pop(name)
        else:
            place[name] = copy.deepcopy(value)
    return json.dumps(tree, indent=1)


# Not a number within 2e-4 s of t = 0.021, between the times that reading a scene looks at.
GAP = "sqrt((t - 0.021)^2 - 4e-8)"

RIGID = {"bodies.link": {"mesh": {"line": {"from": [1, 0], "to": [2, 0], "elements": 1}},
                         "section": {"EA": 1, "EI": 1, "rhoA": 1}, "rigid": True},
         "joints.a": {"type": "fixed", "between": ["beam.end", "link.start"]}}

PLATE = """
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [60, 30]}}
    section: {thickness: 0.002}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 2}
joints: {root: {type: fixed, between: [ground, plate.left]}}
"""
