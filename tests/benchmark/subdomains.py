#!/usr/bin/env python3
"""Domain decomposition (PCBDDC) against the direct solver: iterations, processor seconds, memory by ranks.

Written: subdomains.md. Each run is a process; processor seconds are those outside of MPI's calls. Nothing passes or
fails on a clock.
"""
import argparse
import datetime
import json
import os
import pathlib
import subprocess

OPTIONS = "examples/blade/options/subdomains.opts"
NOTES = "subdomains_notes.md"
SHAPES = ("flat", "curved")
THICKNESSES = ("1e-2", "1e-3", "1e-4")
SOLVES = 81  # 26 of the modes and 55 of the derivatives, as in offline.md


def run(program, ranks, *arguments):
    done = subprocess.run(["mpiexec", "-n", str(ranks), program, *arguments], capture_output=True, text=True)
    if done.returncode != 0 or not done.stdout.startswith("{"):
        raise SystemExit(f"{program} {' '.join(arguments)} on {ranks} ranks: {done.stdout}{done.stderr}")
    return json.loads(done.stdout)


def case(program, cells, shape, thickness, ranks):
    """A line for each number of ranks, each with its ratios to the direct solver."""
    arguments = ["-cells", str(cells), "-thickness", thickness, "-curved", str(SHAPES.index(shape))]
    direct = run(program, 1, *arguments, "-solves", "10")
    total = direct["setup"] + 26 * direct["solve"] + 55 * direct["block"]
    lines = []
    for n in ranks:
        found = run(program, n, *arguments, "-solves", "1", "-options_file", OPTIONS)
        dofs = found["dofs"]
        lines.append([shape, thickness, str(dofs), str(n),
                      str(found["iterations"]) if found["reason"] == "CONVERGED_RTOL" else found["reason"],
                      str(found["coarse"]), f"{found['setup']:.2f}", f"{found['solve']:.3f}",
                      f"{found['setup'] / direct['setup']:.1f}", f"{found['solve'] / direct['solve']:.0f}",
                      f"{(found['setup'] + SOLVES * found['solve']) / total:.0f}",
                      f"{found['memory'][0]:.0f}", f"{1e3 * found['memory'][1] / dofs:.1f}",
                      f"{abs(found['deflection'] / direct['deflection'] - 1):.0e}"])
        print(" | ".join(lines[-1]), flush=True)
    direct_line = [shape, thickness, str(direct["dofs"]), "direct, 1", "", "", f"{direct['setup']:.2f}",
                   f"{direct['solve']:.3f}", "", "", "", f"{direct['memory'][0]:.0f}",
                   f"{1e3 * direct['memory'][1] / direct['dofs']:.1f}", ""]
    return [direct_line, *lines]


def table(lines):
    head = ["shape", "thickness / length", "dofs", "ranks", "iterations", "coarse size", "setup [s]", "solve [s]",
            "setup / direct", "solve / direct", "stage / direct", "MB, maximum of a rank", "GB per million dofs",
            "difference"]
    return "\n".join(["| " + " | ".join(line) + " |" for line in [head, ["---"] + ["---:"] * (len(head) - 1), *lines]])


def missed(values, most, text):
    """`text` of the least and the greatest value, and in how many cases these are above the goal."""
    above = sum(value > most for value in values)
    return ((f"missed in {above} of {len(values)} cases: " if above else f"met in {len(values)} cases: ")
            + text.format(min(values), max(values)))


def goals(lines):
    """The goals for large models, against those meshes that have the least and the greatest number of ranks."""
    ranks = sorted({int(line[3]) for line in lines if line[3].isdigit()})
    few, many = (({tuple(line[:3]): line for line in lines if line[3] == str(n)}) for n in (ranks[0], ranks[-1]))
    both = [(few[key], many[key]) for key in few if key in many]
    growth = [int(b[4]) / int(a[4]) for a, b in both if a[4].isdigit() and b[4].isdigit()]
    stage = [[float(line[10]) for line in pair] for pair in zip(*both)]
    memory = [[float(line[12]) for line in pair] for pair in zip(*both)]
    rows = [[f"iterations grow by at most 1.5 from {ranks[0]} to {ranks[-1]} ranks", missed(growth, 1.5, "{:.2f} to {:.2f}")]]
    for n, ratios, sizes in zip((ranks[0], ranks[-1]), stage, memory):
        rows.append([f"at most 5 times the direct solver's processor time for the stage, {n} ranks",
                     missed(ratios, 5, "{:.0f} to {:.0f} times")])
        rows.append([f"at most 2 GB per million dofs, {n} ranks", missed(sizes, 2, "{:.1f} to {:.1f}")])
    return "\n".join("| " + " | ".join(row) + " |" for row in [["goal", "result"], ["---", "---"], *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--cells", type=int, nargs="*", default=[70, 140])
    parser.add_argument("--large", type=int, default=316, help="cells of one more plate, on 4 ranks; 0: none")
    parser.add_argument("--ranks", type=int, nargs="*", default=[2, 4, 8, 16])
    arguments = parser.parse_args()
    lines = []
    for cells in arguments.cells:
        for shape in SHAPES:
            for thickness in THICKNESSES:
                lines += case(arguments.program, cells, shape, thickness, arguments.ranks)
    if arguments.large:
        lines += case(arguments.program, arguments.large, "curved", "1e-3", [4])
    load = os.getloadavg()[2]
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    notes = (pathlib.Path(__file__).parent / NOTES).read_text()
    (arguments.out / "subdomains.md").write_text(
        f"# Domain decomposition\n\n{datetime.date.today()}, commit {commit}, {os.cpu_count()} cores, mean load "
        f"{load:.1f}. `make bench-subdomains` writes this page.\n\n"
        + notes.replace("TABLE\n", table(lines) + "\n").replace("GOALS\n", goals(lines) + "\n"))


main()
