#!/usr/bin/env python3
"""CalculiX and floe on the same decks: static and dynamic deflections with geometric nonlinearity of a beam (B32R) and of a
plate (S8R), side by side.

Whole processes on one processor each, in the same run; floe's offline stage and its output are included. Differences are those
of the probe's history: root mean square of the difference over that of CalculiX', and of the reduced model over that of nlffr.
Written: peers.md. This is not a test that passes or fails by time.
"""
import argparse
import csv
import datetime
import json
import math
import os
import shutil
import subprocess
import tempfile

from calculix import run

YOUNG, POISSON, DENSITY = 7e10, 0.3, 2700.0


def beam(elements=20):
    """A cantilever of 1 m, 20 mm wide and 10 mm thick, of B32R: nodes, elements, sets, sections."""
    nodes = {i + 1: (i / (2 * elements), 0.0, 0.0) for i in range(2 * elements + 1)}
    cells = [(2 * e + 1, 2 * e + 2, 2 * e + 3) for e in range(elements)]
    return {"name": "beam", "type": "B32R", "nodes": nodes, "cells": cells, "root": [1], "tip": [2 * elements + 1],
            "section": "*BEAM SECTION, ELSET=ALL, MATERIAL=M, SECTION=RECT\n0.02, 0.01\n0, 1, 0\n",
            "stiffness": YOUNG * 0.02 * 0.01**3 / 12, "frame": "{type: pinned, from: ROOT, to: TIP}"}


def plate(along=16, across=8):
    """A cantilever plate of 1 m by 0.5 m, 5 mm thick, of S8R."""
    number = {}
    for i in range(2 * along + 1):
        for j in range(2 * across + 1):
            if i % 2 == 0 or j % 2 == 0:
                number[i, j] = len(number) + 1
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    cells = [tuple(number[2 * p + a, 2 * q + b] for a, b in corners) for p in range(along) for q in range(across)]
    nodes = {n: (i / (2 * along), 0.5 * j / (2 * across), 0.0) for (i, j), n in number.items()}
    return {"name": "plate", "type": "S8R", "nodes": nodes, "cells": cells,
            "root": [number[0, j] for j in range(2 * across + 1)], "tip": [number[2 * along, across]],
            "section": "*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.005\n",
            "stiffness": YOUNG * 0.5 * 0.005**3 / 12, "frame": None}


def model_of(body):
    lines = ["*NODE, NSET=NODES"] + [f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in body["nodes"].items()]
    lines += [f"*ELEMENT, TYPE={body['type']}, ELSET=ALL"]
    lines += [f"{e + 1}, " + ", ".join(map(str, cell)) for e, cell in enumerate(body["cells"])]
    for name in ("root", "tip"):
        lines += [f"*NSET, NSET={name.upper()}"] + [str(n) for n in body[name]]
    lines += [f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}"]
    return "\n".join(lines) + "\n" + body["section"]


def deck(body, force, dynamic):
    """CalculiX' input. @param dynamic  (step, end), or None: ten static steps"""
    kind = f"*DYNAMIC, DIRECT\n{dynamic[0]}, {dynamic[1]}" if dynamic else "*STATIC, DIRECT\n0.1, 1"
    return (model_of(body) + "*BOUNDARY\nROOT, 1, 6\n*STEP, NLGEOM, INC=100000\n" + kind +
            f"\n*CLOAD\nTIP, 3, {force}\n*NODE PRINT, NSET=TIP\nU\n*END STEP\n")


def scene(body, force, dynamic, modes):
    frame = f"    frame: {body['frame']}\n" if body["frame"] else ""
    motion = f"{{end: {dynamic[1]}, step: {dynamic[0]}}}" if dynamic else "{end: 1, step: 0.1}"
    size = f'"{force}*t"' if not dynamic else str(force)
    return f"""title: {body['name']} under a force
bodies:
  body:
    mesh: {{file: {{path: model.inp}}}}
{frame}    reduction: {{modes: {modes}, derivatives: all}}
joints: {{root: {{type: fixed, between: [ground, body.ROOT]}}}}
loads: {{push: {{type: force, at: body.TIP, force: [0, 0, {size}]}}}}
motion: {motion}
probes: {{tip: {{at: body.TIP}}}}
"""


def history_of_calculix(path):
    """Displacements of the tip at each increment, from its .dat."""
    rows = []
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if len(words) == 4 and words[0].isdigit():
                rows.append([float(w) for w in words[1:]])
    return rows


def history_of_floe(path, name):
    with open(path) as lines:
        rows = list(csv.DictReader(lines))
    columns = [next(c for c in rows[0] if c.startswith(f"{name}.{axis}")) for axis in "xyz"]
    return [[float(row[c]) for c in columns] for row in rows]


def difference(one, other):
    """Relative, of vectors at the same instants."""
    n = min(len(one), len(other))
    above = sum(sum((a - b)**2 for a, b in zip(one[i], other[i])) for i in range(n))
    return math.sqrt(above / sum(sum(b * b for b in other[i]) for i in range(n)))


