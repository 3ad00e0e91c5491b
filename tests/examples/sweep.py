#!/usr/bin/env python3
"""floe sweep on one rank and on two: the same members to the last bit, what single runs give, and a member that fails; on two and three
ranks with two for a member: the same to solver tolerance."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

SCENE = """
parameters: {F: 1, L: 1}
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [L, 0], elements: 4}}
    section: {EA: 500, EI: 0.5, rhoA: 1, rhoI: 1e-4}
    reduction: {modes: 2, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "F*sin(7*t)"]}}
motion: {end: 0.3, step: 1e-2, spectral_radius: 0.8}
probes: {tip: {at: beam.end}}
"""


def run(floe, ranks, folder, *words):
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(floe), *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=200)


def table(folder):
    with open(folder / "sweep.csv") as file:
        return list(csv.reader(file))


def members_saved(floe, folder, out, *words, **streams):
    """Starts a sweep; the process, once it has saved members, and how many."""
    began = time.monotonic()
    process = subprocess.Popen([str(floe), "sweep", *words, "-o", out], cwd=folder, stdout=subprocess.DEVNULL, text=True, **streams)
    summary, done = folder / out / "summary.json", 0
    while process.poll() is None and done == 0:
        time.sleep(0.05)
        done = json.loads(summary.read_text())["done"] if summary.exists() else 0
        assert time.monotonic() - began < 100, "nothing is saved in 100 s"
    return process, done


def killed(floe, folder):
    """A sweep that is killed keeps the members that were done about a second before."""
    (folder / "long.yaml").write_text(SCENE.replace("end: 0.3, step: 1e-2", "end: 0.3, step: 1.5e-6"))  # a second each
    process, done = members_saved(floe, folder, "killed", "long.yaml", "--vary", "F=0.01:0.4:0.01", stderr=subprocess.DEVNULL)
    process.kill()
    process.wait()
    assert 0 < done < 40, f"{done} members were saved on the way"
    assert json.loads((folder / "killed/summary.json").read_text())["status"] == "running"
    rows = table(folder / "killed")
    assert len(rows) > done and all(abs(float(row[1]) - 0.01 * m) < 1e-9 for m, row in enumerate(rows[1:], 1)), rows


def interrupted(floe, folder):
    """A signal ends a sweep after the member under way, also while a body is reduced, which takes the most time here."""
    (folder / "offline.yaml").write_text(SCENE.replace("elements: 4", "elements: 1500").replace("modes: 2", "modes: 12")
                                         .replace("end: 0.3", "end: 0.02"))
    process, _ = members_saved(floe, folder, "interrupted", "offline.yaml", "--vary", "L=1:2:0.02", stderr=subprocess.PIPE)
    process.terminate()
    text = process.communicate(timeout=60)[1]
    assert process.returncode == 1 and "interrupted by signal 15" in text, (process.returncode, text)
    assert "not simulated: the sweep was interrupted" in text, text
    assert json.loads((folder / "interrupted/summary.json").read_text())["status"] == "failed"


def main():
    floe = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.yaml").write_text(SCENE)
        # every other member has a spectral radius of 1, which is refused
        words = ["sweep", "scene.yaml", "--vary", "F=0.5:1.5:0.5", "--vary", "motion.spectral_radius=0.8,1"]
        for ranks in (1, 2):
            done = run(floe, ranks, folder, *words, "-o", f"out{ranks}")
            assert done.returncode == 1, done.stderr
            assert done.stderr.count("failed: ") == 3 and "3 of 6 members failed" in done.stderr, done.stderr
            assert "reductions of bodies" in done.stdout
        one, two = table(folder / "out1"), table(folder / "out2")
        assert one == two and len(one) == 7, "sweep.csv differs between ranks"
        with h5py.File(folder / "out1/sweep.h5") as a, h5py.File(folder / "out2/sweep.h5") as b:
            members, probes = a["members"][:], a["probes"][:]
            assert numpy.array_equal(members, b["members"][:], equal_nan=True)
            assert numpy.array_equal(probes, b["probes"][:])
            columns = json.loads(a["columns"][()])
            assert len(columns["members"]) == members.shape[1] and len(columns["probes"]) == probes.shape[1]
        for ranks in (2, 3):
            done = run(floe, ranks, folder, *words, "--ranks-per-member", "2", "-o", f"groups{ranks}")
            assert done.returncode == 1 and done.stderr.count("failed: ") == 3 and "3 of 6 members failed" in done.stderr, done.stderr
            assert "; 1 reductions of bodies" in done.stdout, done.stdout  # of three ranks the last has the members that fail
            with h5py.File(folder / f"groups{ranks}/sweep.h5") as a:
                assert numpy.allclose(a["probes"][:], probes, rtol=1e-8, atol=1e-12)
                assert numpy.array_equal(a["members"][:, 0], members[:, 0])
        done = run(floe, 2, folder, *words, "--ranks-per-member", "3", "-o", "none")
        assert done.returncode == 2 and "--ranks-per-member: is 3; expected 1 to 2" in done.stderr, done.stderr
        assert not (folder / "none").exists()
        failed = columns["members"].index("failed")
        assert list(members[:, failed]) == [0, 1, 0, 1, 0, 1]
        summary = json.loads((folder / "out1/summary.json").read_text())
        assert summary["status"] == "failed" and [f["member"] for f in summary["failures"]] == [2, 4, 6]
        # the third row is the scene itself, as floe run moves it
        assert run(floe, 1, folder, "run", "scene.yaml", "-o", "single").returncode == 0
        single = numpy.loadtxt(folder / "single/probes.csv", delimiter=",", skiprows=1)
        assert numpy.array_equal(probes[probes[:, 0] == 3][:, 1:], single)
        greatest = columns["members"].index("greatest tip.y [m]")
        assert members[2, greatest] == numpy.abs(single[:, 2]).max()
        # a length that changes the body, and a load that does not
        done = run(floe, 1, folder, "sweep", "scene.yaml", "--vary", "L=1,1.1", "--vary", "F=1,2", "-o", "lengths")
        assert done.returncode == 0 and "2 reductions of bodies" in done.stdout, done.stdout + done.stderr
        # an estimate needs the factors of the reduction: each member has its own, beside that of the columns
        done = run(floe, 1, folder, "sweep", "scene.yaml", "--vary", "F=1,2,3", "--estimate", "-o", "estimated")
        assert done.returncode == 0 and "4 reductions of bodies" in done.stdout, done.stdout + done.stderr
        done = run(floe, 1, folder, "sweep", "scene.yaml", "--vary", "L=1,1.1", "--vary", "F=1,2", "--together", "-o", "pairs")
        assert done.returncode == 0 and len(table(folder / "pairs")) == 3, done.stdout + done.stderr
        # what floe run would note of a member is reported once, with the first that has it and how many more
        notes = []
        for ranks in (1, 2):
            done = run(floe, ranks, folder, "sweep", "scene.yaml", "--vary", "F=0.01,3,10,11", "-o", f"warned{ranks}")
            told = [line for line in done.stdout.splitlines() if line.startswith("Note: ")]
            assert done.returncode == 0 and len(told) == 1, done.stdout + done.stderr
            assert "body beam: slopes of up to " in told[0] and "(member " in told[0] and "F = " in told[0], told
            notes.append((told, json.loads((folder / f"warned{ranks}/summary.json").read_text())["warnings"]))
        assert notes[0] == notes[1], "warnings differ between ranks"
        warning = notes[0][1][0]
        assert len(notes[0][1]) == 1 and 1 not in warning["members"] and len(warning["members"]) >= 2, warning
        assert warning["first"]["F"] == [0.01, 3, 10, 11][warning["members"][0] - 1]
        (folder / "one.yaml").write_text(SCENE.replace("F: 1,", f"F: {warning['first']['F']},"))
        assert run(floe, 1, folder, "run", "one.yaml", "--no-estimate", "-o", "one").returncode == 0
        assert warning["text"] in json.loads((folder / "one/summary.json").read_text())["warnings"]
        killed(floe, folder)
        interrupted(floe, folder)
    print("sweeps agree")


if __name__ == "__main__":
    main()
