#!/usr/bin/env python3
"""Times the offline stage, from mesh to reduced body, relative to the linear algebra alone, on growing plates; relative to
CalculiX; on one and two ranks; and projects the cost on many.

Every ratio is of two numbers of one run. Processor seconds on one rank, which do not depend on the load of the
machine; wall seconds on several. Written: offline.md (tables) and offline.png. No test passes or fails by time.
Runs longer than --limit are stopped and reported as missing. --small omits 1.2 million dofs and CalculiX' largest model.
"""
import argparse
import datetime
import json
import os
import platform
import subprocess
import sys

sys.dont_write_bytecode = True
import calculix  # noqa: E402
import offline_projection  # noqa: E402

NOTES = "offline_notes.md"
CELLS = [44, 140, 316, 632]  # 6 thousand, 60 thousand, 300 thousand and 1.2 million dofs
COMPARED = [44, 140, 316]    # with CalculiX
DOUBLED = {44: 62, 140: 198, 316: 446}  # cells along of a plate with twice as many dofs, for two ranks
PHASES = ["mesh", "partition", "structure", "assembly", "factorisation", "modes", "derivatives", "basis", "projection", "file"]
BARE = ["bare factorisation", "bare single solves", "bare block solve"]
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999", "#000000", "#888888"]


def run(stage, cells, ranks, options, limit):
    """The line of JSON that the program writes, or None where it takes too long. Ranks that
    wait yield the processor only where they are more than processors: MUMPS asks for messages all the time, on one rank too,
    and each yield on a busy machine costs what others take."""
    command = ["mpirun", "-n", str(ranks), stage, "-cells", str(cells), *options]
    environment = dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1" if ranks > os.cpu_count() else "0")
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=limit)
    except subprocess.TimeoutExpired:
        print(f"{cells} cells on {ranks} ranks: ended after {limit} s", flush=True)
        return None
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    row = json.loads(done.stdout.strip().splitlines()[-1])
    row["cells"] = cells
    return row


def seconds(row, names):
    """Processor seconds on one rank, wall seconds on several."""
    return sum(row[name][1 if row["ranks"] == 1 else 0] for name in names)


def table_of(rows):
    lines = ["| dofs | ranks | " + " | ".join(PHASES) + " | total | T_ref | total / T_ref | GB per million dofs |",
             "|" + "---:|" * (len(PHASES) + 6)]
    for row in rows:
        total, bare = seconds(row, PHASES), seconds(row, BARE)
        parts = " | ".join(f"{seconds(row, [name]):.2f}" for name in PHASES)
        lines.append(f"| {row['dofs']} | {row['ranks']} | {parts} | {total:.2f} | {bare:.2f} | {total / bare:.2f} | "
                     f"{row['memory'] / row['dofs'] / 1e3:.2f} |")
    return "\n".join(lines)


def growth_of(rows):
    """Exponents of time per dof between neighbouring sizes on one rank."""
    from math import log
    alone = [row for row in rows if row["ranks"] == 1]
    lines = []
    for a, b in zip(alone, alone[1:]):
        per_dof = [seconds(row, PHASES) / row["dofs"] for row in (a, b)]
        exponent = log(per_dof[1] / per_dof[0]) / log(b["dofs"] / a["dofs"])
        lines.append(f"From {a['dofs']} to {b['dofs']} dofs time per dof grows as n^{exponent:.2f}.")
    return "\n".join(lines)


def speedups_of(rows):
    """Rows of two ranks over those of one rank with the same dofs."""
    lines = ["| dofs | factorisation + modes | blocked solves, PETSc's own | blocked solves, floe's |", "|---:|---:|---:|---:|"]
    for row in rows:
        single = [r for r in rows if r["ranks"] == 1 and r["dofs"] == row["dofs"]]
        if row["ranks"] != 2 or not single:
            continue
        alone = single[0]
        block = alone["bare block solve"][0]
        gain = sum(alone[n][0] for n in ("factorisation", "modes")) / sum(row[n][0] for n in ("factorisation", "modes"))
        lines.append(f"| {row['dofs']} | {gain:.2f} | {block / row['bare block solve'][0]:.2f} | {block / row['block solve'][0]:.2f} |")
    return "\n".join(lines)


