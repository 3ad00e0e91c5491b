"""The mechanism at chosen times: in the plane above each other, in space side by side. True to scale, unless enlarged."""
import numpy as np

from style import Fault, MAP, pyplot, save
from view import Box, View, draw_joints, draw_mesh, draw_scale, set_frame, with_scale

WIDTH = 7.6  # inches


def rows_at(run, times, count=6):
    """Rows nearest to the times; without times `count` at equal distances."""
    run.load()
    if not times:
        return run.spread_rows(count)
    first, last = min(run.t), max(run.t)
    for t in times:
        if not first - 1e-9 <= t <= last + 1e-9:
            raise Fault(f"--times {t:g}: the run goes from {first:g} to {last:g} s")
    rows = []
    for t in times:
        row = run.row_at(t)
        if row not in rows:
            rows.append(row)
    return rows


def titled(run, amplify):
    return run.title + (f", deformations {amplify:g} times" if amplify != 1 else "")


def need_bodies(run):
    if not run.bodies:
        raise Fault(f"{run.folder}: no body has a mesh in its results")


def draw(run, path, dpi, times=(), amplify=1.0, view=(-60.0, 25.0)):
    need_bodies(run)
    rows = rows_at(run, times)
    if run.dimension == 2:
        draw_planar(run, rows, amplify, path, dpi)
    else:
        draw_spatial(run, rows, amplify, View(3, *view), path, dpi)
    return path


def draw_planar(run, rows, amplify, path, dpi):
    plt = pyplot()
    from matplotlib import cm

    view, box = View(2), Box()
    moved = {row: [run.moved(body, row, amplify)[0] for body in run.bodies] for row in rows}
    for places in moved.values():
        for x in places:
            box.add(view, x)
    low, high = box.limits()
    size = high - low
    height = float(np.clip(5.6 * size[1] / size[0], 2.0, 7.0))
    figure, axes = plt.subplots(layout="constrained", figsize=(WIDTH, height + 0.9))
    for i, row in enumerate(rows):
        colour = cm.get_cmap(MAP)(0.92 * i / max(1, len(rows) - 1))
        for body, x in zip(run.bodies, moved[row]):
            draw_mesh(axes, view, body.mesh, x, colour="0.45" if body.rigid else colour, width=3.0 if body.rigid else 2.0,
                      fill=colour, order=2 + i)
        draw_joints(axes, view, run, row, amplify, colour)
        axes.plot([], [], color=colour, linewidth=2.4, label=f"{run.t[row]:.4g} s")
    set_frame(axes, view, low, high)
    axes.legend(title="time", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.suptitle(titled(run, amplify), fontsize=11)
    save(figure, path, dpi, 256)


def draw_spatial(run, rows, amplify, view, path, dpi):
    plt = pyplot()
    from matplotlib import cm
    from matplotlib.colors import Normalize

    box, moved, greatest = Box(), {}, 0.0
    for row in rows:
        moved[row] = [run.moved(body, row, amplify) for body in run.bodies]
        for x, lengths in moved[row]:
            box.add(view, x)
            greatest = max(greatest, float(lengths.max(initial=0)))
    low, high = box.limits()
    low = with_scale(low, high)
    size = high - low
    columns = min(len(rows), 3 if size[0] < 3 * size[1] else 2 if size[0] < 6 * size[1] else 1)
    lines = -(-len(rows) // columns)
    wide = WIDTH / columns
    figure, panels = plt.subplots(lines, columns, squeeze=False, layout="constrained",
                                  figsize=(WIDTH + 0.9, lines * (float(np.clip(wide * size[1] / size[0], 1.0, 4.5)) + 0.3) + 0.5))
    norm = Normalize(0, greatest if greatest > 0 else 1)
    for panel in panels.flat:
        panel.set_axis_off()
    for panel, row in zip(panels.flat, rows):
        for body, (x, lengths) in sorted(zip(run.bodies, moved[row]), key=lambda b: view.paper(b[1][0])[:, 2].mean()):
            draw_mesh(panel, view, body.mesh, x, None if body.rigid else lengths, norm, colour="0.45", fill="0.6")
        draw_joints(panel, view, run, row, amplify, size=3)
        set_frame(panel, view, low, high)
        panel.set_title(f"t = {run.t[row]:.4g} s", fontsize=9)
    draw_scale(panels.flat[0], view, low, high)
    bar = figure.colorbar(cm.ScalarMappable(norm, MAP), ax=panels, shrink=0.8, aspect=30)
    bar.set_label("deformation [m]")
    bar.formatter.set_powerlimits((-3, 4))
    bar.formatter.set_useMathText(True)
    figure.suptitle(titled(run, amplify), fontsize=11)
    save(figure, path, dpi, 256)
