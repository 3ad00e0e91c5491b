"""The mechanism in motion: a GIF, or an MP4 through ffmpeg."""
import shutil

import numpy as np

from deformed import need_bodies, titled
from style import Fault, MAP, drafted, pyplot
from view import Box, View, draw_joints, draw_mesh, draw_scale, set_frame, with_scale

WIDTH = 6.4  # inches


def writer_of(path, fps):
    from matplotlib.animation import FFMpegWriter, PillowWriter

    if path.endswith(".gif"):
        return PillowWriter(fps=fps)
    if not shutil.which("ffmpeg"):
        raise Fault(f"{path}: an MP4 needs ffmpeg (package ffmpeg); a GIF does not")
    return FFMpegWriter(fps=fps, codec="libx264", extra_args=["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"])


def draw(run, path, dpi, count=100, fps=20.0, amplify=1.0, direction=(-60.0, 25.0)):
    need_bodies(run)
    plt = pyplot()
    from matplotlib.colors import Normalize

    rows = run.spread_rows(count)
    view, box, greatest = View(run.dimension, *direction), Box(), 0.0
    for row in rows:
        for body in run.bodies:
            x, lengths = run.moved(body, row, amplify)
            box.add(view, x)
            greatest = max(greatest, float(lengths.max(initial=0)))
    low, high = box.limits()
    if run.dimension == 3:
        low = with_scale(low, high)
    size = high - low
    figure, axes = plt.subplots(layout="constrained",
                                figsize=(WIDTH, float(np.clip(WIDTH * size[1] / size[0], 2.0, 6.4)) + 0.6))
    norm = Normalize(0, greatest if greatest > 0 else 1)
    bar = figure.colorbar(plt.cm.ScalarMappable(norm, MAP), ax=axes, shrink=0.9, aspect=30)
    bar.set_label("deformation [m]")
    bar.formatter.set_powerlimits((-3, 4))
    bar.formatter.set_useMathText(True)
    writer = writer_of(path, fps)
    with drafted(path) as draft, writer.saving(figure, draft, min(dpi, 100)):
        for row in rows:
            axes.clear()
            moved = [(body, *run.moved(body, row, amplify)) for body in run.bodies]
            for body, x, lengths in sorted(moved, key=lambda m: view.paper(m[1])[:, 2].mean()):
                draw_mesh(axes, view, body.mesh, x, None if body.rigid else lengths, norm, width=2.2, colour="0.45",
                          fill="0.6")
            draw_joints(axes, view, run, row, amplify)
            set_frame(axes, view, low, high)
            if run.dimension == 3:
                draw_scale(axes, view, low, high)
            axes.set_title(f"{titled(run, amplify)}\nt = {run.t[row]:.4g} s", fontsize=10)
            writer.grab_frame()
    plt.close(figure)
    return path
