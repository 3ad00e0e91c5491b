#!/usr/bin/env python3
"""examples/controlled_arm and examples/rotor, on one rank and on two: what their pages say of torques, errors, root moments
and stresses.

controlled.py FLOE
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
FLOE = pathlib.Path(sys.argv[1]).resolve()


def floe(*words, ranks=1):
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*command, FLOE, *words], capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, f"{words} on {ranks} ranks:\n{done.stdout}{done.stderr}"
    return done.stdout


def columns(folder):
    assert json.loads((folder / "summary.json").read_text())["status"] == "finished"
    with open(folder / "probes.csv") as file:
        rows = list(csv.reader(file))
    numbers = numpy.array([[float(x) for x in row] for row in rows[1:]])
    return {name.split(" ")[0]: numbers[:, i] for i, name in enumerate(rows[0])}


def largest_stress(folder):
    """(body, stress, time) of each body from `floe stress`."""
    rows = [line.split() for line in floe("stress", folder).splitlines()]
    return [(row[0], float(row[2]), float(row[3])) for row in rows if len(row) > 3 and row[1] == "maximum"]


def moved(scene, folder, reactions=(), see=lambda out: None):
    """Columns of the probes by name, the same on two ranks: bases from two partitions of a mesh differ by the tolerance of
    the eigenvalue problem, which reactions of stiff bodies (small differences of positions) magnify."""
    both = []
    for ranks in (1, 2):
        out = folder / f"{ranks}"
        floe("run", scene, "--formulation", "vm+md", "--no-estimate", "-o", out, "-motion_snes_rtol", "1e-12", ranks=ranks)
        both.append(columns(out))
        see(out)
        shutil.rmtree(out)
    alone, two = both
    for column, values in alone.items():
        probe = column.rpartition(".")[0]
        size = max(numpy.abs(alone[other]).max() for other in alone if other.rpartition(".")[0] == probe)
        limit = 3e-5 if probe in reactions else 1e-6
        apart = numpy.abs(values - two[column]).max()
        assert apart <= limit * max(1, size), f"{scene}, {column}: {apart} apart on two ranks"
    return alone


def close(what, value, expected, share=0.01):
    assert abs(value - expected) <= share * abs(expected), f"{what}: {value}, the page says {expected}"


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        arm = moved(EXAMPLES / "controlled_arm" / "scene.yaml", folder)
        close("torque of the shoulder", arm["shoulder_torque.z"].max(), 67.9)
        close("torque of the elbow", arm["elbow_torque.z"].max(), 23.2)
        close("error of the shoulder", numpy.abs(arm["shoulder_error.value"]).max(), 0.00983)
        close("error of the elbow", numpy.abs(arm["elbow_error.value"]).max(), 0.01156)
        shutil.copytree(EXAMPLES / "rotor", folder / "rotor")
        (folder / "rotor" / "blade.inp").unlink(missing_ok=True)
        subprocess.run([sys.executable, folder / "rotor" / "mesh.py"], check=True)
        assert (folder / "rotor" / "blade.inp").read_text() == (EXAMPLES / "rotor" / "blade.inp").read_text()
        stresses = []
        rotor = moved(folder / "rotor" / "scene.yaml", folder, ("root", "root2", "root3", "torque"),
                      see=lambda out: stresses.append(largest_stress(out)))
        before = rotor[next(iter(rotor))] < 0.0995  # the gust
        assert numpy.ptp(rotor["root.y"][before]) < 0.02, "the flap moment swings before the gust"
        close("flap moment at the start", rotor["root.y"][0], -34.5)
        close("flap moment in the gust", rotor["root.y"].max(), 83.26)
        close("lift of the tip", rotor["tip.z"].max(), 0.2901)
        assert numpy.abs(rotor["v1.z"] - rotor["v2.z"]).max() < 1e-4, "blades differ"
        for ranks, found in enumerate(stresses, 1):
            assert [body for body, _, _ in found] == ["one", "two", "three"], found
            for body, stress, time in found:
                close(f"stress of blade {body} on {ranks} ranks", stress, 67.1e6)
                close(f"time of the stress of blade {body} on {ranks} ranks", time, 0.329)
    print("controlled_arm and rotor move as their pages say, on one rank and on two")


if __name__ == "__main__":
    main()
