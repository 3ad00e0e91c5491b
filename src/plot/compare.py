#!/usr/bin/env python3
"""Draws the formulations of one scene above each other: a panel per probe component, and their errors relative to the reference.

DIR/compare.json names the runs, the probes and the reference; each run's series is the CSV file that floe wrote.
"""
import argparse
import math
import os
import sys

sys.dont_write_bytecode = True
from style import COLOURS, DASHES, Fault, guarded, pyplot, read_json, read_series, save, span, with_unit  # noqa: E402

PANEL_HEIGHT, WIDTH = 2.1, 7.6  # inches


def interpolated(times, values, at):
    """Linear between samples; NaN outside them."""
    found, i = [], 0
    for t in at:
        if t < times[0] or t > times[-1]:
            found.append(math.nan)
            continue
        while i + 2 < len(times) and times[i + 1] < t:
            i += 1
        if len(times) == 1:
            found.append(values[0])
            continue
        step = times[i + 1] - times[i]
        share = (t - times[i]) / step if step > 0 else 1.0
        found.append(values[i] + share * (values[i + 1] - values[i]))
    return found


def load(folder):
    """The description with each run's series read into run["series"], everything that it names checked."""
    description = read_json(os.path.join(folder, "compare.json"))
    try:
        runs = description["runs"]
        probes = [probe["column"] for probe in description["probes"]]
        for run in runs:
            run["series"] = read_series(os.path.join(folder, run["csv"]))
            run.setdefault("label", run["name"])
    except (KeyError, TypeError) as error:
        raise Fault(f"{os.path.join(folder, 'compare.json')}: has no {error}") from error
    if not runs or not probes:
        raise Fault(f"{os.path.join(folder, 'compare.json')}: no runs or no probes")
    for run in runs:
        for probe in probes:
            if probe not in run["series"]:
                raise Fault(f"{os.path.join(folder, run['csv'])}: no column '{probe}'")
    reference = description.get("reference")
    if reference is not None and reference not in [run["name"] for run in runs]:
        raise Fault(f"{os.path.join(folder, 'compare.json')}: reference '{reference}' is none of the runs")
    return description


