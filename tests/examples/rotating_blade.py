#!/usr/bin/env python3
"""examples/rotating_blade on a coarse mesh: its Campbell diagram and picture, the same on one rank and on two.

rotating_blade.py FLOE
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FLOE = sys.argv[1]
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "rotating_blade"


def floe(folder, *words, ranks=1):
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [FLOE, *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, (command, done.stdout, done.stderr)
    return done.stdout


def frequencies(folder):
    """[Hz] of each speed, as campbell.csv and summary.json have them."""
    with open(folder / "campbell.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    table = {}
    for row in rows:
        assert row["remark"] == "", row
        table.setdefault(float(row["speed [rad/s]"]), []).append(float(row["frequency [Hz]"]))
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["status"] == "finished" and summary["axis"]["about"] == [0, 0, 1]
    assert {at["rad_per_s"]: [v["Hz"] for v in at["vibrations"]] for at in summary["speeds"]} == table
    return table


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        text = (EXAMPLE / "scene.yaml").read_text()
        (folder / "scene.yaml").write_text(text.replace("[24, 4]", "[8, 2]").replace("modes: 10", "modes: 4"))
        shown = floe(folder, "campbell", "scene.yaml", "--speeds", "0:300:150", "--modes", "3", "-o", "one")
        assert "about (0, 0, 1) through (0, 0, 0)" in shown, shown
        floe(folder, "campbell", "scene.yaml", "--speeds", "0:300:150", "--modes", "3", "-o", "two", ranks=2)
        one, two = frequencies(folder / "one"), frequencies(folder / "two")
        assert list(one) == [0, 150, 300] and one.keys() == two.keys()
        for speed in one:
            assert all(abs(a / b - 1) < 1e-8 for a, b in zip(one[speed], two[speed])), (one, two)
        at_rest = [float(hertz) for hertz in re.findall(r"^blade +\d+ +(\S+)", floe(folder, "modes", "scene.yaml"), re.M)]
        assert all(abs(a / b - 1) < 1e-5 for a, b in zip(one[0], at_rest)), (one, at_rest)
        # the centrifugal force stiffens flap
        assert one[300][0] > one[150][0] > one[0][0]
        floe(folder, "plot", "one", "-o", "picture.png")
        assert (folder / "picture.png").stat().st_size > 5000
        bad = subprocess.run([FLOE, "campbell", "scene.yaml", "--speeds", "0:1", "-o", "bad"], cwd=folder,
                             capture_output=True, text=True)
        assert bad.returncode == 2 and bad.stderr.count("\n") == 1 and "FROM:TO:STEP" in bad.stderr, bad.stderr
        assert not (folder / "bad").exists()


if __name__ == "__main__":
    main()
