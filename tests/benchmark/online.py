#!/usr/bin/env python3
"""Times one step of reduced models, and of the full-order models for comparison.

Processor time of the integration on one rank (all of TS, SNES, KSP and the equations; without recording), the
minimum of several alternating runs: on a shared machine the minimum is the time of the program itself. Full-order and reduced
model of one scene use the same steps; errors are those of the reduced model's probes. Written: online.md. This is not a
test that passes or fails by time.
"""
import argparse
import csv
import datetime
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

NOTES = "online_notes.md"

BEAM = """
title: Beam on a hinge, in the plane
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 40}}
    section: {A: 1.8e-4, I: 1.215e-9}
    material: {E: 1e9, rho: 7800}
    frame: {type: pinned, from: start, to: end}
    reduction: {modes: {count: 3}, derivatives: all}
joints:
  hinge: {type: revolute, between: [ground, beam.start]}
gravity: [0, -9.81]
motion: {end: 20, step: 1e-3, every: 1000000}
probes:
  tip: {at: beam.end, quantity: position}
"""

PANEL = """
title: Panel on a hinge, in space
bodies:
  panel:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.5, 0], elements: [20, 10]}}
    section: {thickness: 4e-3}
    strains: STRAINS
    material: {E: 3e9, nu: 0.3, rho: 1200}
    reduction: {modes: {count: MODES}, derivatives: all}
joints:
  hinge: {type: revolute, between: [ground, panel.left]}
gravity: [0, 0, -9.81]
motion: {end: END, step: 1e-3, every: 1000000}
probes:
  tip: {at: panel.right, quantity: position}
"""

# f_1 = 1.0 Hz; the drive bends the fin by a third of its length.
FLAPPING = """
title: Fin flapped by a driven hinge
bodies:
  panel:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.1, 0], elements: CELLS}}
    section: {thickness: 4e-3}
    strains: STRAINS
    material: {E: 3e9, nu: 0.3, rho: 1200}
    reduction: {modes: {count: 6}, derivatives: all}
joints:
  root: {type: driven, between: [ground, panel.left], axis: [0, 1, 0], angle: "0.5*(1 - cos(pi*t))"}
motion: {end: END, step: 5e-3}
probes:
  tip: {at: panel.right, quantity: position}
  bend: {at: panel.right, quantity: deflection}
"""

# Strains of second order: modal derivatives have slopes, too, and a product with every other vector.
STRIP = """
title: Strip of shells
bodies:
  strip:
    mesh: {plate: {along: [1, 0, 0], across: [0, 0.25, 0], elements: [8, 2]}}
    section: {thickness: 6e-3}
    strains: second_order
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 4}
joints: {root: {type: fixed, between: [ground, strip.left]}}
loads: {tip: {type: force, at: strip.right, force: [0, 0, "25*sin(30*t)"]}}
motion: {end: 0.2, step: 1e-3}
probes: {tip: {at: strip.right}}
"""
SHARES = ["all", "1 %", "3 %", "10 %"]

def panel(modes, end, strains):
    return PANEL.replace("MODES", str(modes)).replace("END", str(end)).replace("STRAINS", strains)


STEPS = [  # name, scene, target in microseconds or none
    ("plane, 3 modes + 6 derivatives, hinge", BEAM, 5),
    ("space, 5 modes + 15 derivatives, hinge", panel(5, 5, "von_karman"), 12),
    ("the same, strains of second order", panel(5, 5, "second_order"), None),
    ("space, 10 modes + 55 derivatives, hinge", panel(10, 2, "von_karman"), 50),
]
FULL = [  # elements, end of the simulation [s], strains
    ([100, 10], 1.0, "von_karman"),
    ([100, 10], 1.0, "second_order"),
    ([320, 32], 0.5, "von_karman"),
]


def run(floe, text, formulation, folder, *options):
    scene, out = os.path.join(folder, "scene.yaml"), os.path.join(folder, formulation)
    with open(scene, "w", encoding="utf-8") as file:
        file.write(text)
    shutil.rmtree(out, ignore_errors=True)
    done = subprocess.run([floe, "run", scene, "--formulation", formulation, "-o", out, *options], capture_output=True, text=True,
                          check=False)
    if done.returncode:
        raise SystemExit(f"{formulation}:\n{done.stdout}{done.stderr}")
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    with open(os.path.join(out, "probes.csv"), encoding="utf-8") as file:
        rows = [line for line in csv.reader(file) if line and not line[0].startswith("#")]
    return summary, rows[0], [[float(x) for x in row] for row in rows[1:]]


def per_step(summary):
    """Microseconds of processor time."""
    return 1e6 * summary["seconds"]["motion_and_recording_processor"] / summary["integration"]["steps"]


def iterations(summary):
    return summary["integration"]["newton_iterations"] / summary["integration"]["steps"]


def relative_rms(values, reference, columns):
    """Of a vector probe, over the times that both have."""
    square = sum((values[i][c] - reference[i][c]) ** 2 for i in range(len(reference)) for c in columns)
    return math.sqrt(square / sum(reference[i][c] ** 2 for i in range(len(reference)) for c in columns))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def measure_steps(arguments, folder):
    found = {}
    for repetition in range(arguments.repeat):
        for name, scene, _ in STEPS:
            print(f"{repetition + 1}/{arguments.repeat} {name}", file=sys.stderr)
            found.setdefault(name, []).append(run(arguments.floe, scene, "vm+md", folder)[0])
    return found


