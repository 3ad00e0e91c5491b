#!/usr/bin/env python3
"""make totals: estimated and true parts of the errors of scenes whose events lock or unlock joints (tests/benchmark/events);
writes docs/benchmarks/events.md.

True, as root mean squares of each probe as a vector: cfr on elements a quarter as long in an eighth of the step; of the
step the reduced model in an eighth of the step; of the mesh the reduced model on elements a quarter as long; of the
reduction the full-order model less the reduced one, both in an eighth of the step; of the model the rest. Instants between
the times of an event in two of these do not count."""
import argparse
import datetime
import glob
import os
import subprocess
import sys
import tempfile

import numpy
import yaml

import totals

PARTS = ("reduction", "model", "mesh", "step", "total")


def history(floe, path, folder, formulation, times, shorter):
    """Probes at multiples of the scene's step, the times of the events, and the summary; or why there are none."""
    with open(path, encoding="utf-8") as file:
        step = float(yaml.safe_load(file)["motion"]["step"])
    out = os.path.join(folder, "out")
    estimate = [] if formulation == "vm+md" and times == shorter == 1 else ["--no-estimate"]
    summary, fault = totals.run(floe, totals.finer(path, folder, times, shorter), out, "--formulation", formulation, *estimate)
    if fault:
        return None, fault
    found = totals.probes(out)
    time = found.pop(next(iter(found)))
    at = step * numpy.arange(1, round(time[-1] / step) + 1)
    rows = numpy.searchsorted(time, at - 1e-6 * step)
    return ({name: values[rows] for name, values in found.items()}, at,
            {event["name"]: event["t"] for event in summary["events"]}, summary), ""


def compared(own, others):
    """The instants that are not between the times of an event in two motions."""
    time, step = own[1], own[1][0]
    use = numpy.ones(len(time), bool)
    for _, _, events, _ in others:
        for name, t in own[2].items():
            low, high = sorted((t, events[name]))
            if high - low > 1e-6 * step:
                use &= (time < low) | (time > high)
    return use


def true_parts(floe, path, folder):
    """The motion itself, and the true parts of its error in each column; or why there are none."""
    models = {"own": ("vm+md", 1, 1), "step": ("vm+md", 1, 8), "mesh": ("vm+md", 4, 1), "full": ("nlffr", 1, 8),
              "exact": ("cfr", 4, 8)}
    found, faults = {}, {}
    for name, model in models.items():
        found[name], faults[name] = history(floe, path, folder, *model)
    full = "step" if faults["full"] else "full"  # where it does not support the scene the model contains the reduction
    for name in ("own", "step", "mesh", "exact"):
        if faults[name]:
            return None, None, None, faults[name]
    q = {name: one[0] for name, one in found.items() if one}
    parts = {}
    for c in q["own"]:
        step, mesh, total = (q[name][c] - q["own"][c] for name in ("step", "mesh", "exact"))
        reduction = q[full][c] - q["step"][c]
        parts[c] = {"reduction": reduction, "model": total - reduction - mesh - step, "mesh": mesh, "step": step, "total": total}
    use = compared(found["own"], [one for one in found.values() if one])
    return found["own"], parts, use, ""


def measure(floe, path):
    """Rows of the table, and the ratios of estimated and true parts above 0.1 %."""
    name = os.path.basename(path).removesuffix(".yaml")
    with tempfile.TemporaryDirectory() as folder:
        own, parts, use, fault = true_parts(floe, path, folder)
    if fault:
        return [f"| {name} | {fault} |||||"], []
    estimate, rows, ratios = own[3]["estimate"], [], []
    for probe in dict.fromkeys(column.rsplit(".", 1)[0] for column in parts):
        columns = [c for c in parts if c.rsplit(".", 1)[0] == probe]
        size = numpy.sqrt(sum(numpy.sum(own[0][c][use]**2) for c in columns))
        cells = []
        for part in PARTS:
            true = float(numpy.sqrt(sum(numpy.sum(parts[c][part][use]**2) for c in columns)) / size)
            found = totals.part(estimate, part, probe)
            if found is None:
                cells.append("-")
                continue
            cells.append(f"{100 * found:.2g} / {100 * true:.2g}")
            if true > 1e-3:
                ratios.append(found / true)
        rows.append(f"| {name}, {probe} | " + " | ".join(cells) + " |")
    return rows, ratios


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--floe", default="build/floe")
    parser.add_argument("--out", default="docs/benchmarks/events.md")
    parser.add_argument("scenes", nargs="*")
    given = parser.parse_args()
    rows, ratios = [], []
    for path in given.scenes or sorted(glob.glob("tests/benchmark/events/*.yaml")):
        one, two = measure(given.floe, path)
        rows += one
        ratios += two
        print("\n".join(one), file=sys.stderr, flush=True)
    version = subprocess.run([given.floe, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    lines = ["# Errors of scenes with events", "",
             f"Written by `make totals` on {datetime.date.today()}, {version}, {totals.processor()}. The scenes are in",
             "`tests/benchmark/events`: their events lock or unlock joints, at a time or where a probe passes a value.", "",
             "Estimated / true parts of the error of each probe, in percent ([accuracy](../accuracy.md)). True: `cfr` on elements a",
             "quarter as long in an eighth of the step; the reduced model in an eighth of the step, and on elements a quarter as long;",
             "`nlffr` in an eighth of the step. Instants between the times of an event in two of these do not count.", "",
             "| scene, probe | " + " | ".join(PARTS) + " |", "|---|" + "--:|" * len(PARTS), *rows, "",
             f"The {len(ratios)} parts and totals above 0.1 % are between {min(ratios):.2f} and {max(ratios):.2f} times the true ones.",
             "The part `model` of a scene without the part `reduction` contains the reduction error: `nlffr` does not support the clamped",
             "edge of `released_plate`, and the steps of `folded_panel` do not resolve what its lock excites in `nlffr`."]
    with open(given.out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
