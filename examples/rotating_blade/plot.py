#!/usr/bin/env python3
"""Draws the Campbell diagram that `floe campbell` wrote: plot.py FOLDER [PICTURE]: FOLDER/campbell.csv, result.png."""
import csv
import io
import math
import pathlib
import sys


def read(path):
    """Frequencies [Hz] by speed [rad/s], ascending, and those that are unstable."""
    speeds = {}
    with open(path, newline="") as file:
        rows = csv.reader(file)
        next(rows)
        for speed, mode, hertz, _, _, remark in rows:
            if mode:
                speeds.setdefault(float(speed), []).append((float(hertz), remark == "unstable"))
    return speeds


def draw(speeds, path, dpi=150, orders=6):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from PIL import Image  # matplotlib needs it, too

    matplotlib.rcParams.update({"font.size": 9, "axes.grid": True, "grid.color": "0.9", "axes.axisbelow": True,
                                "axes.spines.top": False, "axes.spines.right": False})
    figure, panel = plt.subplots(figsize=(6.4, 4.2))
    end = max(speeds)
    top = 1.08 * max(hertz for modes in speeds.values() for hertz, _ in modes)
    for order in range(1, orders + 1):
        panel.plot([0, end], [0, order * end / (2 * math.pi)], color="0.6", linewidth=0.8, linestyle="--")
        x = min(end, 0.97 * top * 2 * math.pi / order)
        panel.annotate(f"{order}x", (x, order * x / (2 * math.pi)), color="0.4", xytext=(3, 0),
                       textcoords="offset points", annotation_clip=False)
    for mode in range(max(len(modes) for modes in speeds.values())):
        points = [(speed, modes[mode][0]) for speed, modes in sorted(speeds.items()) if mode < len(modes)]
        panel.plot(*zip(*points), marker="o", markersize=2.5, linewidth=1.4)
    wild = [(speed, hertz) for speed, modes in speeds.items() for hertz, unstable in modes if unstable]
    if wild:
        panel.plot(*zip(*wild), "rx", label="unstable")
        panel.legend()
    panel.set_xlim(0, end)
    panel.set_ylim(0, top)
    panel.set_xlabel("speed [rad/s]")
    panel.set_ylabel("frequency [Hz]")
    figure.tight_layout()
    with io.BytesIO() as drawn:
        figure.savefig(drawn, format="png", dpi=dpi)
        Image.open(drawn).convert("RGB").quantize(64).save(path, optimize=True, dpi=(dpi, dpi))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    picture = sys.argv[2] if len(sys.argv) == 3 else pathlib.Path(__file__).parent / "result.png"
    draw(read(pathlib.Path(sys.argv[1]) / "campbell.csv"), picture)


if __name__ == "__main__":
    main()
