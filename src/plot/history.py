"""Probes of a run versus time: a panel for each probe, a line for each of its components."""
import os

from style import COLOURS, DASHES, Fault, label_events, pyplot, save, with_unit

PANEL_HEIGHT, WIDTH, MOST_PANELS = 1.9, 7.6, 10  # inches


def groups_of(series, units, wanted):
    """Columns by probe: {("tip", "m"): ["tip.x", "tip.y"]}."""
    columns = [name for name in series if name != "t"]
    unknown = [name for name in wanted if name not in columns and name not in {c.rpartition(".")[0] for c in columns}]
    if unknown:
        raise Fault(f"--probes: no column {unknown[0]}; expected of {', '.join(columns)}")
    groups = {}
    for name in columns:
        probe = name.rpartition(".")[0] or name
        if not wanted or name in wanted or probe in wanted:
            groups.setdefault((probe, units.get(name, "")), []).append(name)
    if not groups:
        raise Fault("the run has no probes")
    return groups


def draw(run, path, dpi, wanted=()):
    series, units = run.probes()
    groups = groups_of(series, units, wanted)
    shown, left = dict(list(groups.items())[:MOST_PANELS]), list(groups)[MOST_PANELS:]
    figure, panels = pyplot().subplots(len(shown), 1, sharex=True, squeeze=False, layout="constrained",
                                       figsize=(WIDTH, 0.9 + PANEL_HEIGHT * len(shown)))
    for panel, ((probe, unit), columns) in zip(panels[:, 0], shown.items()):
        for i, column in enumerate(columns):
            line, = panel.plot(series["t"], series[column], color=COLOURS[i % len(COLOURS)], linewidth=1.4,
                               label=column.rpartition(".")[2])
            if DASHES[i % len(DASHES)]:
                line.set_dashes(DASHES[i % len(DASHES)])
        panel.set_ylabel(with_unit(probe, unit))
        panel.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
        if len(columns) > 1:
            panel.legend(frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
    events = run.summary.get("events") or []
    for event in events:
        for panel in panels[:, 0]:
            panel.axvline(event["t"], color="0.4", linewidth=0.9, linestyle=":")
    panels[-1, 0].set_xlabel(run.time_label)
    first, last = min(series["t"]), max(series["t"])  # of a path of equilibria t also falls
    panels[-1, 0].set_xlim(first, last if last > first else first + 1)
    more = f" (and {len(left)} more: --probes {left[0][0]}, ...)" if left else ""
    figure.suptitle(f"{run.title}: {run.summary.get('label', os.path.basename(run.folder))}{more}", fontsize=11)
    if events:
        figure.draw_without_rendering()  # places the panels
        label_events(figure, panels[0, 0], events)
    save(figure, path, dpi)
    return path
