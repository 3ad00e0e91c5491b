#!/usr/bin/env python3
"""The satellite of examples/satellite: the wings unfold about a centre of mass that stays, alike on one rank and on two.

satellite.py FLOE: in a folder of its own; 0 if all is as it should be.
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

FLOE = pathlib.Path(sys.argv[1]).resolve()
SCENE = pathlib.Path(__file__).resolve().parents[2] / "examples/satellite/scene.yaml"


def unfolded(folder, ranks):
    text = re.sub(r"elements: \[8, 6\]", "elements: [4, 2]", SCENE.read_text())
    text = text.replace("modes: 6, derivatives: 12", "modes: 3, derivatives: 2")
    (folder / "scene.yaml").write_text(re.sub(r"motion: .*", "motion: {end: 10, step: 2e-2}", text))
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(FLOE), "run", "scene.yaml", "-o", f"on{ranks}"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE)
    with open(folder / f"on{ranks}" / "probes.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return {name.split(" ")[0]: np.array(column, float) for name, column in zip(rows[0], zip(*rows[1:]))}


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        one, two = unfolded(folder, 1), unfolded(folder, 2)
        assert abs(one["tip.y"][0] - 0.5) < 1e-12 and abs(one["tip.z"][0] - 0.5) < 1e-12
        assert abs(one["tip.y"][-1] - 2.5) < 1e-3 and abs(one["tip.z"][-1] - 0.5) < 5e-3  # unfolded, and flat
        # Four panels of 5.12 kg: their centres rise by 0.5 m each (from z = 0 to 0.5), the bus of 200 kg sinks.
        assert abs(one["bus.z"][-1] + 4 * 5.12 * 0.5 / (200 + 4 * 5.12)) < 1e-4, one["bus.z"][-1]
        assert np.abs(one["bus.x"]).max() < 1e-4 and np.abs(one["bus.y"]).max() < 1e-9
        for column in ("tip.x", "tip.y", "tip.z", "bus.z"):
            assert np.abs(one[column] - two[column]).max() < 1e-9, column
        with h5py.File(folder / "on1/result.h5") as file:
            attitudes = file["motion/attitude"][()]
        assert attitudes.shape[1] == 5 * 4
        assert np.abs(np.linalg.norm(attitudes.reshape(len(attitudes), 5, 4), axis=2) - 1).max() < 1e-12
    return 0


if __name__ == "__main__":
    sys.exit(main())
