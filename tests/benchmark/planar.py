#!/usr/bin/env python3
"""Times planar formulations on the cantilever of Wu and Tiso at growing numbers of elements.

Every number is a median over repetitions; the formulations take turns within a repetition, so that a busy moment of
the machine falls on all of them. Written: planar.md (tables) and planar.png. Nothing passes or fails on a clock.
"""
import argparse
import datetime
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

SCENE = "examples/cantilever/scene.yaml"
MESHES = [20, 200, 2000, 20000]
FORMULATIONS = {"vm+md": "12 VMs + 5 MDs", "vm": "17 VMs", "nlffr": "NLFFR, full-order", "cfr": "CFR, full-order"}
REDUCED = ("vm+md", "vm")
PHASES = ("modes", "derivatives", "projection")
COLOURS = {"vm+md": "#D55E00", "vm": "#0072B2", "nlffr": "#009E73", "cfr": "#CC79A7"}
NOTES = "planar_notes.md"


def steps_of(formulation, elements):
    """Fewer steps where one takes long."""
    if formulation in REDUCED:
        return 10000
    return max(10, min(1000, 200000 // elements))


def scene_of(text, elements, steps):
    text, meshes = re.subn(r"elements: \d+", f"elements: {elements}", text)
    text, motions = re.subn(r"motion: \{.*\}", f"motion: {{end: {steps * 1e-3:g}, step: 1e-3, every: {steps}}}", text)
    if meshes != 1 or motions != 1:
        raise SystemExit(f"{SCENE}: expected one mesh and one motion")
    return text


def run(floe, formulation, elements, ranks, folder):
    with open(SCENE, encoding="utf-8") as file:
        text = scene_of(file.read(), elements, steps_of(formulation, elements))
    scene, out = os.path.join(folder, "scene.yaml"), os.path.join(folder, "run")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(text)
    shutil.rmtree(out, ignore_errors=True)
    command = ["mpirun", "-n", str(ranks), floe] if ranks > 1 else [floe]
    done = subprocess.run(command + ["run", scene, "--formulation", formulation, "-o", out], capture_output=True,
                          text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{formulation}, {elements} elements, {ranks} ranks:\n{done.stdout}{done.stderr}")
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def measure(arguments, folder):
    """{(formulation, elements, ranks): [summary, ...]}"""
    found = {}
    for repetition in range(arguments.repeat):
        for elements in arguments.elements:
            for ranks in arguments.ranks:
                for formulation in FORMULATIONS:
                    print(f"{repetition + 1}/{arguments.repeat} {elements} elements, {ranks} ranks, {formulation}",
                          file=sys.stderr)
                    summary = run(arguments.floe, formulation, elements, ranks, folder)
                    found.setdefault((formulation, elements, ranks), []).append(summary)
    return found


def median(summaries, value):
    return statistics.median(value(summary) for summary in summaries)


def spread(summaries, value):
    values = [value(summary) for summary in summaries]
    return max(values) / min(values)


def per_step(summary):
    return 1e6 * summary["seconds"]["per_step"]


def phase(name):
    return lambda summary: 1e3 * sum(body["seconds"][name] for body in summary["bodies"])


def newton(summary):
    return summary["integration"]["newton_iterations"] / summary["integration"]["steps"]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def step_tables(found, arguments):
    lines = []
    for ranks in arguments.ranks:
        rows = []
        for elements in arguments.elements:
            times = {f: median(found[f, elements, ranks], per_step) for f in FORMULATIONS}
            row = [str(elements)] + [f"{times[f]:.3g}" for f in FORMULATIONS]
            rows.append(row + [f"{times[f] / times['vm+md']:.3g}" for f in ("nlffr", "cfr")])
        head = ["elements"] + [f"{label} [us]" for label in FORMULATIONS.values()]
        lines += [f"### {ranks} rank{'s' if ranks > 1 else ''}", ""]
        lines += table(head + ["NLFFR : VMs + MDs", "CFR : VMs + MDs"], rows)
    return lines


def offline_table(found, arguments):
    rows = []
    for ranks in arguments.ranks:
        for elements in arguments.elements:
            runs = found["vm+md", elements, ranks]
            times = [median(runs, phase(name)) for name in PHASES]
            total = median(runs, lambda summary: 1e3 * summary["seconds"]["offline"])
            first = runs[0]["bodies"][0]
            rows.append([str(ranks), str(elements), str(first["dofs"]), str(first["reduced_coordinates"])] +
                        [f"{time:.3g}" for time in times + [total]])
    head = ["ranks", "elements", "dofs", "reduced"] + [f"{name} [ms]" for name in PHASES] + ["all offline [ms]"]
    return table(head, rows)


def independence(found, arguments):
    """The online cost of the reduced model versus the number of elements, in one sentence."""
    few, many = min(arguments.elements), max(arguments.elements)
    times = [median(found["vm+md", elements, 1], per_step) for elements in arguments.elements]
    iterations = [median(found["vm+md", elements, 1], newton) for elements in arguments.elements]
    grown = [median(found[f, many, 1], per_step) / median(found[f, few, 1], per_step) for f in ("nlffr", "cfr")]
    return (f"From {few} to {many} elements, on one rank, a step of the reduced model takes {min(times):.3g} to "
            f"{max(times):.3g} us ({min(iterations):.2f} to {max(iterations):.2f} Newton iterations), one of NLFFR "
            f"{grown[0]:.3g} times and one of CFR {grown[1]:.3g} times as long as at {few}. The former includes the "
            "load of the machine: the notes have counts of instructions.")


def document(found, arguments):
    one = found["vm+md", arguments.elements[0], arguments.ranks[0]][0]
    origin = one["provenance"]
    worst = max(spread(runs, per_step) for runs in found.values())
    lines = ["# Time per step and offline time, planar", "",
             "Written by `make bench-planar`; the notes at the end are tests/benchmark/planar_notes.md.", "",
             f"{datetime.date.today()}, {os.cpu_count()} x {processor()}, load average {os.getloadavg()[1]:.1f} (idle: under 1).",
             f"Provenance: {provenance_line(origin)}.", "",
             "The cantilever of the paper, its mesh varied: clamp as a joint, pinned frame, step 1e-3 s. Medians of "
             f"{arguments.repeat} alternating runs; the maximum of a set was up to {worst:.1f} times the minimum. "
             "Recording of results is not counted.", "",
             "## Microseconds per step", "", "![Microseconds per step versus elements](planar.png)", "",
             independence(found, arguments), ""]
    lines += step_tables(found, arguments)
    lines += ["## Offline: milliseconds of the phases of 12 VMs + 5 MDs", ""] + offline_table(found, arguments)
    return lines


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown processor")


def provenance_line(origin):
    parts = [f"floe {origin['floe']['version']} ({origin['floe']['commit']})"]
    return ", ".join(parts + [origin[name] for name in ("petsc", "slepc", "mpi", "hdf5")] + [origin["blas"]["name"]])


def draw(found, arguments, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    for formulation, label in FORMULATIONS.items():
        for ranks in arguments.ranks:
            times = [median(found[formulation, elements, ranks], per_step) for elements in arguments.elements]
            one = ranks == min(arguments.ranks)
            axes.loglog(arguments.elements, times, "o-" if one else "s--", markersize=4 if one else 3,
                        linewidth=1.6 if one else 1, color=COLOURS[formulation],
                        label=f"{label}, {ranks} rank{'s' if ranks > 1 else ''}")
    axes.set_xlabel("elements")
    axes.set_ylabel("microseconds per step")
    axes.grid(True, which="major", linewidth=0.4, alpha=0.6)
    axes.legend(fontsize=8, frameon=False)
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--floe", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--elements", type=int, nargs="+", default=MESHES)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    arguments.floe = os.path.abspath(arguments.floe)
    os.makedirs(arguments.out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        found = measure(arguments, folder)
    lines = document(found, arguments)
    notes = os.path.join(os.path.dirname(os.path.abspath(__file__)), NOTES)
    with open(notes, encoding="utf-8") as file:
        lines += file.read().splitlines()
    with open(os.path.join(arguments.out, "planar.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    draw(found, arguments, os.path.join(arguments.out, "planar.png"))


if __name__ == "__main__":
    main()
