"""What the pictures of floe have in common: colours that everybody can tell apart, reading, saving."""
import csv
import io
import json
import math
import sys

COLOURS = ["#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F"]  # Okabe and Ito 2008, by contrast
DASHES = [(), (6, 2), (2, 1.5), (7, 2, 1.5, 2), (10, 2.5), (4, 1.5, 1, 1.5, 1, 1.5), (1, 1)]
MARKS = ["o", "s", "^", "D", "v", "P", "X", "*"]
MAP = "viridis"  # of numbers: even in lightness, also for those who see few colours


class Fault(Exception):
    """Something that the user should read, in one line."""


def guarded(name, attempt):
    """Runs it; tells what the user should know in one line, with floe's exit codes."""
    try:
        attempt()
        return 0
    except Fault as fault:
        print(f"floe: {name}: {fault}", file=sys.stderr)
        return 2
    except ImportError as error:
        package = {"matplotlib": "python3-matplotlib", "h5py": "python3-h5py", "numpy": "python3-numpy",
                   "PIL": "python3-pil"}.get((error.name or "").split(".")[0], "python3-matplotlib, python3-h5py")
        print(f"floe: {name}: {error}; install the package {package}", file=sys.stderr)
        return 1
    except BrokenPipeError:
        return 1
    except OSError as error:
        print(f"floe: {name}: cannot read or write {error.filename or 'a file'}: {error.strerror or error}",
              file=sys.stderr)
        return 1


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise Fault(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise Fault(f"{path}: not JSON: {error}") from error


def number(text, path, line):
    try:
        return float(text)
    except ValueError:
        raise Fault(f"{path}:{line}: '{text}' is not a number") from None


def read_series(path):
    """Columns by name, without their units: {"t": [...], "tip.x": [...]}."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise Fault(f"{path}: {error.strerror}") from error
    if not rows or not rows[0]:
        raise Fault(f"{path}: empty")
    names = [cell.split(" [")[0].strip() for cell in rows[0]]
    columns = {name: [] for name in names}
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            raise Fault(f"{path}:{line}: {len(row)} cells for {len(names)} columns")
        for name, cell in zip(names, row):
            columns[name].append(number(cell, path, line))
    if "t" not in columns or not columns["t"]:
        raise Fault(f"{path}: no times")
    return columns


def read_units(path):
    """Of the columns of such a file: {"t": "s", "tip.x": "m"}."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            cells = next(csv.reader(file), [])
    except OSError as error:
        raise Fault(f"{path}: {error.strerror}") from error
    return {cell.split(" [")[0].strip(): cell.partition(" [")[2].rstrip("]") for cell in cells}


def pyplot():
    """matplotlib without a screen, in the style of all pictures."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    matplotlib.rcParams.update({"font.size": 9, "axes.grid": True, "grid.color": "0.9", "axes.axisbelow": True,
                                "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "floe"})
    return plt


def span(values):
    finite = [value for value in values if math.isfinite(value)]
    return max(finite) - min(finite) if finite else 0.0


def with_unit(name, unit):
    return f"{name} [{unit}]" if unit else name


def per_cent(share):
    """To two digits, without powers of ten up to 1e5 %."""
    text = f"{100 * share:.2g}"
    return (f"{float(text):.0f}" if "e" in text and 1 <= float(text) < 1e5 else text) + " %"


def duration(value):
    """Of seconds, in a unit that suits."""
    for limit, factor, unit in ((1e-3, 1e6, "µs"), (1, 1e3, "ms")):
        if value < limit:
            return f"{factor * value:.3g} {unit}"
    return f"{value:.3g} s"


def save(figure, path, dpi, colours=64):
    """A PNG has a palette: lines in few colours take a third of the bytes then."""
    if not path.endswith(".png"):
        figure.savefig(path)
        return
    from PIL import Image  # matplotlib needs it, too

    with io.BytesIO() as drawn:
        figure.savefig(drawn, format="png", dpi=dpi)
        Image.open(drawn).convert("RGB").quantize(colours).save(path, optimize=True, dpi=(dpi, dpi))
