"""Energy of a run versus time, the potential from the start on, change of its total, and violation of the constraints."""
import numpy as np

from style import COLOURS, DASHES, pyplot, save

WIDTH = 7.6  # inches
PARTS = ["kinetic", "elastic", "potential"]


def draw(run, path, dpi):
    run.load()
    t, energy = run.t, run.energy.copy()
    energy[:, PARTS.index("potential")] -= energy[0, PARTS.index("potential")]  # that of the origin may hide all else
    total = energy.sum(1)
    drift = run.constraints is not None and np.any(run.constraints > 0)
    figure, panels = pyplot().subplots(2 + drift, 1, sharex=True, layout="constrained", figsize=(WIDTH, 5.2 + 1.9 * drift),
                                       height_ratios=[1.5, 1, 1][:2 + drift])
    for i, name in enumerate(PARTS):
        if np.any(energy[:, i] != 0):
            line, = panels[0].plot(t, energy[:, i], color=COLOURS[i], linewidth=2.2, label="potential\n(from the start)" if name == "potential" else name)
            if DASHES[i]:
                line.set_dashes(DASHES[i])
    panels[0].plot(t, total, color="black", linewidth=1.1, label="total")
    panels[0].set_ylabel("energy [J]")
    panels[1].plot(t, total - total[0], color="black", linewidth=1.1)
    panels[1].set_ylabel("change of the\ntotal energy [J]")
    panels[1].set_title("work of loads and drives minus dissipation; without these, numerical drift", fontsize=8,
                        color="0.3", loc="left")
    if drift:
        for i, name in enumerate(("positions", "velocities")):
            if not np.any(run.constraints[:, i] > 0):
                continue
            values = np.where(run.constraints[:, i] > 0, run.constraints[:, i], np.nan)
            few = np.count_nonzero(run.constraints[:, i]) < 30
            line, = panels[2].plot(t, values, color=COLOURS[i], linewidth=1.1, label=name, marker="." if few else None)
            if DASHES[i]:
                line.set_dashes(DASHES[i])
        panels[2].set_yscale("log")
        panels[2].set_ylabel("violation of the\nconstraints [m, m/s; rad]")
        panels[2].legend(frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    for panel in panels[:2]:
        panel.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
    panels[0].legend(frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
    panels[-1].set_xlabel(run.time_label)
    first, last = min(t), max(t)  # of a path of equilibria t also falls
    if last > first:
        panels[-1].set_xlim(first, last)
    figure.suptitle(f"{run.title}: {run.summary.get('label', '')}", fontsize=11)
    figure.align_ylabels(panels)
    save(figure, path, dpi)
    return path
