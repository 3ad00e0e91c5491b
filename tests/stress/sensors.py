"""Probes of accelerations, drives, powers, coordinates of joints, energies, strains and layers, by closed forms: sensors.py FLOE."""
import json
import pathlib
import sys
import tempfile

import numpy as np

from fields import LAMINATE, STRIP, close, floe, table

FLOE = pathlib.Path(sys.argv[1]).resolve()

# A slender, stiff arm of length 2 and mass 3, turned about its end by 2 t^2 from rest, under gravity.
ARM = """
bodies:
  arm:
    mesh: {line: {from: [0, 0], to: [2, 0], elements: 4}}
    section: {A: 1e-3, I: 1e-6}
    material: {E: 2e13, rho: 1500}
    reduction: {modes: 2}
    damping: {stiffness: 1e-3}
joints: {root: {type: driven, between: [ground, arm.start], angle: "2*t^2"}}
gravity: [0, -9.81]
motion: {end: 0.5, step: 1e-3, every: 10}
probes:
  a: {at: arm.end, quantity: acceleration}
  own: {at: arm.end, quantity: acceleration, relative_to: arm.end}
  alpha: {at: arm.end, quantity: angular_acceleration}
  drive: {joint: root, quantity: drive}
  power: {joint: root, quantity: power}
  angle: {joint: root, quantity: angle}
  rate: {joint: root, quantity: rate}
  T: {body: arm, quantity: kinetic_energy}
"""

# The same in space, in the plane x, z turned about -y, so that it rises.
ARM_IN_SPACE = (ARM.replace("[0, 0], to: [2, 0]", "[0, 0, 0], to: [2, 0, 0]")
                .replace("{A: 1e-3, I: 1e-6}", "{A: 1e-3, Iy: 1e-6, Iz: 1e-6, J: 2e-6, orientation: [0, 1, 0]}")
                .replace("E: 2e13,", "E: 2e13, nu: 0.3,").replace("[0, -9.81]", "[0, 0, -9.81]")
                .replace("angle: \"2*t^2\"", "axis: [0, -1, 0], angle: \"2*t^2\""))


def an_arm_that_is_turned(folder):
    """a = alpha L across, -omega^2 L along; M = J alpha + m g L/2 cos; P = M omega; T = 1/2 J omega^2."""
    L, m, J = 2, 3, 3 * 2**2 / 3 + 1500 * 1e-6 * 2  # with the rotary inertia of the sections
    for scene, formulations in ((ARM, ("vm+md", "nlffr", "cfr")), (ARM_IN_SPACE, ("vm+md", "nlffr", "cfr"))):
        (folder / "scene.yaml").write_text(scene)
        for formulation in formulations:
            floe(FLOE, folder, "run", "scene.yaml", "--formulation", formulation, "-o", "out", "--force", "--no-estimate")
            found = {name: column[5:] for name, column in table(folder / "out/probes.csv").items()}  # the start vibrates
            t = found["t"]
            angle, omega, alpha = 2 * t**2, 4 * t, 4
            up = "y" if scene is ARM else "z"
            e, n = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
            expected = alpha * L * n - omega**2 * L * e
            what = f"{formulation} {'plane' if scene is ARM else 'space'}"
            close([found["a.x"], found[f"a.{up}"]], expected, 2e-3, f"{what}: acceleration")
            close([found["own.x"], found[f"own.{up}"]], [-omega**2 * L, alpha * L + 0 * t], 2e-3, f"{what}: accelerometer")
            close(found["alpha.z" if scene is ARM else "alpha.y"], (1 if scene is ARM else -1) * alpha + 0 * t, 2e-3, f"{what}: alpha")
            M = J * alpha + m * 9.81 * L / 2 * np.cos(angle)
            close(found["drive.value"], M, 2e-3, f"{what}: drive")
            close(found["power.value"], M * omega, 2e-3, f"{what}: power")
            close(found["angle.value"], angle, 1e-8, f"{what}: angle")
            close(found["rate.value"], omega, 1e-6, f"{what}: rate")
            close(found["T.value"], J * omega**2 / 2, 2e-3, f"{what}: kinetic energy")


