"""Reading what `floe stress` writes, and the scenes of its tests."""
import csv
import pathlib
import subprocess

import h5py
import numpy as np


def floe(program, folder, *words, code=0, ranks=1):
    start = ["mpirun", "-n", str(ranks), "--oversubscribe"] if ranks > 1 else []
    done = subprocess.run([*start, str(program), *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    return done.stdout if code == 0 else done.stderr


def close(found, expected, tolerance, what):
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    size = np.abs(expected).max()
    error = np.abs(found - expected).max() / size
    assert error <= tolerance, f"{what}: off by {error:.3g} of the greatest number, allowed {tolerance:.3g}\n{found}\n{expected}"


class Fields:
    """The elements of a body: undeformed middles, and the fields of its last frame or of the whole motion."""

    def __init__(self, path, body, frame=None):
        with h5py.File(path, "r") as file:
            group = file[body]
            frames = sorted((name for name in group if name.startswith("frame_")), key=lambda name: int(name[6:]))
            at = group[frame or frames[-1]]
            places = at["positions"][()] - at["deformation"][()]
            cells, middles, i = group["cells"][()], [], 0
            while i < len(cells):
                count = {1: 1, 2: 2, 4: 3, 5: 4}[int(cells[i])]
                i += 2 if count <= 2 else 1
                middles.append(places[cells[i:i + count]].mean(0))
                i += count
            self.x = np.array(middles)
            self.of = {name: at[name][()] for name in at if name not in ("positions", "deformation")}
            self.of.update({name: group[name][()] for name in group if not name.startswith(("frame_", "cells"))})

    def __getitem__(self, name):
        return self.of[name]


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name.split(" [")[0]: column for name, column in zip(rows[0], np.array(rows[1:], float).T)}


def recovered(program, folder, scene, *words, command="static", formulation="vm+md", ranks=1, more=()):
    """Runs a scene and recovers its stresses."""
    (pathlib.Path(folder) / "scene.yaml").write_text(scene)
    floe(program, folder, command, "scene.yaml", "--formulation", formulation, "-o", "out", "--force", *more)
    said = floe(program, folder, "stress", "out", "--force", *words, ranks=ranks)
    return pathlib.Path(folder) / "out/stress.h5", said


STRIP = """
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.05, 0], elements: [40, 2], cells: CELLS}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0, rho: 2700}
    reduction: {modes: 4, attachment: all}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads:
  tip: {type: force, at: strip.right, force: [2, 0, 0.01]}
motion: {end: 1, step: 0.1}
"""

CLAMPED = """
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [24, 24], cells: quadrilaterals}}
    section: {thickness: 0.01}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 6, attachment: all}
joints:
  a: {type: fixed, between: [ground, plate.left]}
  b: {type: fixed, between: [ground, plate.right]}
  c: {type: fixed, between: [ground, plate.bottom]}
  d: {type: fixed, between: [ground, plate.top]}
loads: {p: {type: pressure, body: plate, pressure: 10}}
motion: {end: 1, step: 0.1}
"""

LAMINATE = """
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.1, 0], elements: [20, 2]}}
    section: {plies: [[1e-3, 0], [1e-3, 90], [1e-3, 0]], axis: [1, 0, 0]}
    material: {E1: 1.4e11, E2: 1e10, nu12: 0, G12: 5e9, rho: 1600}
    reduction: {modes: 4, attachment: all}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {pull: {type: force, at: strip.right, force: [100, 0, 0]}}
motion: {end: 1, step: 0.1}
"""

PLANAR = """
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 10}}
    section: {A: 8e-4, I: 1.0666666666666667e-7, fibre: 0.02}
    material: {E: 2e11, rho: 7800}
    reduction: {modes: 4, attachment: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [500, -3]}}
motion: {end: 1, step: 0.1}
"""

SPATIAL = """
bodies:
  beam:
    mesh: {line: {from: [0, 0, 0], to: [0, 1.5, 0], elements: 12}}
    section: {shape: rectangle, width: 0.03, height: 0.05, orientation: [1, 0, 0]}
    material: {E: 2e11, nu: 0.3, rho: 7800}
    reduction: {modes: 6, attachment: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [2, 100, -3]}}
motion: {end: 1, step: 0.1}
"""

# A strip bent by a moment into a part of a circle of 60 degrees.
ROLLED = """
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.05, 0], elements: [24, 2], cells: quadrilaterals}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0, rho: 2700}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {end: {type: moment, at: strip.right, moment: [0, "-t*MOMENT", 0]}}
motion: {end: 1, step: 0.1}
"""

SHAKEN = """
bodies:
  plate:
    mesh: {plate: {along: [0.4, 0, 0], across: [0, 0.3, 0], elements: [16, 12], cells: quadrilaterals}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
    damping: {stiffness: 2e-5}
joints:
  a: {type: fixed, between: [ground, plate.left]}
  b: {type: fixed, between: [ground, plate.right]}
loads: {p: {type: pressure, body: plate, pressure: "400*smooth(t, 0, 0.01)"}}
motion: {end: 0.03, step: 2e-4}
"""
