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
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    notes = (pathlib.Path(__file__).parent / NOTES).read_text()
    (arguments.out / "subdomains.md").write_text(
        f"# Domain decomposition\n\n{datetime.date.today()}, commit {commit}, {os.cpu_count()} cores, mean load "
        f"{os.getloadavg()[2]:.1f}. `make bench-subdomains` writes this page.\n\n"
        + notes.replace("TABLE\n", table(lines) + "\n"))


main()
