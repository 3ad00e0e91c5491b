#!/usr/bin/env python3
"""A run that is killed (SIGKILL) at random points and taken up again is the run that nothing interrupted, bit for bit.

restart.py FLOE RANKS [NAME...]: each scene runs once without checkpoints; then with them, killed some checkpoints on
after a random wait, taken up again, killed again, and taken up to its end. probes.csv must have the same bytes, and the
datasets of result.h5 the same numbers.
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

TIME_LIMIT = 300  # s

BEAM = """
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 6}}
    section: {EA: 500, EI: 0.5, rhoA: 1, rhoI: 1e-4}
    reduction: {modes: 3, derivatives: all}
    damping: {stiffness: 1e-3}
joints: {hinge: {type: revolute, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "3*sin(7*t)"]}}
gravity: [0, -9.81]
probes: {tip: {at: beam.end}}
"""
EVENTS = """
events:
  hold: {lock: hinge, at: 0.41}
  free: {unlock: hinge, when: "0.8003 - t"}
"""
SPACE = """
bodies:
  hub:
    rigid: true
    mesh: {line: {from: [0, 0, 0], to: [0.3, 0, 0], elements: 2}}
    section: {A: 0.02, Iy: 1e-4, Iz: 1e-4, J: 2e-4, orientation: [0, 0, 1]}
    material: {E: 1e9, nu: 0.3, rho: 500}
    initial: {angular_velocity: [0, 0, 9]}
  arm:
    mesh: {line: {from: [0.3, 0, 0], to: [1.3, 0, 0], elements: 6}}
    section: {A: 0.002, Iy: 1e-6, Iz: 2e-6, J: 3e-6, orientation: [0, 0, 1]}
    material: {E: 1e8, nu: 0.3, rho: 1000}
    damping: {stiffness: 1e-3}
    reduction: {modes: 3, derivatives: all}
    initial: {angular_velocity: [0, 0, 9]}
joints:
  pivot: {type: revolute, between: [ground, hub.start], axis: [0, 0, 1]}
  wind: {type: spring, between: [ground, hub.start], axis: [0, 0, 1], torsional_stiffness: 0.1}
  knee: {type: revolute, between: [hub.end, arm.start], axis: [0, 1, 0]}
events:
  hold: {lock: knee, at: 0.3}
  free: {unlock: knee, at: 0.6}
gravity: [0, 0, -9.81]
probes: {tip: {at: arm.end}}
"""
# friction, a controller beyond pi, a formula of sensors and a section: what they carry from step to step
SENSORS = (SPACE.replace("pivot: {type: revolute", "pivot: {friction: {level: 0.3, speed: 0.01}, type: revolute")
           .replace("probes: {tip: {at: arm.end}}", """loads: {motor: {type: moment, joint: pivot, moment: "2*(9*t - pivot.angle) - 0.1*pivot.rate"}}
