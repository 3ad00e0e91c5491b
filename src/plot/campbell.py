"""A Campbell diagram: frequencies of a rotating scene versus its speed, by vibration, with the engine orders."""
import csv
import math
import os

from style import MARKS, MORE_COLOURS, Fault, pyplot, read_json, save

SIZE = 7.6, 4.6  # inches


def load(folder):
    """Frequencies [Hz] by speed [rad/s], ascending, and whether each is unstable; where something grows without
    oscillation; the diagram's title."""
    path = os.path.join(folder, "campbell.csv")
    speeds, growing = {}, []
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.reader(file)
            next(rows)
            for speed, mode, hertz, _, _, remark in rows:
                if mode:
                    speeds.setdefault(float(speed), []).append((float(hertz), remark == "unstable"))
                elif remark.startswith("unstable"):
                    growing.append((float(speed), 0.0))
    except OSError as error:
        raise Fault(f"{path}: {error.strerror}") from error
    except (ValueError, StopIteration) as error:
        raise Fault(f"{path}: is not a table of a Campbell diagram ({error})") from error
    if not speeds:
        raise Fault(f"{path}: no vibrations")
    summary = read_json(os.path.join(folder, "summary.json"))
    scene = summary.get("scene", {})
    return speeds, growing, f"{scene.get('title') or scene.get('file', '')}: {summary.get('label', '')}"


def matched(predicted, found):
    """Pairs (i, j) of two ascending lists, in order, of the least sum of distances; all of the shorter one."""
    if len(predicted) > len(found):
        return [(i, j) for j, i in matched(found, predicted)]
    n, m = len(predicted), len(found)
    cost = [[0.0] * (m + 1)] + [[math.inf] * (m + 1) for _ in range(n)]
    for i in range(1, n + 1):
        for j in range(i, m + 1):
            cost[i][j] = min(cost[i][j - 1], cost[i - 1][j - 1] + abs(predicted[i - 1] - found[j - 1]))
    pairs, i, j = [], n, m
    while i > 0:
        if cost[i][j] == cost[i][j - 1]:
            j -= 1
        else:
            i, j = i - 1, j - 1
            pairs.append((i, j))
    return pairs[::-1]


def tracked(speeds):
    """Lines of points (speed, frequency), each of one vibration: where lines cross, they go on as they came.

    From speed to speed the frequencies are those that lie nearest to what two points before continue to, all together.
    """
    lines = []
    for speed, modes in sorted(speeds.items()):
        def continued(line):
            (x1, y1), (x0, y0) = line[-1], line[-2] if len(line) > 1 else line[-1]
            return y1 + (y1 - y0) * (speed - x1) / (x1 - x0) if x1 > x0 else y1
        alive = sorted((line for line in lines if line[-1][0] == before), key=continued) if lines else []
        found = sorted(hertz for hertz, _ in modes)
        pairs = matched([continued(line) for line in alive], found)
        for i, j in pairs:
            alive[i].append((speed, found[j]))
        lines += [[(speed, hertz)] for j, hertz in enumerate(found) if j not in {j for _, j in pairs}]
        before = speed
    return lines


def draw(folder, path, dpi, orders=6):
    speeds, growing, title = load(folder)
    figure, panel = pyplot().subplots(figsize=SIZE, layout="constrained")
    end = max(speeds)
    top = 1.08 * max(hertz for modes in speeds.values() for hertz, _ in modes) or 1
    for order in range(1, orders + 1):
        if end == 0:
            break
        panel.plot([0, end], [0, order * end / (2 * math.pi)], color="0.6", linewidth=0.8, linestyle="--", zorder=1)
        beyond = order * end / (2 * math.pi) > top  # leaves through the top, else on the right
        at = (2 * math.pi * top / order, top) if beyond else (end, order * end / (2 * math.pi))
        if not beyond and order > 1 and end / (2 * math.pi) < 0.035 * top and order < orders:
            continue  # lines that lie close to one another: the first and the last have names
        panel.annotate(f"{order}×", at, xytext=(0, 2) if beyond else (3, 0), textcoords="offset points", fontsize=8,
                       color="0.35", ha="center" if beyond else "left", va="bottom" if beyond else "center",
                       annotation_clip=False)
    lines = tracked(speeds)
    for mode, points in enumerate(lines):
        panel.plot(*zip(*points), marker=MARKS[mode % len(MARKS)], markersize=3.4, linewidth=1.4,
                   color=MORE_COLOURS[mode % len(MORE_COLOURS)], label=f"{mode + 1}", zorder=3)
    wild = growing + [(speed, hertz) for speed, modes in speeds.items() for hertz, unstable in modes if unstable]
    if wild:
        panel.plot(*zip(*wild), "kx", markersize=8, label="unstable", zorder=4)
    panel.set_xlim(0, end if end > 0 else 1)
    panel.set_ylim(0, top)
    panel.set_xlabel("speed of rotation [rad/s]   (dashed: engine orders)")
    panel.set_ylabel("frequency [Hz]")
    panel.legend(title="vibration", frameon=False, loc="center left", bbox_to_anchor=(1.04, 0.5),
                 ncol=1 + (len(lines) + bool(wild) - 1) // 14)
    figure.suptitle(title, fontsize=11)
    save(figure, path, dpi)
    return path
