"""What a run must leave behind, however it ended. Each check takes the folder that the run was started in."""
import csv
import json
import math
import re

import h5py


def files(status, rows=None, reason=None, end=None, out="out"):
    """A run's folder: a summary that says how it ended, whole lines of probes, a readable result of as many rows."""
    def check(folder):
        summary = json.loads((folder / out / "summary.json").read_text())
        assert summary["status"] == status, f"status {summary['status']}, not {status}"
        assert ("reason" in summary) == (status == "failed")
        if reason is not None:
            assert reason in summary["reason"], f"reason {summary['reason']!r} lacks {reason!r}"
        if end is not None:
            reached = summary["integration"]["reached"]
            assert math.isclose(reached, end, rel_tol=1e-9), f"reached {reached}, not {end}"
        times = probe_times(folder / out / "probes.csv")
        with h5py.File(folder / out / "result.h5") as result:
            stored = list(result["motion/t"][:, 0])
            for name in ("U", "V", "energy"):
                series = result[f"motion/{name}"]
                assert len(series) == len(stored), f"motion/{name} has {len(series)} rows for {len(stored)} times"
                assert all(map(math.isfinite, series[:].flat)), f"motion/{name} has a number that is none"
            assert json.loads(result["summary"][()])["status"] == status
        assert stored == times, "result.h5 and probes.csv have different times"
        assert rows is None or len(times) == rows, f"{len(times)} rows, not {rows}"
        assert not list((folder / out).glob(".*")), "drafts are left"
    return check


def stopped_once(folder):
    """A run that a signal ended: one time, that of the last row, whichever rank the signal came to first."""
    files("failed", reason="interrupted")(folder)
    summary = json.loads((folder / "out/summary.json").read_text())
    times = re.findall(r"the simulation stopped at t = (\S+) of", summary["reason"])
    assert len(times) == 1, f"{summary['reason']!r} has {len(times)} times"
    assert math.isclose(float(times[0]), summary["integration"]["reached"], rel_tol=1e-5), summary["reason"]


def estimated(instants, probe, out="out", by=None):
    """A run whose summary and result have an estimate of its error, at so many instants (least, most)."""
    def check(folder):
        estimate = json.loads((folder / out / "summary.json").read_text())["estimate"]
        assert 0 < estimate["probes"][probe] < 1 and estimate.get("by") == by, estimate
        assert by or 0 < estimate["deformation"] < 1, estimate
        assert instants[0] <= estimate["steps"] <= instants[1], f"{estimate['steps']} instants, not {instants}"
        with h5py.File(folder / out / "result.h5") as result:
            times = list(result["estimate/t"][:])
            assert len(times) == len(result["estimate/probes"]) == estimate["steps"] and times == sorted(set(times)), times
    return check


def probe_times(path):
    text = path.read_text()
    assert text.endswith("\n"), "probes.csv ends within a line"
    lines = list(csv.reader(text.splitlines()))
    assert all(len(line) == len(lines[0]) for line in lines), "probes.csv has a line that is cut"
    values = [[float(word) for word in line] for line in lines[1:]]
    assert all(math.isfinite(value) for line in values for value in line)
    times = [line[0] for line in values]
    assert times == sorted(set(times)), "the times of probes.csv do not increase"
    return times


def has_rows(path):
    """Whether a result that is being written has two rows of its motion."""
    try:
        with h5py.File(path) as result:
            return sum(math.isfinite(t) for t in result["motion/t"][:, 0]) >= 2
    except (OSError, KeyError):
        return False


def killed(folder):
    """After SIGKILL: nothing says that it finished, and what had been written can be read."""
    assert json.loads((folder / "out/summary.json").read_text())["status"] == "running"
    text = (folder / "out/probes.csv").read_text()
    (folder / "whole.csv").write_text(text[: text.rfind("\n") + 1])
    assert len(probe_times(folder / "whole.csv")) >= 2
    with h5py.File(folder / "out/result.h5") as result:
        times = [t for t in result["motion/t"][:, 0] if math.isfinite(t)]
        assert len(times) >= 2
        assert len(result["motion/U"]) >= len(times)


def full(folder):
    """On a full disk: the reason is reported, what had been written can be read, though no room is left to trim it."""
    summary = json.loads((folder / "out/summary.json").read_text())
    assert summary["status"] == "failed" and "File too large" in summary["reason"]
    times = probe_times(folder / "out/probes.csv")
    with h5py.File(folder / "out/result.h5") as result:
        stored = [t for t in result["motion/t"][:, 0] if math.isfinite(t)]
        states = [row for row in result["motion/U"][:] if all(map(math.isfinite, row))]
    assert len(stored) > 10 and len(states) > 10, f"{len(stored)} times, {len(states)} states"
    rows = min(len(stored), len(times))
    assert rows > 10 and stored[:rows] == times[:rows], "result.h5 and probes.csv have different times"


def nothing(folder):
    """Nothing was written but what was there before the run, and the test's own files."""
    assert not (folder / "out").exists(), "an output folder was made"
    assert not (folder / "results").exists(), "an output folder was made"


def no_results(folder):
    """Nothing claims to be the result of a run."""
    for path in folder.rglob("summary.json"):
        assert json.loads(path.read_text())["status"] != "finished"
    assert not list(folder.rglob(".*.partial")), "drafts are left"


def not_looked(folder):
    """An equilibrium of unknown stability is reported as such."""
    assert json.loads((folder / "out/summary.json").read_text())["stability"].startswith("not looked at")


def absent(path):
    def check(folder):
        assert not (folder / path).exists(), f"{path} was made"
    return check


def kept(path, text):
    def check(folder):
        assert (folder / path).read_text() == text, f"{path} was changed"
    return check


def stands(path):
    def check(folder):
        assert (folder / path).is_file(), f"{path} is missing"
    return check


def no_error_of(empty, other):
    """compare shows no error in a column whose reference is round-off, and one in another column."""
    def check(folder):
        with open(folder / "out/compare.csv") as table:
            row = list(csv.DictReader(table))[-1]
        cells = {column: next(row[key] for key in row if key.startswith(column + " vs")) for column in (empty, other)}
        assert cells[empty] == "", f"error of {empty} is {cells[empty]}"
        assert float(cells[other]) >= 0
        errors = json.loads((folder / "out/compare.json").read_text())["errors"]["nlffr"]["vm"]
        assert errors[empty] is None and errors[other] >= 0
    return check