def measure_full(arguments, folder):
    found = []
    for cells, end, strains in FULL[:arguments.full]:
        text = FLAPPING.replace("CELLS", str(cells)).replace("END", str(end)).replace("STRAINS", strains)
        print(f"full-order model, {cells[0]} by {cells[1]} elements", file=sys.stderr)
        full = run(arguments.floe, text, "nlffr", folder)
        kinds = {"vm+md": [run(arguments.floe, text, "vm+md", folder) for _ in range(arguments.repeat)],
                 "lffr": [run(arguments.floe, text, "lffr", folder)] if cells == FULL[0][0] else []}
        found.append((full, kinds, strains))
    return found


def blade(folder):
    """The example's scene, its mesh in the folder."""
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "blade")
    shutil.copy(os.path.join(here, "mesh.py"), folder)
    subprocess.run([sys.executable, os.path.join(folder, "mesh.py")], check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(here, "scene.yaml"), encoding="utf-8") as file:
        return file.read()


def measure_products(arguments, folder):
    """Of each scene and share: the summaries, and the error of the probe against the full-order model."""
    found = []
    for name, text, modes in [("strip", STRIP, "modes: 4"), ("blade (examples/blade)", blade(folder), "modes: 8, products: 3 %")]:
        print(f"products, {name}", file=sys.stderr)
        reference = run(arguments.floe, text, "nlffr", folder)
        for share in SHARES * arguments.repeat:
            summary, _, values = run(arguments.floe, text.replace(modes, f"{modes.split(',')[0]}, products: {share}"), "vm+md", folder,
                                     "--no-estimate")
            found.append((name, share, summary, relative_rms(values, reference[2], range(1, len(values[0])))))
    return found


def product_rows(found):
    rows = []
    for name, share in dict.fromkeys((name, share) for name, share, _, _ in found):
        runs = [(summary, error) for n, s, summary, error in found if (n, s) == (name, share)]
        body = runs[0][0]["bodies"][0]
        times = [per_step(summary) for summary, _ in runs]
        rows.append([name, share, str(body["reduced_coordinates"]), f"{body['products']['kept']} of {body['products']['of']}",
                     f"{iterations(runs[0][0]):.2f}", f"{min(times):.1f}", f"{max(times):.1f}", f"{100 * runs[0][1]:.2f}"])
    return rows


def step_rows(found):
    rows = []
    for name, _, wanted in STEPS:
        best = min(found[name], key=per_step)
        rows.append([name, str(best["bodies"][0]["reduced_coordinates"]), str(best["unknowns"]["coordinates"]),
                     f"{iterations(best):.2f}", f"{per_step(best):.1f}", f"{max(map(per_step, found[name])):.1f}",
                     str(wanted or "")])
    return rows


def full_rows(found):
    rows = []
    for (summary, names, values), kinds, strains in found:
        times = sorted(per_step(one[0]) for one in kinds["vm+md"])
        error = {probe: relative_rms(kinds["vm+md"][0][2], values,
                                     [c for c, name in enumerate(names) if name.startswith(probe + ".")])
                 for probe in ("tip", "bend")}
        rows.append([str(summary["bodies"][0]["dofs"]), strains, str(kinds["vm+md"][0][0]["unknowns"]["coordinates"]),
                     str(summary["integration"]["steps"]), f"{per_step(summary):.3g}", f"{times[0]:.3g}",
                     f"{per_step(summary) / times[0]:.0f}", f"{100 * error['tip']:.2g}", f"{100 * error['bend']:.2g}",
                     f"{kinds['vm+md'][0][0]['seconds']['offline']:.2g}"])
    return rows


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown")


def document(steps, full, products, arguments):
    origin = next(iter(steps.values()))[0]["provenance"]
    lines = ["# Time per step", "",
             f"{datetime.date.today()}, {processor()}, {os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}; "
             f"floe {origin['floe']['version']} ({origin['floe']['commit']}). `make bench-online` writes this page.", "",
             f"Processor time per step, microseconds, one rank, minimum and maximum of {arguments.repeat} runs.", ""]
    lines += table(["model", "k", "coordinates", "Newton iterations per step", "min [us]", "max [us]",
                    "target [us]"], step_rows(steps))
    lines += ["A shell fin flapped by a driven hinge: its tip deflects by a third of its length. The full-order model (NLFFR) "
              "and 6 modes with their 21 derivatives use the same steps of 5 ms.", ""]
    lines += table(["dofs", "strains", "coordinates", "steps", "NLFFR [us]", "reduced [us]", "ratio", "error of the tip [%]",
                    "error of its deflection [%]", "offline [s]"], full_rows(full))
    lines += ["## Fewer products", "",
              "`reduction: {products: ...}`: products of two coordinates in the elastic force; error of the probe against the full-order model.", ""]
    lines += table(["scene", "products", "k", "kept", "Newton iterations per step", "min [us]", "max [us]", "error [%]"],
                   product_rows(products))
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, NOTES), encoding="utf-8") as file:
        lines += [file.read()]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--floe", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--full", type=int, default=len(FULL), help="how many of the full-order sizes")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        steps, full = measure_steps(arguments, folder), measure_full(arguments, folder)
        products = measure_products(arguments, folder)
    text = document(steps, full, products, arguments)
    os.makedirs(arguments.out, exist_ok=True)
    with open(os.path.join(arguments.out, "online.md"), "w", encoding="utf-8") as file:
        file.write(text)
    print(text)


if __name__ == "__main__":
    main()
