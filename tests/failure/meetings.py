#!/usr/bin/env python3
"""Processes that meet in one folder, and runs that are killed after their motion: what each says, and what stands.

meetings.py FLOE RANKS [NAME...]
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import h5py

from results import files

TIME_LIMIT = 300  # s

# Its motion takes little, what is asked of full order afterwards more than a second.
PLATE = """
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [40, 20]}}
    section: {thickness: 0.02}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {corner: {type: force, at: plate.p3, force: [0, 0, "600*sin(24*t)"]}}
motion: {end: 0.1, step: 1e-3}
probes: {tip: {at: plate.p3}}
"""


class Process:
    """A floe that runs in the folder, on so many ranks."""

    def __init__(self, floe, ranks, folder, *words, name="log"):
        self.log = folder / name
        command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(floe), *words]
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(command, cwd=folder, stdout=log, stderr=log)
        self.ranks = ranks

    def text(self):
        return self.log.read_text(errors="replace")

    def until(self, met, what):
        limit = time.monotonic() + TIME_LIMIT
        while not met():
            assert self.process.poll() is None, f"it ended before {what}: {self.text()[-1500:]}"
            assert time.monotonic() < limit, f"{what} does not come"
            time.sleep(2e-3)

    def members(self):
        """The processes of the ranks themselves."""
        if self.ranks == 1:
            return [self.process.pid]
        return list(map(int, pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()))

    def kill(self):
        """SIGKILL to every rank."""
        for pid in self.members():
            os.kill(pid, signal.SIGKILL)
        self.process.wait(TIME_LIMIT)

    def ends(self, code, *phrases):
        found = self.process.wait(TIME_LIMIT)
        assert found == code, f"exit code {found}, not {code}: {self.text()[-1500:]}"
        for phrase in phrases:
            assert self.text().count(phrase) == 1, f"not once {phrase!r} in {self.text()[-1500:]}"


def summary(folder):
    try:
        return json.loads((folder / "out/summary.json").read_text())
    except FileNotFoundError:
        return {}


def killed_in_estimate(floe, ranks, folder, *words):
    """The results are whole, and say that the estimate is not there."""
    (folder / "scene.yaml").write_text(PLATE)
    run = Process(floe, ranks, folder, *words, "scene.yaml", "-o", "out")
    run.until(lambda: "assessment" in summary(folder), "the estimate")
    run.kill()
    j = summary(folder)
    assert j["status"] == "finished" and j["assessment"].startswith("not done: the run was interrupted"), j
    assert j["estimate"] == {"none": j["assessment"]}, j["estimate"]
    (folder / "out/.floe.lock").unlink()  # so that the next run finds no other
    files("finished")(folder)
    with h5py.File(folder / "out/result.h5") as result:
        assert "estimate" not in result


def killed_in_estimate_of_run(floe, ranks, folder):
    killed_in_estimate(floe, ranks, folder, "run")


def killed_in_estimate_of_static(floe, ranks, folder):
    killed_in_estimate(floe, ranks, folder, "static", "--at", "0.1", "--steps", "3")


LONG = """
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 8}}
    section: {EA: 12000, EI: 1, rhoA: 1}
    reduction: {modes: 3, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.5*sin(9*t)"]}}
motion: {end: 1000, step: 1e-3, every: 100}
probes: {tip: {at: beam.end}}
"""
SHORT = LONG.replace("end: 1000", "end: 0.5")
HELD = "floe writes there (process "


def moving(folder, rows=3, out="out"):
    path = folder / out / "probes.csv"
    return lambda: path.exists() and path.read_text().count("\n") > rows


def started(floe, ranks, folder):
    """A run with checkpoints that is under way."""
    (folder / "scene.yaml").write_text(LONG)
    (folder / "short.yaml").write_text(SHORT)
    run = Process(floe, ranks, folder, "run", "scene.yaml", "-o", "out", "--checkpoint", "20000")
    run.until(lambda: moving(folder)() and (folder / "out/checkpoint.h5").exists(), "a checkpoint")
    return run


def a_living_run_is_left_alone(floe, ranks, folder):
    """Restart, run --force, and all other commands that would write there, are refused; the run comes to its end."""
    run = started(floe, ranks, folder)
    for words in (["run", "--restart", "out", "--until", "2000"], ["run", "short.yaml", "-o", "out", "--force"], ["run", "short.yaml", "-o", "out"],
                  ["static", "short.yaml", "-o", "out", "--force"], ["compare", "short.yaml", "-o", "out", "--force"],
                  ["tradeoff", "short.yaml", "-o", "out", "--force"],
                  ["campbell", "short.yaml", "--speeds", "1", "-o", "out", "--force"],
                  ["sweep", "short.yaml", "--vary", "motion.step=1e-3,2e-3", "-o", "out", "--force"],
                  ["modes", "short.yaml", "--write-matrices", "out", "--force"]):
        Process(floe, ranks, folder, *words, name="other").ends(2, HELD)
    rows = (folder / "out/probes.csv").read_text().count("\n")
    run.until(moving(folder, rows + 100), "more rows")
    for pid in run.members():
        os.kill(pid, signal.SIGTERM)
    run.process.wait(TIME_LIMIT)
    files("failed", reason="interrupted")(folder)
    assert not (folder / "out/.floe.lock").exists()
    Process(floe, ranks, folder, "run", "short.yaml", "-o", "out", "--force", name="after").ends(0)
    files("finished", 6)(folder)


def a_killed_run_holds_nothing(floe, ranks, folder):
    """SIGKILL leaves a lock; of two restarts at once one goes on, and after it is killed, too, another one."""
    started(floe, ranks, folder).kill()
    assert (folder / "out/.floe.lock").exists()
    # mpirun tells the other ranks, and they may take a moment
    both = [Process(floe, ranks, folder, "run", "--restart", "out", name=name) for name in ("one", "two")]
    limit = time.monotonic() + TIME_LIMIT
    while all(one.process.poll() is None for one in both):
        assert time.monotonic() < limit, "none is refused"
        time.sleep(0.01)
    refused, goes_on = sorted(both, key=lambda one: one.process.poll() is None)
    refused.ends(2, HELD)
    rows = (folder / "out/probes.csv").read_text().count("\n")
    goes_on.until(moving(folder, rows + 100), "more rows")
    goes_on.kill()
    Process(floe, ranks, folder, "run", "short.yaml", "-o", "out", "--force", name="after").ends(0)
    files("finished", 6)(folder)


def two_that_begin_at_once(floe, ranks, folder):
    """One of the two makes the folder's results, whole; with --force as well."""
    (folder / "scene.yaml").write_text(LONG)
    for force in ([], ["--force"]):
        both = [Process(floe, ranks, folder, "run", "scene.yaml", "-o", "out", *force, name=name) for name in ("one", "two")]
        limit = time.monotonic() + TIME_LIMIT
        while all(one.process.poll() is None for one in both):
            assert time.monotonic() < limit, "none is refused"
            time.sleep(0.01)
        refused, goes_on = sorted(both, key=lambda one: one.process.poll() is None)
        refused.ends(2, HELD)
        goes_on.until(moving(folder), "rows")
        for pid in goes_on.members():
            os.kill(pid, signal.SIGTERM)
        goes_on.process.wait(TIME_LIMIT)
        files("failed", reason="interrupted")(folder)


def two_that_write_one_file(floe, ranks, folder):
    """A reduced body's file, and shapes, are one process's at a time; a killed one holds nothing."""
    (folder / "scene.yaml").write_text(PLATE.replace("[40, 20]", "[60, 30]"))
    for words, name in ((["reduce", "scene.yaml", "-o", "body.h5", "--force"], "body.h5"),
                        (["modes", "scene.yaml", "--write", "modes.xdmf", "--force"], "modes.xdmf")):
        first = Process(floe, ranks, folder, *words, name="one")
        first.until((folder / f".{name}.lock").exists, "its lock")
        for pid in first.members():  # which might end before the second one begins
            os.kill(pid, signal.SIGSTOP)
        try:
            Process(floe, ranks, folder, *words, name="two").ends(2, HELD)
        finally:
            first.kill()
        Process(floe, ranks, folder, *words, name="three").ends(0)
        assert (folder / name).exists() and not (folder / f".{name}.lock").exists()


def a_reader_that_has_gone(floe, ranks, folder):
    """Output that nobody reads to its end, as by `floe schema | head`, ends the process without a word."""
    process = subprocess.Popen([str(floe), "schema"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    said = process.stderr.read().decode()
    assert process.wait(TIME_LIMIT) == -signal.SIGPIPE and said == "", (process.returncode, said)


CASES = [killed_in_estimate_of_run, killed_in_estimate_of_static, a_living_run_is_left_alone, a_killed_run_holds_nothing,
         two_that_begin_at_once, two_that_write_one_file,
         a_reader_that_has_gone]


def main():
    floe, ranks, wanted = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), sys.argv[3:]
    failed, chosen = 0, [case for case in CASES if not wanted or any(word in case.__name__ for word in wanted)]
    for case in chosen:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            try:
                case(floe, ranks, pathlib.Path(folder))
            except (AssertionError, subprocess.TimeoutExpired) as fault:
                failed += 1
                print(f"FAIL {case.__name__}: {fault}", flush=True)
    print(f"{len(chosen)} cases on {ranks} ranks, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