SPRING = """
bodies:
  mass: {rigid: {mass: 2, centre: [1, 0], inertia: 0.1}}
joints:
  slide: {type: prismatic, between: [ground, {body: mass, node: [1, 0]}], axis: [1, 0]}
  spring: {type: spring, between: [{body: ground, node: [0, 0]}, {body: mass, node: [1, 0]}], stiffness: 50, length: 0.8}
motion: {end: 0.6, step: 1e-3, every: 10}
probes:
  travel: {joint: slide, quantity: travel}
  speed: {joint: slide, quantity: speed}
  length: {joint: spring, quantity: length}
  force: {joint: spring, quantity: drive}
  power: {joint: spring, quantity: power}
  ideal: {joint: slide, quantity: power}
  a: {at: {body: mass, node: [1, 0]}, quantity: acceleration}
"""


def a_mass_on_a_spring(folder):
    """x = 0.8 + 0.2 cos(5 t): drive -k (x - 0.8) along the spring, power the same times the speed."""
    (folder / "scene.yaml").write_text(SPRING)
    floe(FLOE, folder, "run", "scene.yaml", "-o", "out", "--force", "--no-estimate")
    found = table(folder / "out/probes.csv")
    t = found["t"]
    x, v = 0.2 * np.cos(5 * t), -np.sin(5 * t)
    close(found["length.value"], 0.8 + x, 1e-4, "length")
    close(found["travel.value"], x - 0.2, 1e-4, "travel")
    close(found["speed.value"], v, 1e-3, "speed")
    close(found["force.value"], -50 * x, 1e-3, "drive")
    close(found["power.value"], -50 * x * v, 2e-3, "power")
    close(found["a.x"], -25 * x, 1e-3, "acceleration")
    assert np.abs(found["ideal.value"]).max() < 1e-6 * np.abs(found["power.value"]).max()


def energies(folder):
    """Of a strip in bending and tension: F^2 L^3 / 6 EI + N^2 L / 2 EA; also of a body in several frames."""
    (folder / "scene.yaml").write_text(STRIP.replace("CELLS", "triangles").replace("force: [2, 0, 0.01]", "force: [0, 0, 0.01]")
                                       + "probes: {U: {body: strip, quantity: strain_energy}}\n")
    floe(FLOE, folder, "static", "scene.yaml", "--formulation", "nlffr", "-o", "out", "--force")
    EI = 7e10 * 0.05 * 2e-3**3 / 12
    close(table(folder / "out/probes.csv")["U.value"][-1:], [0.01**2 / (6 * EI)], 0.01, "strain energy")
    (folder / "scene.yaml").write_text("""
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 1e6, EI: 10, rhoA: 1}
    frames: 4
joints: {root: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, 0.3]}}
motion: {end: 1, step: 0.1}
probes: {U: {body: beam, quantity: strain_energy}}
""")
    for formulation in ("vm+md", "nlffr", "cfr"):
        floe(FLOE, folder, "static", "scene.yaml", "--formulation", formulation, "-o", "out", "--force", "--no-estimate")
        close(table(folder / "out/probes.csv")["U.value"][-1:], [0.3**2 / 60], 0.01, f"{formulation}: of four frames")


