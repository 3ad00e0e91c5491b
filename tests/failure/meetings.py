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

TIME_LIMIT = 120  # s

# Its motion takes little, what is asked of full order afterwards more than a second.
PLATE = """
bodies:
  plate:
    mesh: {plate: {along: [2, 0, 0], across: [0, 1, 0], elements: [60, 30]}}
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
    assert j["status"] == "finished" and j["assessment"].startswith("not done: the run was ended"), j
    assert j["estimate"] == {"none": j["assessment"]}, j["estimate"]
    files("finished")(folder)
    with h5py.File(folder / "out/result.h5") as result:
        assert "estimate" not in result


def killed_in_estimate_of_run(floe, ranks, folder):
    killed_in_estimate(floe, ranks, folder, "run")


def killed_in_estimate_of_static(floe, ranks, folder):
    killed_in_estimate(floe, ranks, folder, "static", "--at", "0.1", "--steps", "3")


CASES = [killed_in_estimate_of_run, killed_in_estimate_of_static]


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