probes:
  tip: {at: arm.end}
  lag: {formula: "pivot.angle - 9*t", unit: rad}
  root: {at: arm.middle, quantity: section_moment}"""))
# the hinge swings against a limit and off it again
STOPS = (BEAM.replace("beam.start]}", "beam.start], limits: {lower: -0.5, stiffness: 500, damping: 0.1, width: 0.01}}")
         + "events: {never: {stop: true, when: \"t + 1\"}}\n")
FIXED, ADAPTIVE = "motion: {end: 1.2, step: 1e-3}", "motion: {end: 1.2, step: 1e-3, tolerance: 1e-5}"
# a drive whose speed jumps and a load that jumps, on the steps' instants and between them
KINKS = (BEAM.replace("type: revolute", 'type: driven, angle: "0.5*ramp(t, 0.2, 0.73123)"').replace("3*sin(7*t)", "2*pulse(t, 0.33337, 0.6)"))
CASES = {
    "plane, kinks": (KINKS + FIXED, "vm+md"),
    "plane, kinks, adaptive": (KINKS + ADAPTIVE, "vm+md"),
    "plane, reduced": (BEAM + EVENTS + FIXED, "vm+md"),
    "plane, reduced, adaptive": (BEAM + EVENTS + ADAPTIVE, "vm+md"),
    "plane, full order": (BEAM + EVENTS + FIXED, "nlffr"),
    "space, reduced": (SPACE + FIXED, "vm+md"),
    "space, reduced, adaptive": (SPACE + ADAPTIVE, "vm+md"),
    "space, friction and sensors": (SENSORS + FIXED, "vm+md"),
    "plane, stops": (STOPS + FIXED, "vm+md"),
    "plane, stops, adaptive": (STOPS + ADAPTIVE, "vm+md"),
    "space, full order": (SPACE.replace("0.6", "0.35") + "motion: {end: 0.4, step: 1e-3}", "nlffr"),
}


def start(floe, ranks, folder, words):
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(floe), "run", *words]
    log = open(folder / "log", "ab")
    return subprocess.Popen(command, cwd=folder, stdout=log, stderr=log)


def end(process, folder):
    code = process.wait(TIME_LIMIT)
    assert code == 0, f"exit code {code}\n" + (folder / "log").read_text()[-2000:]


def kill(process, ranks, folder, checkpoints, chance):
    """SIGKILL to one rank, so many checkpoints on and a little later. Returns whether the run was still there."""
    file, seen, changes, until = folder / "out/checkpoint.h5", None, 0, time.monotonic() + TIME_LIMIT
    seen = file.stat().st_ino if file.exists() else None
    while changes < checkpoints and process.poll() is None:
        assert time.monotonic() < until, "no checkpoint comes"
        number = file.stat().st_ino if file.exists() else None
        changes += number != seen
        seen = number
        time.sleep(1e-3)
    time.sleep(chance.uniform(0, 0.03))
    if process.poll() is not None:
        return False
    target = process.pid
    if ranks > 1:
        children = pathlib.Path(f"/proc/{target}/task/{target}/children").read_text().split()
        if not children:
            return False
        target = int(chance.choice(children))
    try:
        os.kill(target, signal.SIGKILL)
    except ProcessLookupError:
        return False
    process.wait(TIME_LIMIT)
    return True


def rows_of(folder):
    return numpy.loadtxt(folder / "probes.csv", delimiter=",", skiprows=1)


def compare(whole, pieces, repeats):
    """repeats: whether the run gives the same bits whenever it is run."""
    if repeats:
        assert (whole / "probes.csv").read_bytes() == (pieces / "probes.csv").read_bytes(), "probes.csv differs"
    else:
        a, b = rows_of(whole), rows_of(pieces)
        assert a.shape == b.shape and numpy.abs(a - b).max() <= 1e-7 * numpy.abs(a).max(), "probes.csv differs"
    a, b = (json.loads((one / "summary.json").read_text()) for one in (whole, pieces))
    for key in ("status", "formulation", "label", "unknowns", "motion"):
        assert a[key] == b[key], f"summary.json: {key} is {b[key]}, not {a[key]}"
    assert [e["what"] for e in a["events"]] == [e["what"] for e in b["events"]], "summary.json: other events"
    if repeats:
        assert a["events"] == b["events"], "summary.json: other events"
    with h5py.File(whole / "result.h5") as a, h5py.File(pieces / "result.h5") as b:
        names = []
        a.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in names:
            if name == "summary" or any(part.startswith("estimate") for part in name.split("/")):  # after a restart no error is estimated
                continue
            x, y = a[name][()], b[name][()]
            if isinstance(x, bytes):
                assert x == y, f"{name} differs"
                continue
            assert x.shape == y.shape, f"{name} has shape {y.shape}, not {x.shape}"
            # violations are round-off of lengths of 1 m and speeds of some m/s, the others have sizes of their own
            size = 0.1 if name == "motion/constraints" else numpy.abs(x).max() if x.dtype.kind == "f" and x.size else 0
            near = x.dtype.kind == "f" and x.size and not repeats and numpy.abs(x - y).max() <= 1e-7 * size
            assert near or numpy.array_equal(x, y), f"{name} differs by {numpy.abs(x - y).max()}"
    drafts = [path.name for path in pieces.glob(".*")]
    assert not drafts, f"drafts are left: {', '.join(drafts)}"


def attempt(floe, ranks, text, formulation, chance, folder):
    (folder / "scene.yaml").write_text(text)
    end(start(floe, ranks, folder, ["scene.yaml", "--formulation", formulation, "-o", "whole"]), folder)
    words = fresh = ["scene.yaml", "--formulation", formulation, "-o", "out", "--checkpoint", "20"]
    kills = 0
    for most in (12, 12, 4, 1, 1):  # a run that came to its end before it was killed proves nothing: sooner
        if kills >= 2 or (kills and most < 12):
            break
        kills += kill(start(floe, ranks, folder, words), ranks, folder, chance.randint(1, most), chance)
        if (folder / "out/checkpoint.h5").exists():
            words = ["--restart", "out"]
        if not kills and "--restart" in words:
            shutil.rmtree(folder / "out")
            words = fresh
    assert kills, "never killed: it always came to its end before"
    end(start(floe, ranks, folder, words if "--restart" in words else words + ["--force"]), folder)
    # MUMPS does not repeat itself to the last bit on several ranks: two whole runs differ by
    # 1e-15 at first, and by 1e-8 when Newton has taken one iteration more in one of them
    compare(folder / "whole", folder / "out", ranks == 1 or formulation != "nlffr")
    return kills


def refuse(floe, ranks, folder, words, code, phrase, prefix=()):
    """A run that must end with this code and say so, and leave the checkpoint as it is."""
    before = (folder / "out/checkpoint.h5").read_bytes()
    command = [*prefix, *(["mpirun", "-n", str(ranks)] if ranks > 1 else []), str(floe), "run", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIME_LIMIT)
    assert done.returncode == code, f"exit code {done.returncode}, not {code}: {done.stderr}"
    assert phrase in done.stderr, f"stderr lacks {phrase!r}: {done.stderr}"
    assert (folder / "out/checkpoint.h5").read_bytes() == before, "the checkpoint was changed"


def refusals(floe, ranks, chance, folder):
    """Another scene, formulation, options, ranks; a full disk: reported, and nothing is lost."""
    text = BEAM + EVENTS + FIXED
    (folder / "scene.yaml").write_text(text)
    end(start(floe, ranks, folder, ["scene.yaml", "-o", "whole"]), folder)
    words = ["scene.yaml", "-o", "out", "--checkpoint", "20"]
    for checkpoints in (3, 2, 1, 1):
        if kill(start(floe, ranks, folder, words), ranks, folder, checkpoints, chance):
            break
        shutil.rmtree(folder / "out")
    else:
        raise AssertionError("never killed: it always came to its end before")
    again = ["--restart", "out"]
    refuse(floe, ranks, folder, [*again, "--formulation", "vm"], 2, "the run's formulation was vm+md")
    refuse(floe, ranks, folder, [*again, "-motion_snes_rtol", "1e-9"], 2, "expected the same, not")
    refuse(floe, 3 - ranks, folder, again, 2, f"the run had {ranks} ranks")
    refuse(floe, ranks, folder, [*again, "--until", "1e-9"], 2, "expected a later time")
    (folder / "scene.yaml").write_text(text + " # changed")
    refuse(floe, ranks, folder, again, 2, "scene.yaml has changed since")
    (folder / "scene.yaml").write_text(text)
    if ranks > 1:
        return  # Open MPI's own files would meet the limit, too
    full = ("env", "PMIX_MCA_gds=hash", "bash", "-c", "trap '' XFSZ; ulimit -f 16; exec \"$@\"", "bash")  # 16 KiB a file
    refuse(floe, ranks, folder, again, 1, "cannot write out/", full)
    end(start(floe, ranks, folder, again), folder)
    compare(folder / "whole", folder / "out", True)
    finished(floe, folder)


def finished(floe, folder):
    """A finished run keeps its results, unless it is continued; then its estimate is one of another motion."""
    run = lambda *words: subprocess.run([str(floe), "run", *words], cwd=folder, capture_output=True, text=True, timeout=TIME_LIMIT)
    assert run("scene.yaml", "-o", "out", "--force", "--checkpoint", "20").returncode == 0
    before = [(folder / "out" / name).read_bytes() for name in ("summary.json", "result.h5", "probes.csv")]
    drafts = [folder / "out" / f".{name}.partial" for name in ("summary.json", "result.h5")]  # killed after its motion
    for draft in drafts:
        draft.write_text("{")
    done = run("--restart", "out")
    assert done.returncode == 0 and "nothing is left to simulate" in done.stdout, done.stdout + done.stderr
    assert not any(draft.exists() for draft in drafts), "drafts of a finished run are left"
    end = json.loads(before[0])["integration"]["reached"]
    done = run("--restart", "out", "--until", str(end / 2))
    assert done.returncode == 2 and "expected a later time" in done.stderr, done.stderr
    assert before == [(folder / "out" / name).read_bytes() for name in ("summary.json", "result.h5", "probes.csv")]
    with h5py.File(folder / "out/result.h5") as file:
        assert "estimate" in file
    wrong = json.loads(before[0])
    wrong["integration"]["reached"] = "the end"
    for damaged in (json.dumps(wrong).encode(), before[0][: len(before[0]) // 2], b"[]"):
        (folder / "out/summary.json").write_bytes(damaged)
        done = run("--restart", "out")
        assert done.returncode == 2 and "summary.json: is damaged" in done.stderr, done.stderr
    (folder / "out/summary.json").write_bytes(before[0])
    assert run("--restart", "out", "--until", str(1.2 * end)).returncode == 0
    with h5py.File(folder / "out/result.h5") as file:
        assert "estimate" not in file, "the estimate is still that of the first part"


def main():
    floe, ranks, wanted = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), sys.argv[3:]
    seed = int(os.environ.get("FLOE_SEED", time.time_ns() % 1000000))
    chance, failed, kills = random.Random(seed), 0, 0
    chosen = {name: case for name, case in CASES.items() if not wanted or name in wanted}
    for name, (text, formulation) in chosen.items():
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            try:
                kills += attempt(floe, ranks, text, formulation, chance, pathlib.Path(folder))
            except (AssertionError, subprocess.TimeoutExpired) as fault:
                failed += 1
                print(f"FAIL {name}: {fault}", flush=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        try:
            if not wanted or "refusals" in wanted:
                refusals(floe, ranks, chance, pathlib.Path(folder))
        except (AssertionError, subprocess.TimeoutExpired) as fault:
            failed += 1
            print(f"FAIL refusals: {fault}", flush=True)
    print(f"{len(chosen)} scenes on {ranks} ranks, killed {kills} times, {failed} failed (FLOE_SEED={seed})")
    return 1 if failed or (chosen and not kills) else 0


if __name__ == "__main__":
    sys.exit(main())
