#!/usr/bin/env python3
"""Draws total error versus computing time for the models of one scene, the Pareto front, and the models selected by accuracy.

DIR/tradeoff.json is written by floe tradeoff. Time is that of the simulation; the error is the maximum over the probes.
"""
import argparse
import os
import sys

sys.dont_write_bytecode = True
from style import COLOURS, Fault, duration, guarded, per_cent, pyplot, read_json, save  # noqa: E402

WIDTH, HEIGHT = 8.2, 4.9  # inches, of the diagram; the key of the front comes below
LINE = 0.19
LABEL = 80, 12  # points: width and height of a label
NEAR = 11  # points: numbers of the front that are closer are written together

# Groups of the legend: marker, its size, colour (Okabe and Ito), families of models.
GROUPS = {"the scene's own model": ("*", 13, COLOURS[0], ("scene",)),
          "modes only, rigid": ("^", 6.5, COLOURS[5], ("rigid", "modes")),
          "modes and derivatives": ("D", 5.5, COLOURS[1], ("modes and derivatives", "attachment modes", "elastic force")),
          "with residual responses": ("h", 6.5, "#332288", ("residual responses",)),
          "reduced, other frames": ("v", 6.5, COLOURS[3], ("frames",)),
          "reduced, other mesh or strains": ("P", 7, COLOURS[4], ("mesh", "strains")),
          "reduced, other step": ("X", 6.5, COLOURS[2], ("step", "integrator")),
          "full order: nlffr, lffr": ("p", 7, COLOURS[6], ("full order",)),
          "full order: cfr": ("s", 6.5, COLOURS[0], ("cfr",)),
          "selected by accuracy": ("o", 10, "black", ("accuracy",))}


def worst(variant):
    """Maximum error of the probes; None where the model stopped or has no number."""
    errors = variant["total"]
    if variant["stopped"] or not errors or any(error is None for error in errors):
        return None
    return max(errors)


def load(folder):
    path = os.path.join(folder, "tradeoff.json")
    description = read_json(path)
    try:
        for variant in description["variants"]:
            variant["error"] = worst(variant)
        description["front"] = [description["variants"][i] for i in description["pareto_front"]]
        shown = [variant for variant in description["variants"] if variant["error"] and variant["motion"] > 0]
        description["reference"]["error"], description["reference"]["words"]  # pylint: disable=pointless-statement
    except (KeyError, TypeError, IndexError) as error:
        raise Fault(f"{path}: has no {error}") from error
    if not shown:
        raise Fault(f"{path}: no model reached the end of its simulation")
    return description, shown


def title_of(variant):
    """`selected for 1 %`: and what was selected."""
    name = variant["name"] if variant["name"].startswith(variant["formulation"]) else f"{variant['name']} ({variant['formulation']})"
    return f"{name}: {variant['selected']}" if variant.get("selected") else name


def key_lines(description):
    lines = []
    for number, variant in enumerate(description["front"], start=1):
        words = f"{title_of(variant)}: {per_cent(variant['error'])}, {duration(variant['motion'])}"
        lines.append((f"{number:>2}  {shortened(words, 124)}", bool(variant.get("required"))))
    stopped = [variant for variant in description["variants"] if variant["error"] is None]
    lines += [(shortened(f" –  {title_of(variant)}: {variant['stopped'] or 'no number'}", 124), False)
              for variant in stopped]
    return lines


def shortened(words, most):
    return words if len(words) <= most else words[:most - 1] + "…"


def draw_models(axes, shown):
    """Each group in its own mark; those of the selected models are black, and lie above the others."""
    for group, (marker, size, colour, families) in GROUPS.items():
        members = [variant for variant in shown if variant["family"] in families]
        if members:
            axes.plot([r["motion"] for r in members], [100 * r["error"] for r in members], linestyle="none", marker=marker,
                      markersize=size, color=colour, markeredgecolor="white", markeredgewidth=0.6,
                      zorder=3 + (size > 9), label=group)


