"""A Campbell diagram: frequencies of a rotating scene versus its speed, by vibration, with the engine orders."""
import csv
import math
import os

from style import MARKS, MORE_COLOURS, Fault, pyplot, read_json, save

SIZE = 7.6, 4.6  # inches
LINES = "-", "--", ":"  # of vibrations that have the same colour


def load(folder):
    """Points (speed [rad/s], frequency [Hz]) by track, ascending; those that are unstable, at no frequency where
    something grows without oscillation; the diagram's title."""
    path = os.path.join(folder, "campbell.csv")
    tracks, unstable = {}, []
    try:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                point = float(row["speed [rad/s]"]), float(row["frequency [Hz]"] or 0)
                if row["mode"]:
                    tracks.setdefault(int(row["track"]), []).append(point)
                if row["remark"].startswith("unstable"):
                    unstable.append(point)
    except OSError as error:
        raise Fault(f"{path}: {error.strerror}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise Fault(f"{path}: is not a table of a Campbell diagram ({error})") from error
    if not tracks:
        raise Fault(f"{path}: no vibrations")
    summary = read_json(os.path.join(folder, "summary.json"))
    scene = summary.get("scene", {})
    return {track: sorted(points) for track, points in sorted(tracks.items())}, unstable, f"{scene.get('title') or scene.get('file', '')}: {summary.get('label', '')}"


def with_gaps(line, speeds):
    """The points of a track, and none at speeds where it has not been found: its line does not pass over them."""
    known = dict(line)
    within = [speed for speed in speeds if line[0][0] <= speed <= line[-1][0]]
    return [(speed, known.get(speed, math.nan)) for speed in within]


def draw(folder, path, dpi, orders=6):
    tracks, unstable, title = load(folder)
    figure, panel = pyplot().subplots(figsize=SIZE, layout="constrained")
    points = [point for track in tracks.values() for point in track]
    speeds = sorted({speed for speed, _ in points})
    end = speeds[-1]
    top = 1.08 * max(hertz for _, hertz in points) or 1
    for order in range(1, orders + 1):
        if end == 0:
            break
        panel.plot([0, end], [0, order * end / (2 * math.pi)], color="0.6", linewidth=0.8, linestyle="--", zorder=1)
        beyond = order * end / (2 * math.pi) > top  # leaves through the top, else on the right
        at = (2 * math.pi * top / order, top) if beyond else (end, order * end / (2 * math.pi))
        if not beyond and order > 1 and end / (2 * math.pi) < 0.035 * top and order < orders:
            continue  # lines that lie close to one another: the first and the last have names
        close = orders * end / (2 * math.pi) < 0.04 * top  # all of them have one name
        if close and order < orders:
            continue
        panel.annotate(f"1× to {orders}×" if close else f"{order}×", at, xytext=(0, 2) if beyond else (3, 0), textcoords="offset points", fontsize=8,
                       color="0.35", ha="center" if beyond else "left", va="bottom" if beyond else "center",
                       annotation_clip=False)
    for mode, (track, line) in enumerate(tracks.items()):
        panel.plot(*zip(*with_gaps(line, speeds)), marker=MARKS[mode % len(MARKS)], markersize=3.4, linewidth=1.4,
                   color=MORE_COLOURS[mode % len(MORE_COLOURS)], label=f"{track}", zorder=3,
                   linestyle=LINES[mode // len(MORE_COLOURS) % len(LINES)])
    if unstable:
        panel.plot(*zip(*unstable), "kx", markersize=8, label="unstable", zorder=4)
    panel.set_xlim(0, end if end > 0 else 1)
    panel.set_ylim(0, top)
    panel.set_xlabel("speed of rotation [rad/s]   (dashed: engine orders)")
    panel.set_ylabel("frequency [Hz]")
    panel.legend(title="vibration", frameon=False, loc="center left", bbox_to_anchor=(1.04, 0.5),
                 ncol=1 + (len(tracks) + bool(unstable) - 1) // 14)
    figure.suptitle(title, fontsize=11)
    save(figure, path, dpi)
    return path
