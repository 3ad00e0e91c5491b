"""Scenes in space at the borders of what joints, drives, springs and bases can do: what must be said, and what comes out."""
import csv
import json
import math

RIGID = ("{rigid: true, mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 2}}, "
         "section: {shape: circle, radius: 0.05, orientation: [0, 1, 0]}, material: {E: 1, nu: 0.3, rho: 100}%s}")
BEAM = ("{mesh: {line: {from: [0, 0, 0], to: [1, 0, 0], elements: 8}}, section: {shape: rectangle, width: 0.02, "
        "height: 0.02, orientation: [0, 1, 0]}, material: {E: 7e10, nu: 0.3, rho: 2700}%s}")
PLATE = ("{mesh: {plate: {along: [1, 0, 0], across: [0, 0.2, 0], elements: [6, 2]}}, section: {thickness: 5e-3}, "
         "material: {E: 7e10, nu: 0.3, rho: 2700}, reduction: {modes: 3, derivatives: none}}")


def body(text, *joints, more="", motion="{end: 0.02, step: 1e-3}", probes="{end: {at: a.end, quantity: position}}"):
    """A scene of one body `a`."""
    return (f"bodies: {{a: {text}}}\njoints: {{{', '.join(joints)}}}\n{more}"
            + (f"motion: {motion}\n" if motion else "") + (f"probes: {probes}\n" if probes else ""))


def hinge(angle):
    return f'd: {{type: driven, between: [ground, a.start], axis: [0, 0, 1], angle: "{angle}"}}'


def last(folder):
    """The last row of the probes by name."""
    rows = list(csv.reader((folder / "out/probes.csv").read_text().splitlines()))
    return {name.split(" ")[0]: float(value) for name, value in zip(rows[0], rows[-1])}


def turned(angle):
    """The end of the unit link stands at this angle."""
    def check(folder):
        row = last(folder)
        assert math.hypot(row["end.x"] - math.cos(angle), row["end.y"] - math.sin(angle)) < 1e-6, row
    return check


def near(column, expected, tolerance):
    def check(folder):
        row = last(folder)
        assert abs(row[column] - expected) <= tolerance, f"{row}, not {expected}"
    return check


def warns(*phrases):
    """Each phrase stands in exactly one warning of the summary."""
    def check(folder):
        warnings = json.loads((folder / "out/summary.json").read_text())["warnings"]
        for phrase in phrases:
            assert sum(phrase in text for text in warnings) == 1, f"{warnings} lack {phrase!r}"
    return check


def silent(folder):
    warnings = json.loads((folder / "out/summary.json").read_text())["warnings"]
    assert not any("its basis represents" in text for text in warnings), warnings


def bearings(*stiffness):
    rotor = RIGID.replace("to: [1, 0, 0]", "to: [0, 0, 1]") % ""
    joints = [f"{name}: {{type: bushing, between: [ground, a.{at}], translation: [{stiffness[0]}, {stiffness[1]}, 0]}}"
              for name, at in (("l", "start"), ("r", "end"))]
    return body(rotor, *joints, motion="", probes="")


LATE = '"t < 0.1 ? 0 : 0.01*(t - 0.1)^3"'
TWO_ARMS = f"""
bodies: {{arm: {RIGID % ""}, other: {RIGID % ""}}}
joints:
  one: {{type: driven, between: [ground, arm.start], axis: [0, 0, 1], angle: 0}}
  two: {{type: driven, between: [ground, other.start], axis: [0, 0, 1], angle: "t < 0.1 ? 0 : (t - 0.1)^3"}}
  weld: {{type: fixed, between: [arm.end, other.end]}}
motion: {{end: 1, step: 1e-2}}
"""
THREE_LINES = f"""
bodies: {{a: {PLATE}, b: {RIGID % ""}, c: {RIGID % ""}}}
joints:
  h: {{type: revolute, between: [{{body: b, node: [0, 0.1, 0]}}, a.left]}}
  i: {{type: revolute, between: [{{body: c, node: [0.5, 0, 0]}}, a.bottom]}}
  j: {{type: revolute, between: [{{body: b, node: [1, 0.1, 0]}}, a.right]}}
motion: {{end: 1e-3, step: 1e-3}}
"""
MEETING_LINES = f"""
bodies: {{a: {PLATE}, b: {RIGID % ""}}}
joints:
  h: {{type: revolute, between: [ground, a.left]}}
  i: {{type: revolute, between: [ground, a.bottom], edges: line}}
  j: {{type: revolute, between: [{{body: b, node: [1, 0.1, 0]}}, a.right]}}
motion: {{end: 1e-3, step: 1e-3}}
"""
CLAMP = "c: {type: fixed, between: [ground, a.start]}"
TWO_HINGES = ("h: {type: revolute, between: [ground, a.start], axis: [0, 0, 1]}",
              "i: {type: revolute, between: [ground, a.end], axis: [0, 0, 1]}")
MOVED = 'd: {type: driven_slide, between: [ground, a.end], axis: [0, 0, 1], position: "0.01*t"}'
TILTED = BEAM.replace("to: [1, 0, 0]", "to: [0, 1, 0]").replace("[0, 1, 0]}, material", "[1, 0, 0]}, material")
# sags by 5/384 rho g A L^4 / EI = 1.478e-4; stretching takes less than 1e-4 of it
SAGGING = "gravity: [0, 0, -9.81]\n" + body(BEAM % "", *(h.replace("0, 0, 1]", "0, 1, 0]") for h in TWO_HINGES), motion="",
                                           probes="{end: {at: a.middle}}")

# Its frame follows the fastest vibrations of its free end.
FLYING = body(BEAM.replace("elements: 8", "elements: 12").replace("0.02, orientation", "0.012, orientation") % (
    ", frame: clamped, initial: {rotation: [0.3, -0.5, 0.2], angular_velocity: [1.5, -2, 3], deformation: ["
    '"-0.5*(0.02*pi)^2*(x/2 + sin(2*pi*x)/(4*pi)) - 0.5*(0.03)^2*4*x^3/3", "0.02*sin(pi*x)", "0.03*x^2"]}'),
    motion="{end: 0.002, step: 5e-5}")

# Two shells that meet without common nodes; a movable straight edge across the seam.
SEAM = """bodies:
  plate: {mesh: {file: {path: seam.inp}}}
joints:
  a: {type: fixed, between: [ground, {body: plate, node: [0, 0, 0]}]}
  c: {type: support, between: [ground, plate.R], straight: [x]}
motion: {end: 1, step: 1e-2}
"""
SEAM_DECK = """*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 1, 1, 0
6, 1, 2, 0
7, 0, 2, 0
*ELEMENT, TYPE=S4, ELSET=E
1, 1, 2, 3, 4
2, 4, 5, 6, 7
*NSET, NSET=R
2, 3, 5, 6
*MATERIAL, NAME=M
*ELASTIC
1e9, 0.3
*DENSITY
1000
*SHELL SECTION, ELSET=E, MATERIAL=M
0.01
"""
