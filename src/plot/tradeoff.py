#!/usr/bin/env python3
"""Draws error versus computing time for the models of one scene: the Pareto front, and the model selected for an accuracy.

DIR/tradeoff.json is written by floe tradeoff. Time is that of the simulation; the error is the maximum over the probes.
"""
import argparse
import math
import os
import sys

sys.dont_write_bytecode = True
from style import COLOURS, MARKS, Fault, duration, guarded, per_cent, pyplot, read_json, save  # noqa: E402

WIDTH, HEIGHT = 7.6, 4.4  # inches, of the diagram; the key of the front comes below
LINE = 0.19


def worst(rung):
    """Maximum error of the probes; None where the model stopped or has no number."""
    errors = rung["rms"]
    if rung["stopped"] or not errors or any(error is None for error in errors):
        return None
    return max(errors)


def load(folder):
    path = os.path.join(folder, "tradeoff.json")
    description = read_json(path)
    try:
        for rung in description["rungs"]:
            rung["error"] = worst(rung)
        description["front"] = [description["rungs"][i] for i in description["pareto_front"]]
        description["chosen"] = description["rungs"][description["choice"]] if "choice" in description else None
        shown = [rung for rung in description["rungs"] if rung["error"] and rung["motion"] > 0]
    except (KeyError, TypeError, IndexError) as error:
        raise Fault(f"{path}: has no {error}") from error
    if not shown:
        raise Fault(f"{path}: no model reached the end of its simulation")
    return description, shown


def key_lines(description):
    lines = []
    for number, rung in enumerate(description["front"], start=1):
        words = f"{number}  {rung['name']} ({rung['formulation']}): {per_cent(rung['error'])}, {duration(rung['motion'])}"
        if rung is description["chosen"]:
            words += f"   ← selected for {per_cent(description['accuracy'])}"
        lines.append(words)
    stopped = [rung for rung in description["rungs"] if rung["error"] is None]
    lines += [f"–  {rung['name']} ({rung['formulation']}): {rung['stopped'] or 'no number'}"[:118] for rung in stopped]
    return lines


def copy_of_size(line, size):
    from matplotlib.lines import Line2D
    copy = Line2D([], [])
    copy.update_from(line)
    copy.set_markersize(size)
    return copy


def draw(description, shown, path, dpi):
    plt = pyplot()
    lines = key_lines(description)
    below = LINE * (len(lines) + 1.4)
    figure = plt.figure(figsize=(WIDTH, HEIGHT + below))
    whole = HEIGHT + below
    axes = figure.add_axes([0.09, (below + 0.5) / whole, 0.64, (HEIGHT - 0.95) / whole])
    axes.set_xscale("log")
    axes.set_yscale("log")
    front = description["front"]
    axes.plot([r["motion"] for r in front], [100 * r["error"] for r in front], color="black", linewidth=1.2, zorder=2,
              label="Pareto front")
    for i, family in enumerate(dict.fromkeys(rung["family"] for rung in shown)):
        members = [rung for rung in shown if rung["family"] == family]
        chosen_by_floe = family == "accuracy"
        axes.plot([r["motion"] for r in members], [100 * r["error"] for r in members], linestyle="none",
                  marker="o" if chosen_by_floe else MARKS[i % len(MARKS)], markersize=7,
                  color="black" if chosen_by_floe else COLOURS[i % len(COLOURS)],
                  markeredgecolor="white", markeredgewidth=0.6, zorder=3,
                  label="selected by floe" if chosen_by_floe else family)
    chosen = description["chosen"]
    if chosen:
        axes.plot(chosen["motion"], 100 * chosen["error"], linestyle="none", marker="o", markersize=15,
                  markerfacecolor="none", markeredgecolor="black", markeredgewidth=1.4, zorder=4, label="selected")
    reference = description["reference"]
    axes.axvline(reference["motion"], color="0.35", linestyle=(0, (6, 2)), linewidth=1.1,
                 label=f"{reference['name']}: {duration(reference['motion'])}")
    own = worst(description["reference_itself"]) if "reference_itself" in description else None
    if own:
        axes.axhline(100 * own, color="0.35", linestyle=(0, (1, 1.5)), linewidth=1.2,
                     label=f"error of its mesh: {per_cent(own)}")
    for number, rung in enumerate(front, start=1):  # below and left of the front there is nothing else
        axes.annotate(str(number), (rung["motion"], 100 * rung["error"]), xytext=(-6, -6), textcoords="offset points",
                      ha="right", va="top", fontsize=8, fontweight="bold")
    axes.margins(0.1)
    axes.set_xlabel("computing time of the simulation [s]")
    axes.set_ylabel("maximum relative error of the probes [%]")
    handles, labels = axes.get_legend_handles_labels()
    handles = [copy_of_size(handle, 9) if label == "selected" else handle for handle, label in zip(handles, labels)]
    figure.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.745, (below + HEIGHT - 0.42) / whole),
                  frameon=False, fontsize=8, handlelength=2.2)
    figure.text(0.5, 1 - 0.1 / whole, description.get("title", ""), ha="center", va="top", fontsize=11)
    for i, words in enumerate(lines):
        figure.text(0.03, (below - 0.1 - LINE * (i + 1)) / whole, words, fontsize=8, va="bottom",
                    fontweight="bold" if chosen and "← selected" in words else "normal")
    save(figure, path, dpi, 256)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="folder written by floe tradeoff")
    parser.add_argument("-o", "--output", help="picture (default: tradeoff.png in the folder)")
    parser.add_argument("--dpi", type=int, default=150)
    arguments = parser.parse_args()
    path = arguments.output or os.path.join(arguments.folder, "tradeoff.png")
    if arguments.dpi < 1:
        raise Fault(f"--dpi {arguments.dpi}: must be positive")
    draw(*load(arguments.folder), path, arguments.dpi)


if __name__ == "__main__":
    sys.exit(guarded("tradeoff", main))