def strains_and_layers(folder):
    """A cross-ply laminate under pull, nu = 0: eps = N / sum E h in all layers, each with E eps."""
    eps = 100 / 0.1 / (2 * 1.4e11 * 1e-3 + 1e10 * 1e-3)
    (folder / "scene.yaml").write_text(LAMINATE + """probes:
  eps: {at: {body: strip, node: [0.5, 0.05, 0]}, quantity: strain, surface: top}
  outer: {at: {body: strip, node: [0.5, 0.05, 0]}, quantity: stress, layer: 1, surface: bottom}
  inner: {at: {body: strip, node: [0.5, 0.05, 0]}, quantity: stress, layer: 2}
  mises: {at: {body: strip, node: [0.5, 0.05, 0]}, quantity: von_mises_stress, layer: 3}
""")
    floe(FLOE, folder, "static", "scene.yaml", "-o", "out", "--force")
    found = {name: column[-1:] for name, column in table(folder / "out/probes.csv").items()}
    close(found["eps.xx"], [eps], 1e-3, "strain")
    close(found["outer.xx"], [1.4e11 * eps], 1e-3, "stress of layer 1")
    close(found["inner.xx"], [1e10 * eps], 1e-3, "stress of layer 2")
    close(found["mises.mises"], [1.4e11 * eps], 1e-3, "von Mises of layer 3")
    summary = json.loads((folder / "out/summary.json").read_text())
    assert summary["estimate"]["probes"]["outer"] < 1e-3, summary["estimate"]


def as_other_probes(folder):
    """They have estimates, and enter comparisons and sweeps."""
    scene = ARM.replace("E: 2e13", "E: 2e10")
    (folder / "scene.yaml").write_text(scene)
    floe(FLOE, folder, "run", "scene.yaml", "-o", "out", "--force")
    estimate = json.loads((folder / "out/summary.json").read_text())["estimate"]
    assert set(estimate["probes"]) == {"a", "own", "alpha", "drive", "power", "angle", "rate", "T"}, estimate
    assert all(value is not None and value < 0.3 for value in estimate["probes"].values()), estimate["probes"]
    floe(FLOE, folder, "compare", "scene.yaml", "--formulations", "nlffr,vm+md", "-o", "cmp", "--no-reference-error")
    text = (folder / "cmp/compare.csv").read_text()
    assert all(name in text for name in ("power", "drive", "alpha")), text
    floe(FLOE, folder, "sweep", "scene.yaml", "--vary", "bodies.arm.material.rho=1500,3000", "-o", "sweep")
    assert "power.value" in (folder / "sweep/sweep.csv").read_text().splitlines()[0]


def refusals(folder):
    for change, phrase in (
            (("{joint: root, quantity: power}", "{joint: root, quantity: acceleration}"), "does not apply to a joint"),
            (("{joint: root, quantity: power}", "{at: arm.end, quantity: power}"), "is exerted by joints, and does not apply to a place"),
            (("{body: arm, quantity: kinetic_energy}", "{body: leg, quantity: kinetic_energy}"), 'there is no body "leg"'),
            (("{body: arm, quantity: kinetic_energy}", "{at: arm.end, quantity: kinetic_energy}"), "is of a body, and does not apply to a place"),
            (("{body: arm, quantity: kinetic_energy}", "{body: arm, quantity: velocity}"), "does not apply to a body"),
            (("{joint: root, quantity: rate}", "{joint: root, quantity: travel}"), "root.travel"),
            (("{joint: root, quantity: rate}", "{at: arm.end, quantity: rate}"), "is of joints")):
        (folder / "scene.yaml").write_text(ARM.replace(*change))
        told = floe(FLOE, folder, "check", "scene.yaml", code=2)
        assert phrase in told and told.startswith("floe: scene.yaml:"), told
    for change, phrase in (("layer: 4", "is 4, but the section there has 3 layers; expected 1 to 3"),
                           ("surface: top", "whose stresses jump between layers; expected layer: N")):
        (folder / "scene.yaml").write_text(LAMINATE + "probes: {s: {at: {body: strip, node: [0.5, 0.05, 0]}, quantity: stress, %s}}\n" % change)
        told = floe(FLOE, folder, "static", "scene.yaml", "-o", "out", "--force", code=2)
        assert phrase in told, told


def main():
    for test in (an_arm_that_is_turned, a_mass_on_a_spring, energies, strains_and_layers, as_other_probes, refusals):
        if sys.argv[2:] and test.__name__ not in sys.argv[2:]:
            continue
        with tempfile.TemporaryDirectory() as name:
            test(pathlib.Path(name))
            print(f"passed: {test.__name__}", flush=True)


if __name__ == "__main__":
    main()
