#!/usr/bin/env python3
"""Draws the formulations of one scene: for each probe its size versus time, and beside it the error relative to the reference;
with components a panel for each of them.

DIR/compare.json names the runs, the probes and the reference; each run's series is the CSV file that floe wrote.
"""
import argparse
import math
import os
import sys

sys.dont_write_bytecode = True
from style import COLOURS, DASHES, Fault, guarded, pyplot, read_json, read_series, save, span, with_unit  # noqa: E402

PANEL_HEIGHT, WIDTH, BOTH, MOST_PROBES = 2.1, 7.6, 10.4, 12  # inches


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


def value_range(description, values_of):
    """Of the reference where there is one, half its span wider: a formulation that diverges does not flatten the others."""
    runs = description["runs"]
    shown = [run for run in runs if run["name"] == description.get("reference")] or runs
    values = [value for run in shown for value in values_of(run) if math.isfinite(value)]
    every = [value for run in runs for value in values_of(run) if math.isfinite(value)]
    if not values or min(values) == max(values):
        return None
    wide = span(values)
    low, high = max(min(every), min(values) - 0.5 * wide), min(max(every), max(values) + 0.5 * wide)
    return low - 0.06 * wide, high + 0.06 * wide


def draw_values(axes, description, columns, name, unit):
    """Of one column its values, of several the length of the vector."""
    def values_of(run):
        series = [run["series"][column] for column in columns]
        return series[0] if len(series) == 1 else [math.hypot(*at) for at in zip(*series)]

    for run in description["runs"]:
        axes.plot(run["series"]["t"], values_of(run), label=run["label"], **run["line"])
    limits = value_range(description, values_of)
    if limits:
        axes.set_ylim(*limits)
    axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
    axes.set_ylabel(with_unit(name if len(columns) == 1 else f"|{name}|", unit))


def name_of(columns):
    """Of a probe: `tip` of `tip.x`, `tip.y`; a probe of one column by itself."""
    return columns[0].rpartition(".")[0] or columns[0] if len(columns) > 1 else columns[0]


def probes_of(description):
    """Columns and unit of each probe, in their order."""
    found = {}
    for probe in description["probes"]:
        columns = components(description, probe)
        found.setdefault(tuple(columns), probe.get("unit", ""))
    return list(found.items())


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


def draw_errors(axes, description, columns, unit):
    """|p - p_ref|, a vector's length, at the times of each run; the axis shows the good runs whole and cuts one that diverges."""
    runs = {run["name"]: run for run in description["runs"]}
    reference = runs[description["reference"]]
    medians, greatest = [], 0.0
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
    axes.set_ylabel(f"error of {with_unit(name_of(columns), unit)}\nagainst {reference['label']}")


def place_legend(figure, axes):
    """Above the panels, in as many columns as fit; returns the height of title and legend [inches]."""
    handles, labels = axes.get_legend_handles_labels()
    for columns, size in ((5, 9), (4, 9), (3, 9), (2, 9), (1, 9), (1, 7), (1, 5)):
        legend = figure.legend(handles, labels, loc="upper center", ncol=columns, frameon=False, handlelength=4,
                               fontsize=size, bbox_to_anchor=(0.5, 1 - 0.28 / figure.get_figheight()))
        legend.set_in_layout(False)
        extent = legend.get_window_extent(figure.canvas.get_renderer())
        if extent.width < 0.98 * figure.bbox.width or size == 5:
            return 0.28 + extent.height / figure.dpi
        legend.remove()


def draw(description, path, dpi, by_component=False):
    give_styles(description)
    with_errors = description.get("reference") is not None and len(description["runs"]) > 1
    figure, axes = (draw_components if by_component else draw_probes)(description, with_errors)
    for panel in axes[-1]:
        panel.set_xlabel(with_unit("time", description.get("time_unit", "s")))
    axes[-1, 0].set_xlim(min(run["series"]["t"][0] for run in description["runs"]),
                         max(run["series"]["t"][-1] for run in description["runs"]))
    figure.align_ylabels(axes)
    height = figure.get_figheight()
    figure.suptitle(description.get("title", ""), y=1 - 0.08 / height, va="top", fontsize=11).set_in_layout(False)
    head = place_legend(figure, axes[0, 0])
    figure.tight_layout(rect=(0, 0, 1, 1 - head / height))
    save(figure, path, dpi)


def draw_probes(description, with_errors):
    """A row for each probe: its size, its error."""
    probes = probes_of(description)
    shown, left = probes[:MOST_PROBES], probes[MOST_PROBES:]
    figure, axes = pyplot().subplots(len(shown), 1 + with_errors, sharex=True, squeeze=False,
                                     figsize=(BOTH if with_errors else WIDTH, PANEL_HEIGHT * len(shown) + 1.2))
    for row, (columns, unit) in zip(axes, shown):
        draw_values(row[0], description, columns, name_of(columns), unit)
        if with_errors:
            draw_errors(row[1], description, columns, unit)
    if left:
        axes[-1, 0].set_title(f"and {len(left)} more probes, in compare.csv", fontsize=8, color="0.3", loc="left")
    return figure, axes


def draw_components(description, with_errors):
    """A panel for each component that moves, and the error of the probe that moves most."""
    probes = moving(description)
    panels = len(probes) + with_errors
    figure, axes = pyplot().subplots(panels, 1, sharex=True, squeeze=False, figsize=(WIDTH, PANEL_HEIGHT * panels + 1))
    for panel, probe in zip(axes[:, 0], probes):
        draw_values(panel, description, [probe["column"]], probe["column"], probe.get("unit", ""))
    if with_errors:
        main = main_probe(description)
        draw_errors(axes[-1, 0], description, components(description, main), main.get("unit", ""))
    return figure, axes


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
    parser.add_argument("--components", action="store_true", help="a panel for each component of the probes")
    arguments = parser.parse_args()
    path = arguments.output or os.path.join(arguments.folder, "compare.png")
    if os.path.splitext(path)[1] not in (".png", ".svg", ".pdf"):
        raise Fault(f"{path}: a picture ends in .png, .svg or .pdf")
    if arguments.dpi < 1:
        raise Fault(f"--dpi {arguments.dpi}: must be positive")
    draw(load(arguments.folder), path, arguments.dpi, arguments.components)


if __name__ == "__main__":
    sys.exit(guarded("compare", main))