def weak_of(rows):
    """One rank, and two with twice as many dofs: wall seconds."""
    groups = {"factorisation": ["factorisation"], "modes": ["modes"], "derivatives": ["derivatives"],
              "basis and projection": ["basis", "projection"], "total": PHASES}
    lines = ["| dofs | ranks | " + " | ".join(groups) + " | time / that of one rank |", "|" + "---:|" * (len(groups) + 3)]
    for cells, double in DOUBLED.items():
        pair = [next((r for r in rows if r["cells"] == c and r["ranks"] == n), None) for c, n in ((cells, 1), (double, 2))]
        if None in pair:
            continue
        sums = [{name: sum(row[n][0] for n in names) for name, names in groups.items()} for row in pair]
        for row, wall in zip(pair, sums):
            parts = " | ".join(f"{wall[name]:.2f}" for name in groups)
            lines.append(f"| {row['dofs']} | {row['ranks']} | {parts} | {wall['total'] / sums[0]['total']:.2f} |")
    return "\n".join(lines)


def draw(rows, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    alone = [row for row in rows if row["ranks"] == 1]
    figure, axes = pyplot.subplots(figsize=(7, 4))
    bottom = [0.0] * len(alone)
    for name, colour in zip(PHASES, COLOURS):
        share = [seconds(row, [name]) / seconds(row, BARE) for row in alone]
        axes.bar([str(row["dofs"]) for row in alone], share, bottom=bottom, color=colour, label=name)
        bottom = [a + b for a, b in zip(bottom, share)]
    axes.axhline(1, color="black", linewidth=1)
    axes.set_xlabel("dofs")
    axes.set_ylabel("time / T_ref")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def packages():
    """Versions of what the time goes to."""
    names = ["libpetsc-real3.18", "libslepc-real3.18", "libmumps-5.5", "libopenblas0-serial", "libopenmpi3"]
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}, ", *names], capture_output=True, text=True)
    return done.stdout.rstrip(", ")


def processor():
    with open("/proc/cpuinfo") as info:
        names = [line.split(":")[1].strip() for line in info if line.startswith("model name")]
    return names[0] if names else platform.machine()


def measured(args, options):
    """Rows of the stage, and of the comparison with CalculiX."""
    rows, compared = [], []

    def add(cells, ranks):
        row = run(args.stage, cells, ranks, options, args.limit)
        if row:
            rows.append(row)
            print(table_of([row]).splitlines()[-1], flush=True)

    for cells in args.cells:
        for ranks in args.ranks:
            if ranks == 1 or cells <= args.most_for_ranks:
                add(cells, ranks)
                if ranks == 2 and cells in DOUBLED:
                    add(DOUBLED[cells], 2)
    for cells in args.compared if args.floe else []:
        row = calculix.compare(args.floe, cells, limit=args.limit)
        if row:
            compared.append(row)
            print(calculix.table_of([row]).splitlines()[-1], flush=True)
    return rows, compared


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stage", required=True, help="the program offline_stage")
    parser.add_argument("--floe", help="the program floe, to be compared with CalculiX")
    parser.add_argument("--out", required=True, help="folder to write to")
    parser.add_argument("--cells", type=int, nargs="*", default=CELLS, help="elements along the plate")
    parser.add_argument("--compared", type=int, nargs="*", default=COMPARED, help="the same, for CalculiX")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--most-for-ranks", type=int, default=316, help="maximum of elements along the plate for several ranks")
    parser.add_argument("--limit", type=float, default=300, help="seconds for each run")
    parser.add_argument("--small", action="store_true", help="up to 60 thousand dofs")
    args, options = parser.parse_known_args()
    if args.small:
        args.cells, args.compared = [c for c in args.cells if c <= 140], [c for c in args.compared if c <= 140]
    rows, compared = measured(args, options)
    os.makedirs(args.out, exist_ok=True)
    draw(rows, os.path.join(args.out, "offline.png"))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    with open(os.path.join(os.path.dirname(__file__), NOTES)) as notes:
        text = notes.read()
    table = table_of([row for row in rows if row["cells"] in args.cells])
    with open(os.path.join(args.out, "offline.md"), "w") as out:
        out.write(text.format(date=datetime.date.today(), commit=commit, machine=processor(), packages=packages(),
                              cores=os.cpu_count(), load=f"{os.getloadavg()[2]:.1f}", table=table,
                              growth=growth_of(rows), speedups=speedups_of(rows), weak=weak_of(rows),
                              calculix=calculix.table_of(compared), projection=offline_projection.section(rows)))


if __name__ == "__main__":
    main()
