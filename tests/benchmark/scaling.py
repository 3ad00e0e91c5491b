#!/usr/bin/env python3
"""Scaling of the offline stage over ranks: 1, 2, 4, ... as many as the machine has cores.

Strong: one plate on all numbers of ranks. Weak: as many dofs on each rank. Wall seconds of each phase, efficiency, memory
of each rank, messages and reductions as PETSc counts them, and the projection of offline_projection.py beside what
was measured. Written: scaling.md and scaling.png. No test passes or fails by time. Measured elsewhere (makefiles/pack_program.sh):
lines of the program offline_stage, each with "cells" added, in a file for --rows.
"""
import argparse
import datetime
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import offline  # noqa: E402
import offline_projection  # noqa: E402

NOTES = "scaling_notes.md"
STRONG = 632        # elements along a plate of 1.2 million dofs
WEAK = [140, 316]   # 60 and 300 thousand dofs on each rank
GROUPS = {"mesh and partition": ["mesh", "partition"], "assembly": ["structure", "assembly"], "factorisation": ["factorisation"],
          "modes": ["modes"], "derivatives": ["derivatives"], "basis and projection": ["basis", "projection"], "file": ["file"]}


def rank_counts(cores):
    """1, 2, 4, ... up to the number of cores."""
    counts = [1]
    while 2 * counts[-1] <= cores:
        counts.append(2 * counts[-1])
    return counts


def wall(row, names=offline.PHASES):
    return sum(row[name][0] for name in names)


def efficiency(row, first, weak):
    """Strong: r t_r / (p t_p) of one size, r the fewest ranks. Weak: t_r / t_p, sizes grow with p."""
    return wall(first) / wall(row) / (1 if weak else row["ranks"] / first["ranks"])


def table_of(rows, weak):
    lines = ["| ranks | dofs | " + " | ".join(GROUPS) + " | total [s] | efficiency | memory per rank [GB] | messages per rank | "
             "sent per rank [MB] | reductions |", "|" + "---:|" * (len(GROUPS) + 8)]
    for row in rows:
        parts = " | ".join(f"{wall(row, names):.2f}" for names in GROUPS.values())
        traffic = row.get("messages") if row["ranks"] > 1 else None
        counts = (f"{traffic['count']} | {1e-6 * traffic['bytes']:.1f} | {traffic['reductions']}" if traffic else "- | - | -")
        lines.append(f"| {row['ranks']} | {row['dofs']} | {parts} | {wall(row):.2f} | {100 * efficiency(row, rows[0], weak):.0f} % | "
                     f"{row['memory'] / row['ranks'] / 1e9:.2f} | {counts} |")
    return "\n".join(lines)


def draw(series, model, path):
    """Efficiency versus ranks: measured, and dashed as projected."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, panels = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained", sharey=True)
    for panel, weak in zip(panels, (False, True)):
        for (name, rows, is_weak), colour in zip(series, offline.COLOURS):
            if is_weak != weak or not rows:
                continue
            ranks = [row["ranks"] for row in rows]
            panel.plot(ranks, [100 * efficiency(row, rows[0], weak) for row in rows], "o-", color=colour, label=name)
            if model:
                alone = sum(offline_projection.seconds(model, rows[0]["dofs"], 1)[:3])
                panel.plot(ranks, [100 * alone / sum(offline_projection.seconds(model, row["dofs"], row["ranks"])[:3])
                                   / (1 if weak else row["ranks"]) for row in rows], "--", color=colour, label=f"{name}, projected")
        panel.set_xscale("log", base=2)
        every = sorted({row["ranks"] for _, rows, _ in series for row in rows})
        panel.set_xticks(every, [str(p) for p in every])
        panel.set_xlabel("ranks")
        panel.set_title("weak scaling" if weak else "strong scaling", fontsize=10)
        panel.set_ylim(0, 110)
        panel.grid(alpha=0.3)
        panel.legend(fontsize=7, frameon=False)
    panels[0].set_ylabel("efficiency [%]")
    figure.savefig(path, dpi=130)


def commit():
    done = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    return done.stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stage", required=True, help="the program offline_stage")
    parser.add_argument("--out", required=True, help="folder to write to")
    parser.add_argument("--ranks", type=int, nargs="+", default=rank_counts(os.cpu_count()))
    parser.add_argument("--strong", type=int, nargs="*", default=[STRONG], help="elements along the plates of strong scaling")
    parser.add_argument("--weak", type=int, nargs="*", default=WEAK, help="the same on one rank, of weak scaling")
    parser.add_argument("--limit", type=float, default=600, help="seconds for each run")
    parser.add_argument("--rows", help="what was measured elsewhere; nothing is measured here")
    parser.add_argument("--machine", help="where and when, with --rows")
    args, options = parser.parse_known_args()
    known = {}
    if args.rows:
        with open(args.rows) as lines:
            known = {(row["cells"], row["ranks"]): row for row in map(json.loads, lines)}

    def row_of(cells, ranks):
        cells = 2 * round(cells / 2)
        if (cells, ranks) not in known and args.rows:
            return None
        if (cells, ranks) not in known:
            known[cells, ranks] = offline.run(args.stage, cells, ranks, options, args.limit)
            if known[cells, ranks]:
                print(offline.table_of([known[cells, ranks]]).splitlines()[-1], flush=True)
        return known[cells, ranks]

    series = []
    for weak, sizes in ((True, args.weak), (False, args.strong)):
        for cells in sizes:
            rows = [row for p in args.ranks if (row := row_of(cells * p**0.5 if weak else cells, p))]
            if len(rows) > 1:
                name = f"{rows[0]['dofs'] / 1000:.0f} thousand dofs" + (" per rank" if weak else "")
                series.append((name, rows, weak))
    alone = [row for row in known.values() if row and row["ranks"] == 1 and offline.BARE[0] in row]
    model = offline_projection.model_of(alone) if len(alone) > 1 else None
    os.makedirs(args.out, exist_ok=True)
    draw(series, model, os.path.join(args.out, "scaling.png"))
    parts = {weak: "\n\n".join(f"{name[0].upper()}{name[1:]}:\n\n{table_of(rows, weak)}" for name, rows, is_weak in series
                               if is_weak == weak) for weak in (False, True)}
    machine = args.machine or (f"{datetime.date.today()}, commit {commit()}, {offline.processor()}, {os.cpu_count()} cores, "
                               f"mean load {os.getloadavg()[2]:.1f}; {offline.packages()}")
    with open(os.path.join(os.path.dirname(__file__), NOTES)) as notes:
        text = notes.read()
    with open(os.path.join(args.out, "scaling.md"), "w") as out:
        out.write(text.format(machine=machine, strong=parts[False], weak=parts[True]))


if __name__ == "__main__":
    main()
