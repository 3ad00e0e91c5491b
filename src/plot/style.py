"""What the pictures of floe have in common: colours that everybody can tell apart, reading, saving."""
import contextlib
import csv
import io
import json
import math
import os
import subprocess
import sys
import warnings

COLOURS = ["#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F"]  # Okabe and Ito 2008, by contrast
MORE_COLOURS = COLOURS + ["#332288", "#117733", "#882255", "#999933", "#44AA99", "#AA4499", "#000000"]  # Tol 2021, muted
DASHES = [(), (6, 2), (2, 1.5), (7, 2, 1.5, 2), (10, 2.5), (4, 1.5, 1, 1.5, 1, 1.5), (1, 1)]
MARKS = ["o", "s", "^", "D", "v", "P", "X", "*"]
MAP = "viridis"  # of numbers: even in lightness, also for those who see few colours


class Fault(Exception):
    """Something that the user should read, in one line."""


class Damaged(Fault):
    """Files that are not what floe wrote."""


# What reading runs into where a file is cut off, changed, or of another kind; h5py's OSErrors have no number.
OF_DAMAGE = (ArithmeticError, AttributeError, LookupError, MemoryError, RuntimeError, TypeError, ValueError, EOFError,
             StopIteration, csv.Error)


@contextlib.contextmanager
def reading(what):
    """@throws Damaged  for what does not fit in the files of `what`"""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            raise
        raise damage(what, error) from error
    except OF_DAMAGE as error:
        raise damage(what, error) from error


def damage(what, error):
    words = " ".join(str(error).split())[:120]
    return Damaged(f"{what}: is damaged, or written by another version of floe ({type(error).__name__}: {words})")


@contextlib.contextmanager
def drafted(path):
    """A name beside `path` for what is to be written: it gets that name once it is whole, nothing is left of it else.

    @throws OSError  with the file's own name
    """
    folder, name = os.path.split(path)
    draft = os.path.join(folder, f".floe-{os.getpid()}-{name}")
    try:
        yield draft
        os.replace(draft, path)
    except subprocess.CalledProcessError as error:  # ffmpeg, which says nothing of what it lacked
        raise OSError(5, f"{os.path.basename(str(error.cmd[0]))} failed", path) from error
    except OSError as error:
        if error.errno is None or (error.filename and error.filename != draft):
            raise
        raise OSError(error.errno, os.strerror(error.errno), path) from error
    finally:
        with contextlib.suppress(OSError):
            os.remove(draft)


def guarded(name, attempt):
    """Runs it; tells what the user should know in one line, with floe's exit codes."""
    def told(code, text):
        print(f"floe: {name}: {text}", file=sys.stderr)
        return code

    warnings.simplefilter("ignore")  # of numbers that are none, for instance
    try:
        attempt()
        sys.stdout.flush()
        return 0
    except Fault as fault:
        return told(2, fault)
    except ImportError as error:
        package = {"matplotlib": "python3-matplotlib", "h5py": "python3-h5py", "numpy": "python3-numpy",
                   "PIL": "python3-pil"}.get((error.name or "").split(".")[0], "python3-matplotlib, python3-h5py")
        return told(1, f"{error}; install the package {package}")
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1
    except OSError as error:
        code = told(1, f"cannot read or write {error.filename or 'standard output'}: {error.strerror or error}")
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what waits for it would be tried again
        return code


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


def label_events(figure, panel, events, rows=4):
    """Names above a panel at their times, in rows so that none covers another; those that find no place are left out."""
    from matplotlib.transforms import blended_transform_factory
    renderer, ends, left = figure.canvas.get_renderer(), [-math.inf] * rows, 0
    texts = []
    for event in sorted(events, key=lambda event: event["t"]):
        text = panel.text(event["t"], 1, " " + event["name"], fontsize=8, color="0.3", va="bottom",
                          transform=blended_transform_factory(panel.transData, panel.transAxes))
        box = text.get_window_extent(renderer)
        row = next((i for i, end in enumerate(ends) if box.x0 > end), None)
        if row is None or box.x1 > figure.bbox.x1:
            left += row is None
            if row is None:
                text.remove()
                continue
            text.set_ha("right")  # at the right edge of the picture, to the left of its line
            box = text.get_window_extent(renderer)
            row = next((i for i, end in enumerate(ends) if box.x0 > end), None)
            if row is None:
                left += 1
                text.remove()
                continue
        ends[row] = box.x1
        text.set_y(1 + row * 1.05 * box.height / panel.bbox.height)
        texts.append(text)
    if left:
        panel.text(1, 1, f"and {left} more events", transform=panel.transAxes, fontsize=8, color="0.3", ha="right", va="top")
    return texts


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
    with io.BytesIO() as drawn:
        if path.endswith(".png"):
            from PIL import Image  # matplotlib needs it, too

            with io.BytesIO() as many:
                figure.savefig(many, format="png", dpi=dpi)
                Image.open(many).convert("RGB").quantize(colours).save(drawn, format="png", optimize=True, dpi=(dpi, dpi))
        else:
            figure.savefig(drawn, format=os.path.splitext(path)[1][1:])
        with drafted(path) as draft, open(draft, "wb") as file:
            file.write(drawn.getvalue())
