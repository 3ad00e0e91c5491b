#!/usr/bin/env python3
"""examples/spin_up and examples/slider_crank, on one rank and on two: the same motion, what their pages say of it, and
the estimated error of slider_crank's step against a quarter of the step."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def moved(floe, scene, ranks, out):
    """Times and columns of the probes by name."""
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*command, floe, "run", scene, "--formulation", "vm+md", "-o", out],
                          capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, f"{scene} on {ranks} ranks:\n{done.stdout}{done.stderr}"
    assert json.loads((out / "summary.json").read_text())["status"] == "finished"
    with open(out / "probes.csv") as file:
        rows = list(csv.reader(file))
    numbers = numpy.array([[float(x) for x in row] for row in rows[1:]])
    return {name.split(" ")[0]: numbers[:, i] for i, name in enumerate(rows[0])}


def check_step(floe, moved_before, out, folder):
    """The error of the step, estimated by half the step, and by a quarter of it (15/16 of the error)."""
    text = (EXAMPLES / "slider_crank/scene.yaml").read_text()
    fine = folder / "fine.yaml"
    fine.write_text(text.replace("step: 1e-5, every: 10", "step: 2.5e-6, every: 40"))
    better = moved(floe, fine, 1, folder / "fine")
    squares = lambda motion: sum((motion[column] ** 2).sum() for column in ("middle.x", "middle.y"))
    error = (squares({key: moved_before[key] - better[key] for key in better}) / squares(better)) ** 0.5
    estimated = json.loads((out / "summary.json").read_text())["estimate"]["step"]["probes"]["middle"]
    assert 2e-3 < error < 5e-3, f"slider_crank: the step's error is {error}"
    assert 0.8 < estimated / error < 1.25, f"slider_crank: the step's error is {error}, estimated {estimated}"


def main():
    floe = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for example in ("spin_up", "slider_crank"):
            alone, two = (moved(floe, EXAMPLES / example / "scene.yaml", ranks, folder / f"{example}.{ranks}")
                          for ranks in (1, 2))
            assert alone.keys() == two.keys()
            for column, values in alone.items():
                apart = numpy.abs(values - two[column]).max()
                assert apart <= 1e-6 * numpy.abs(values).max(), f"{example}, {column}: {apart} apart on two ranks"
            if example == "spin_up":  # independent computation: -0.7589, and at rest on its hub in the end
                least, last = alone["tip.y"].min(), abs(alone["tip.y"][-1])
                assert abs(least + 0.7589) < 2e-3 and last < 0.05, f"spin_up: tip.y at least {least}, {last} at the end"
            else:  # at full order 4.620 mm
                most = numpy.abs(alone["middle.y"]).max()
                assert abs(most - 4.620e-3) < 1e-5, f"slider_crank: the rod's middle bends by {most} m"
                check_step(floe, alone, folder / "slider_crank.1", folder)
    print("planar examples: spin_up and slider_crank move as their pages say, on one rank and on two")


if __name__ == "__main__":
    main()