def draw_front(axes, front):
    """The line, and the numbers of the key: those of neighbours together. Below and left of the front there is nothing else."""
    points = [(r["motion"], 100 * r["error"]) for r in front]
    axes.plot(*zip(*points), color="black", linewidth=1.3, zorder=2, label="Pareto front")
    places = axes.transData.transform(points) * 72 / axes.figure.dpi
    groups = []
    for i, place in enumerate(places):
        if front[i].get("required"):
            continue
        if groups and groups[-1][-1] == i - 1 and max(abs(place - places[i - 1])) < NEAR:
            groups[-1].append(i)
        else:
            groups.append([i])
    for group in groups:
        text = f"{group[0] + 1}" if len(group) == 1 else f"{group[0] + 1}–{group[-1] + 1}"
        write_below(axes, text, points[group[len(group) // 2]], "normal")


def draw_selected(axes, shown, front):
    """Each with its label, and its number on the front; labels that would lie on one another are written as one."""
    selected = sorted((variant for variant in shown if variant.get("required")), key=lambda one: one["motion"])
    places = [axes.transData.transform((one["motion"], 100 * one["error"])) * 72 / axes.figure.dpi for one in selected]
    groups = []
    for one, place in zip(selected, places):
        near = next((group for group in groups if all(abs(place - group["place"]) < LABEL)), None)
        if near:
            near["members"].append(one)
        else:
            groups.append({"place": place, "members": [one]})
    for group in groups:
        members = sorted(group["members"], key=lambda one: -one["required"])
        numbers = sorted(front.index(one) + 1 for one in members if one in front)
        words = ", ".join(per_cent(one["required"]) for one in members)
        lowest = min(members, key=lambda one: (one["motion"], one["error"]))
        write_below(axes, f"{', '.join(map(str, numbers))}{'  ' if numbers else ''}accuracy: {words}",
                    (lowest["motion"], 100 * lowest["error"]), "bold")


def write_below(axes, text, at, weight):
    axes.annotate(text, at, xytext=(-6, -6), textcoords="offset points", ha="right", va="top", fontsize=8,
                  fontweight=weight, zorder=7, bbox={"boxstyle": "round,pad=0.05", "fc": "white", "ec": "none", "alpha": 0.7})


def draw(description, shown, path, dpi):
    plt = pyplot()
    lines = key_lines(description)
    below = LINE * (len(lines) + 2.4)
    whole = HEIGHT + below
    figure = plt.figure(figsize=(WIDTH, whole))
    axes = figure.add_axes([0.085, (below + 0.5) / whole, 0.62, (HEIGHT - 0.95) / whole])
    axes.set_xscale("log")
    axes.set_yscale("log")
    times, errors = [r["motion"] for r in shown], [100 * r["error"] for r in shown]
    axes.set_xlim(min(times) / 16, max(times) * 1.6)
    axes.set_ylim(max(min(errors) / 5, 1e-7), min(max(errors) * 2, 300))
    draw_models(axes, shown)
    draw_front(axes, description["front"])
    draw_selected(axes, shown, description["front"])
    reference = description["reference"]
    own = reference["error"]
    if own and 100 * own > axes.get_ylim()[0]:
        axes.axhspan(axes.get_ylim()[0], 100 * own, color="0.9", zorder=0, label=f"error of the reference: {per_cent(own)}")
    axes.set_xlabel("computing time of the simulation [s]")
    axes.set_ylabel("total error, maximum of the probes [%]")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.715, (below + HEIGHT - 0.42) / whole),
                  frameon=False, fontsize=8, handlelength=2.2)
    figure.text(0.5, 1 - 0.1 / whole, description.get("title", ""), ha="center", va="top", fontsize=11)
    figure.text(0.03, (below - 0.1 - LINE) / whole, f"Reference: {reference['words']}. Pareto front:", fontsize=8,
                va="bottom", style="italic")
    for i, (words, bold) in enumerate(lines):
        figure.text(0.03, (below - 0.1 - LINE * (i + 2)) / whole, words, fontsize=8, va="bottom",
                    fontweight="bold" if bold else "normal")
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
