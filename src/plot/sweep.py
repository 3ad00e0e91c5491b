#!/usr/bin/env python3
"""Draws a sweep: the maximum absolute value of each probe versus the first varied number, a line for each of the others.

DIR/sweep.csv has a row for each member; members that failed are marked at the bottom.
"""
import csv
import json
import os
import sys

sys.dont_write_bytecode = True
from style import COLOURS, MARKS, Fault, guarded, pyplot, save  # noqa: E402

PANEL_HEIGHT, WIDTH, MOST_LINES = 2.1, 7.6, 12  # inches
ROUND_OFF = 1e-9


def load(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    with open(os.path.join(folder, "sweep.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    scene = summary.get("scene", {})
    return [varied["path"] for varied in summary["varied"]], rows, scene.get("title") or scene.get("file", "")


def drawn(rows, columns):
    """Without components that are round-off beside the others of their probe."""
    greatest = {column: max((abs(float(row[column])) for row in rows if row[column]), default=0) for column in columns}
    probe = {column: column.rsplit(".", 1)[0] for column in columns}
    of_probe = {}
    for column in columns:
        of_probe[probe[column]] = max(of_probe.get(probe[column], 0), greatest[column])
    return [column for column in columns if greatest[column] > ROUND_OFF * of_probe[probe[column]] or of_probe[probe[column]] == 0]


def label(row, paths):
    return ", ".join(f"{path} = {float(row[path]):.4g}" for path in paths)


def draw(folder, path, dpi):
    paths, rows, title = load(folder)
    columns = [name for name in rows[0] if name and name.startswith("greatest ")] if rows else []
    if not columns:
        raise Fault(f"{folder}: no members")
    columns = drawn(rows, columns)
    figure, panels = pyplot().subplots(len(columns), 1, sharex=True, squeeze=False, layout="constrained",
                                     figsize=(WIDTH, 0.7 + PANEL_HEIGHT * len(columns)))
    lines = {}
    for row in rows:
        lines.setdefault(label(row, paths[1:]), []).append(row)
    for panel, column in zip(panels[:, 0], columns):
        for i, (name, members) in enumerate(lines.items()):
            points = sorted((float(m[paths[0]]), float(m[column])) for m in members if m[column])
            panel.plot([p[0] for p in points], [p[1] for p in points], color=COLOURS[i % len(COLOURS)],
                       marker=MARKS[i // len(COLOURS) % len(MARKS)], markersize=4 if len(points) < 60 else 0,
                       linewidth=1.4, label=name if i < MOST_LINES else None)
        failed = [float(row[paths[0]]) for row in rows if row["failed"] == "1"]
        if failed:
            panel.plot(failed, [0.02] * len(failed), "kx", transform=panel.get_xaxis_transform(), label="failed")
        quantity, unit = column[len("greatest "):].rsplit(" [", 1)
        panel.set_ylabel(f"max |{quantity}| [{unit}")
    panels[-1, 0].set_xlabel(paths[0])
    if len(lines) > 1 or failed:
        panels[0, 0].legend(fontsize="small", frameon=False, ncols=2)
    figure.suptitle(title, fontsize=11)
    save(figure, path, dpi)


if __name__ == "__main__":
    sys.exit(guarded("sweep", lambda: draw(sys.argv[1], os.path.join(sys.argv[1], "sweep.png"), 150)))