def give_styles(description):
    """Reference: black, solid, broad and behind the others; each other run a colour and a dash of its own."""
    count = 0
    for run in description["runs"]:
        if run["name"] == description.get("reference"):
            run["line"] = {"color": "black", "linewidth": 2.6, "zorder": 2}
        else:
            run["line"] = {"color": COLOURS[count % len(COLOURS)], "linewidth": 1.4, "zorder": 3 + count}
            dashes = DASHES[(count + 1 + count // len(COLOURS)) % len(DASHES)]
            if dashes:
                run["line"]["dashes"] = dashes
            count += 1
        run["line"].update(run.get("style") or {})


def value_range(description, column):
    """Of the reference where there is one, half its span wider: a formulation that diverges does not flatten the others."""
    runs = description["runs"]
    shown = [run for run in runs if run["name"] == description.get("reference")] or runs
    values = [value for run in shown for value in run["series"][column] if math.isfinite(value)]
    every = [value for run in runs for value in run["series"][column] if math.isfinite(value)]
    if not values or min(values) == max(values):
        return None
    wide = span(values)
    low, high = max(min(every), min(values) - 0.5 * wide), min(max(every), max(values) + 0.5 * wide)
    return low - 0.06 * wide, high + 0.06 * wide


def draw_values(axes, description, probe):
    for run in description["runs"]:
        axes.plot(run["series"]["t"], run["series"][probe["column"]], label=run["label"], **run["line"])
    limits = value_range(description, probe["column"])
    if limits:
        axes.set_ylim(*limits)
    axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
    axes.set_ylabel(with_unit(probe["column"], probe.get("unit", "")))


def components(description, probe):
    """Columns of the probe that a column belongs to: `tip.x`, `tip.y`."""
    name = probe["column"].rpartition(".")[0]
    return [p["column"] for p in description["probes"] if name and p["column"].rpartition(".")[0] == name
            and p.get("unit", "") == probe.get("unit", "")] or [probe["column"]]


def moving(description):
    """Components worth a panel: those that move in the reference, by at least a thousandth of their probe's maximum."""
    name = description.get("reference") or description["runs"][0]["name"]
    series = next(run["series"] for run in description["runs"] if run["name"] == name)
    shown = [probe for probe in description["probes"]
             if span(series[probe["column"]]) > 1e-3 * max(span(series[c]) for c in components(description, probe))]
    return shown or description["probes"]


def draw_errors(axes, description, probe):
    """|p - p_ref|, a vector's length, at the times of each run; the axis shows the good runs whole and cuts one that diverges."""
    runs = {run["name"]: run for run in description["runs"]}
    reference = runs[description["reference"]]
    columns, medians, greatest = components(description, probe), [], 0.0
    for name, run in runs.items():
        if name == description["reference"]:
            continue
        times, squares = run["series"]["t"], [0.0] * len(run["series"]["t"])
        for column in columns:
            exact = interpolated(reference["series"]["t"], reference["series"][column], times)
            gaps = (value - other for value, other in zip(run["series"][column], exact))
            squares = [square + gap * gap for square, gap in zip(squares, gaps)]
        errors = [math.sqrt(square) if square > 0 and math.isfinite(square) else math.nan for square in squares]
        known = sorted(error for error in errors if error > 0)
        if known:
            medians.append(known[len(known) // 2])
            greatest = max(greatest, known[-1])
        axes.plot(times, errors, **run["line"])
    axes.set_yscale("log")
    if medians:
        widest = max(span(reference["series"][column]) for column in columns)
        high = min(2 * greatest, 10 * widest or math.inf)
        axes.set_ylim(max(min(medians) / 100, 1e-12 * high), high)
    what = columns[0].rpartition(".")[0] if len(columns) > 1 else probe["column"]
    axes.set_ylabel(f"error of {with_unit(what, probe.get('unit', ''))}\nagainst {reference['label']}")


def place_legend(figure, axes):
    """Above the panels, in as many columns as fit; returns the height of title and legend [inches]."""
    handles, labels = axes.get_legend_handles_labels()
    for columns in (3, 2, 1):
        legend = figure.legend(handles, labels, loc="upper center", ncol=columns, frameon=False, handlelength=4,
                               bbox_to_anchor=(0.5, 1 - 0.28 / figure.get_figheight()))
        legend.set_in_layout(False)
        extent = legend.get_window_extent(figure.canvas.get_renderer())
        if extent.width < 0.98 * figure.bbox.width or columns == 1:
            return 0.28 + extent.height / figure.dpi
        legend.remove()


def draw(description, path, dpi):
    plt = pyplot()
    give_styles(description)
    probes = moving(description)
    main = main_probe(description)
    with_errors = description.get("reference") is not None and len(description["runs"]) > 1
    panels = len(probes) + with_errors
    figure, axes = plt.subplots(panels, 1, sharex=True, squeeze=False, figsize=(WIDTH, PANEL_HEIGHT * panels + 1))
    axes = axes[:, 0]
    for panel, probe in zip(axes, probes):
        draw_values(panel, description, probe)
    if with_errors:
        draw_errors(axes[-1], description, main)
    axes[-1].set_xlabel(with_unit("time", description.get("time_unit", "s")))
    axes[-1].set_xlim(min(run["series"]["t"][0] for run in description["runs"]),
                      max(run["series"]["t"][-1] for run in description["runs"]))
    figure.align_ylabels(axes)
    height = figure.get_figheight()
    figure.suptitle(description.get("title", ""), y=1 - 0.08 / height, va="top", fontsize=11).set_in_layout(False)
    head = place_legend(figure, axes[0])
    figure.tight_layout(rect=(0, 0, 1, 1 - head / height))
    save(figure, path, dpi)


def main_probe(description):
    """The one that moves most in the reference: its error is shown."""
    name = description.get("reference") or description["runs"][0]["name"]
    series = next(run["series"] for run in description["runs"] if run["name"] == name)
    return max(description["probes"], key=lambda probe: span(series[probe["column"]]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="folder written by floe compare: compare.json and its runs")
    parser.add_argument("-o", "--output", help="picture: .png, .svg or .pdf (default: compare.png in the folder)")
    parser.add_argument("--dpi", type=int, default=150, help="of a PNG (default: 150)")
    arguments = parser.parse_args()
    path = arguments.output or os.path.join(arguments.folder, "compare.png")
    if os.path.splitext(path)[1] not in (".png", ".svg", ".pdf"):
        raise Fault(f"{path}: a picture ends in .png, .svg or .pdf")
    if arguments.dpi < 1:
        raise Fault(f"--dpi {arguments.dpi}: must be positive")
    draw(load(arguments.folder), path, arguments.dpi)


if __name__ == "__main__":
    sys.exit(guarded("compare", main))