def floe_run(floe, folder, formulation, dynamic, limit):
    out = os.path.join(folder, formulation)
    command = [floe, "run" if dynamic else "static", "scene.yaml", "--formulation", formulation, "--no-estimate", "-o", out]
    try:
        _, cost = run(command + ([] if dynamic else ["--at", "1", "--steps", "10"]), folder, limit)
    except SystemExit as fault:  # its reason is in the table
        return None, str(fault).splitlines()[-1].removeprefix("floe: ")[:160]
    if cost is None:
        return None, "not within the time limit"
    table = os.path.join(out, "probes.csv" if dynamic else "static.csv")
    if not os.path.exists(table):
        table = next(os.path.join(out, f) for f in sorted(os.listdir(out)) if f.endswith(".csv"))
    rows = history_of_floe(table, "tip")
    summary = json.load(open(os.path.join(out, "summary.json")))
    cost["unknowns"] = summary.get("unknowns", {})
    return rows[1:] if len(rows) % 10 == 1 else rows, cost


def compare(floe, body, deflection, dynamic, modes, limit):
    """Three rows: CalculiX, nlffr, vm+md. @param deflection  P L^2 / EI"""
    force = deflection * body["stiffness"]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        open(os.path.join(folder, "model.inp"), "w").write(model_of(body))
        open(os.path.join(folder, "peer.inp"), "w").write(deck(body, force, dynamic))
        open(os.path.join(folder, "scene.yaml"), "w").write(scene(body, force, dynamic, modes))
        _, cost = run(["ccx", "-i", "peer"], folder, limit)
        theirs = history_of_calculix(os.path.join(folder, "peer.dat")) if cost else []
        rows.append(("CalculiX " + body["type"] + ("" if cost else ": not within the time limit"), cost, None, None))
        full = None
        for formulation in ("cfr", "nlffr", "vm+md"):
            ours, cost = floe_run(floe, folder, formulation, dynamic, limit)
            if ours is None:
                rows.append((f"{formulation}: {cost}", None, None, None))
                continue
            full = ours if formulation == "nlffr" else full
            rows.append((formulation, cost, difference(ours, theirs) if theirs else None,
                         difference(ours, full) if formulation == "vm+md" and full else None))
        tip = theirs[-1] if theirs else None
    return rows, tip


def per_cent(value):
    return "" if value is None else f"{100 * value:.2g} %"


def table(rows):
    lines = ["| model | CPU [s] | wall [s] | CPU relative to CalculiX | difference from CalculiX | from nlffr |",
             "|---|--:|--:|--:|--:|--:|"]
    theirs = rows[0][1]
    for name, cost, apart, reduced in rows:
        if cost is None:
            lines.append(f"| {name} | | | | | |")
            continue
        ratio = f"{cost['cpu'] / theirs['cpu']:.2g}" if theirs else ""
        lines.append(f"| {name} | {cost['cpu']:.2f} | {cost['wall']:.2f} | {ratio} | {per_cent(apart)} | {per_cent(reduced)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--floe", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--limit", type=float, default=300)
    options = parser.parse_args()
    if not shutil.which("ccx"):
        raise SystemExit("ccx is missing (package calculix-ccx)")
    floe = os.path.abspath(options.floe)
    version = subprocess.run([floe, "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    ccx = subprocess.run(["dpkg-query", "-W", "calculix-ccx"], capture_output=True, text=True).stdout.replace("\t", " ").strip()
    text = ["# Comparison with CalculiX", "",
            f"{datetime.date.today()}, {version}; {ccx}; mean load {os.getloadavg()[0]:.1f}. `make bench-peers` writes this page.", "",
            "The same decks in both programs: a cantilever of 20 B32R and a cantilever plate of 16 by 8 S8R (Poisson's ratio 0.3), under a force at the",
            "middle of the free end. Whole processes on one processor, in the same run: floe's offline stage and output are included. Static: ten equal",
            "steps of the load. Dynamic: a force that is constant from t = 0, in equal steps; CalculiX' scheme is that of Hilber, Hughes and Taylor with",
            "alpha = -0.05, floe's the generalized-alpha scheme with its default. Differences are root mean squares over all steps, relative.", ""]
    for title, body, deflection, dynamic, modes in (
            ("Static beam, $PL^2/EI = 0.5$", beam(), 0.5, None, 5),
            ("Dynamic beam, $PL^2/EI = 0.25$, 200 steps", beam(), 0.25, (1e-3, 0.2), 5),
            ("Static plate, $PL^2/EI = 0.25$", plate(), 0.25, None, 6),
            ("Dynamic plate, $PL^2/EI = 0.1$, 100 steps", plate(), 0.1, (4e-3, 0.4), 6)):
        rows, tip = compare(floe, body, deflection, dynamic, modes, options.limit)
        text += [f"## {title}", "", table(rows), ""]
        if tip:
            text += [f"Displacement of the tip at the end (CalculiX): {tip[0]:.5g}, {tip[2]:.5g} m.", ""]
        print("\n".join(text[-6 - len(rows):]), flush=True)
    with open(os.path.join(options.out, "peers.md"), "w") as page:
        page.write("\n".join(text))


if __name__ == "__main__":
    main()
