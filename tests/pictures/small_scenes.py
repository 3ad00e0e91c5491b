"""Small scenes for the tests of pictures, and running floe on them."""
import csv
import pathlib
import re
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src/plot"))

# In the plane: a crank that is rigid, a rod that bends, pinned; a probe at its end and at its middle.
CRANK = """
title: Crank & <rod>
parameters: {L: 0.3}
bodies:
  crank: {rigid: true, mesh: {line: {from: [0, 0], to: [0.15, 0], elements: 1}}, section: {A: 3e-5, I: 7e-11},
          material: {E: 2e11, rho: 7870}, initial: {angular_velocity: 150}}
  rod:
    mesh: {line: {from: [0, 0], to: [L, 0], elements: 6}}
    section: {A: 3e-5, I: 7e-11}
    material: {E: 2e11, rho: 7870}
    frame: pinned
    reduction: {modes: 2, derivatives: all}
    initial: {position: [0.15, 0], velocity: [0, 22.5], angular_velocity: -75}
joints:
  motor: {type: driven, between: [ground, crank.start], angle: 150*t}
  pin: {type: revolute, between: [crank.end, rod.start]}
motion: {end: 0.01, step: 1e-4}
probes:
  end: {at: rod.end, quantity: position}
  middle: {at: rod.middle, quantity: position}
  bend: {at: rod.middle, quantity: deflection}
"""

# In the plane: a shallow truss that snaps through at t = 9.53 and -9.53.
TRUSS = """
bodies:
  a: {mesh: {line: {from: [-1, 0], to: [0, 0.3], elements: 2}}, section: {EA: 1e3, EI: 10, rhoA: 1}}
  b: {mesh: {line: {from: [0, 0.3], to: [1, 0], elements: 2}}, section: {EA: 1e3, EI: 10, rhoA: 1}}
joints:
  left: {type: revolute, between: [ground, a.start]}
  apex: {type: revolute, between: [a.end, b.start]}
  right: {type: revolute, between: [ground, b.end]}
loads: {push: {type: force, at: a.end, force: [0, -t]}}
probes: {apex: {at: a.end}}
"""

# In the plane, for all formulations: a cantilever that bends far.
BEAM = """
title: Cantilever
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [100, 0], elements: 8}}
    section: {A: 70, I: 585}
    material: {E: 16000, rho: 0.0078}
    frame: {type: pinned, from: start, to: end}
    reduction: {modes: {count: 4, of: joints}, derivatives: [[1, 1], [1, 2]]}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "2500*sin(9.5*t)"]}}
motion: {end: 0.3, step: 2e-3}
probes: {tip: {at: beam.end, quantity: position}}
"""

# In space: a rigid hub that floats and turns, a panel of shells on a hinge, a boom that the hub holds (its frame is the hub's).
PANEL = """
title: Panel and boom
bodies:
  hub: {rigid: true, mesh: {line: {from: [-0.2, 0, 0], to: [0.2, 0, 0], elements: 2}},
        section: {shape: rectangle, width: 0.3, height: 0.3, orientation: [0, 1, 0]}, material: {E: 7e10, nu: 0.3, rho: 500},
        initial: {rotation: [0, 0.3, 0], angular_velocity: [0, 0, 2]}}
  boom:
    mesh: {line: {from: [0.2, 0, 0], to: [1.4, 0, 0], elements: 5}}
    section: {shape: circle, radius: 0.005, orientation: [0, 1, 0]}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
    initial: {rotation: [0, 0.3, 0], angular_velocity: [0, 0, 2]}
  panel:
    mesh: {plate: {along: [0.8, 0, 0], across: [0, 0.5, 0], elements: [4, 3]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
    initial: {position: [-0.4, 0.15, 0.1], velocity: [-0.3, -0.8, 0], angular_velocity: [0, 0, 2]}
joints:
  root: {type: fixed, between: [hub.end, boom.start]}
  hinge: {type: spherical, between: [{body: hub, node: [-0.1*sin(0.3), 0.15, 0.1*cos(0.3)]}, {body: panel, node: [0.4, 0, 0]}]}
motion: {end: 0.2, step: 2e-3}
probes:
  tip: {at: boom.end, quantity: position}
  corner: {at: panel.p3, quantity: position}
"""

PLATE = """
title: Plate under pressure
bodies:
  plate:
    mesh: {plate: {along: [0.4, 0, 0], across: [0, 0.2, 0], elements: [6, 3]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {gust: {type: pressure, body: plate, pressure: "2000*sin(60*t)"}}
motion: {end: 0.05, step: 1e-3}
probes: {corner: {at: plate.p3, quantity: position}}
"""


def floe(program, folder, *words, ranks=1, code=0):
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(program), *map(str, words)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, (command, done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


def write(folder, name, text, **changes):
    for before, after in changes.items():
        assert before in text
        text = text.replace(before, after)
    (folder / name).write_text(text)


def probes(folder):
    """Times, and each probe's places (instants x 2 or 3)."""
    with open(folder / "probes.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    numbers = np.array(rows[1:], float)
    places = {}
    for i, cell in enumerate(rows[0][1:], start=1):
        match = re.fullmatch(r"(.*)\.[xyz] \[m\]", cell)
        if match:
            places.setdefault(match.group(1), []).append(numbers[:, i])
    return numbers[:, 0], {name: np.array(columns).T for name, columns in places.items()}
