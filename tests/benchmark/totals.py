#!/usr/bin/env python3
"""make totals: estimated and true total errors of the scenes that floe can compare with formulation cfr, and of the
models that it selects for 5 %, 1 % and 0.2 %; writes docs/totals.md.

True: root mean square of each probe as a vector against formulation cfr, for lines on elements a quarter as long in a
quarter of the step, for plates extrapolated from the mesh and elements half as long (order 2), in half the step."""
import argparse
import csv
import datetime
import glob
import json
import os
import subprocess
import sys
import tempfile

import numpy
import yaml

EXAMPLES = ["start/scene", "cantilever/scene", "cantilever/all_derivatives", "cantilever/clamped_frame",
            "cantilever/four_frames", "cantilever/hinged_modes", "cantilever/no_rotary_inertia",
            "cantilever/pointwise_strain", "pendulum/scene", "robot_arm/scene", "robot_arm/moment_column",
            "slider_crank/scene", "spin_up/scene", "shaken_plate/scene"]
ACCURACIES = ["5%", "1%", "0.2%"]


def has_plates(path):
    with open(path, encoding="utf-8") as file:
        return any("plate" in body.get("mesh", {}) for body in yaml.safe_load(file)["bodies"].values())


def finer(path, folder, times, shorter):
    """The scene on a mesh so many times as fine in steps so many times as short, stored as often."""
    with open(path, encoding="utf-8") as file:
        scene = yaml.safe_load(file)
    for body in scene["bodies"].values():
        for mesh in body.get("mesh", {}).values():
            counts = mesh["elements"]
            if not body.get("rigid"):
                mesh["elements"] = [times * n for n in counts] if isinstance(counts, list) else times * counts
    motion = scene["motion"]
    step = float(motion["step"])
    motion["output"] = float(motion.get("output", step * int(motion.pop("every", 1))))
    motion["step"] = step / shorter
    scene.pop("accuracy", None)
    name = os.path.join(folder, "finer.yaml")
    with open(name, "w", encoding="utf-8") as file:
        yaml.safe_dump(scene, file, sort_keys=False)
    return name


def probes(folder):
    with open(os.path.join(folder, "probes.csv"), encoding="utf-8") as file:
        rows = list(csv.reader(file))
    values = numpy.array([[float(x) for x in row] for row in rows[1:]])
    return {name.split(" ")[0]: values[:, i] for i, name in enumerate(rows[0])}


def errors(found, true):
    """Of each probe as a vector; the motion is interpolated at the times of the true one."""
    time = next(iter(found))
    names = {}
    for column in found:
        if column != time:
            names.setdefault(column.rsplit(".", 1)[0], []).append(column)
    all_errors = {}
    for probe, columns in names.items():
        gap = sum(numpy.sum((found[c] - numpy.interp(found[time], true[time], true[c]))**2) for c in columns)
        size = sum(numpy.sum(numpy.interp(found[time], true[time], true[c])**2) for c in columns)
        all_errors[probe] = float(numpy.sqrt(gap / size))
    return all_errors


def true_probes(floe, path, folder):
    """Those of formulation cfr, extrapolated (order 2) for plates; or why there are none."""
    steps, meshes = (2, (2, 1)) if has_plates(path) else (4, (4,))
    found = []
    for times in meshes:
        _, fault = run(floe, finer(path, folder, times, steps), os.path.join(folder, "true"), "--formulation", "cfr")
        if fault:
            return None, fault
        found.append(probes(os.path.join(folder, "true")))
    fine, coarse = found[0], found[-1]
    return {c: fine[c] + (fine[c] - coarse[c]) / 3 for c in fine}, ""


def run(floe, scene, folder, *options):
    """The summary, or why there is none."""
    done = subprocess.run([floe, "run", scene, "-o", folder, "--force", *options], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        return None, done.stderr.strip().splitlines()[-1]
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file), ""


def percent(share):
    return "-" if share is None else f"{100 * share:.3g} %"


def part(estimate, name, probe):
    return (estimate if name == "reduction" else estimate.get(name, {})).get("probes", {}).get(probe)


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown processor")


def measure(floe, name, path, folder, accuracies):
    """Rows of the two tables."""
    budgets, choices = [], []
    true, fault = true_probes(floe, path, folder)
    if fault:
        return [f"| {name} | no true solution: {fault} |||||||"], []
    out = os.path.join(folder, "own")
    summary, fault = run(floe, path, out, "--formulation", "vm+md")
    if fault:
        budgets.append(f"| {name} | {fault} |||||||")
    else:
        estimate = summary["estimate"]
        for probe, error in errors(probes(out), true).items():
            total = estimate.get("total", {}).get("probes", {}).get(probe)
            ratio = "-" if total is None else f"{total / error:.2f}"
            cells = [percent(part(estimate, one, probe)) for one in ("reduction", "model", "mesh", "step")]
            budgets.append(f"| {name}, {probe} | " + " | ".join(cells) + f" | {percent(total)} | {percent(error)} | {ratio} |")
    for accuracy in accuracies:
        out = os.path.join(folder, "chosen")
        summary, fault = run(floe, path, out, "--accuracy", accuracy)
        if fault:
            choices.append(f"| {name} | {accuracy} | {fault} |||||")
            continue
        chosen, error = summary["accuracy"], max(errors(probes(out), true).values())
        asked = chosen["asked"]
        what = "; ".join(one["choice"] for one in chosen["decisions"] if one["what"] in ("mesh and frames", "step", "basis vectors"))
        verdict = "" if error <= 1.5 * asked else ("missed, reported" if not chosen["within"] else "**missed**")
        choices.append(f"| {name} | {accuracy} | {percent(chosen['supported'])} | {percent(error)} | {verdict} | {what} | "
                       f"{chosen['seconds']:.2g} |")
    return budgets, choices


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--floe", default="build/floe")
    parser.add_argument("--out", default="docs/totals.md")
    parser.add_argument("--accuracies", nargs="*", default=ACCURACIES)
    parser.add_argument("scenes", nargs="*")
    given = parser.parse_args()
    others = sorted(glob.glob("tests/benchmark/totals/*.yaml"))
    scenes = given.scenes or [f"examples/{name}.yaml" for name in EXAMPLES] + others
    budgets, choices = [], []
    for path in scenes:
        name = path.removeprefix("examples/").removeprefix("tests/benchmark/totals/").removesuffix(".yaml").removesuffix("/scene")
        with tempfile.TemporaryDirectory() as folder:
            one, two = measure(given.floe, name, path, folder, given.accuracies)
        budgets += one
        choices += two
        print("\n".join(one + two), file=sys.stderr, flush=True)
    version = subprocess.run([given.floe, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    lines = ["# Total errors: estimated, required, true", "",
             f"Written by `make totals` on {datetime.date.today()}, {version}, {processor()}. The last scenes are in",
             "`tests/benchmark/totals`. What the columns mean, and why some values are missed: [accuracy](accuracy.md).", "",
             "True: against `cfr`, for lines on elements a quarter as long in a quarter of the step, for plates extrapolated from",
             "the mesh and elements half as long, in half the step.", "",
             "## Estimates after a run", "",
             "| scene, probe | reduction | model | mesh | step | total | true | ratio |", "|---|--:|--:|--:|--:|--:|--:|--:|",
             *budgets, "", "## Models selected for a total error", "",
             "True: of the worst probe. Missed: more than 1.5 times what was required.", "",
             "| scene | required | estimated | true | | selected | seconds |", "|---|--:|--:|--:|---|---|--:|", *choices]
    with open(given.out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
