#!/usr/bin/env python3
"""`floe plot`: pictures of the results of floe's commands. The program starts it with checked options."""
import argparse
import os
import sys

sys.dont_write_bytecode = True
from style import Damaged, Fault, guarded, reading  # noqa: E402

KINDS = ["probes", "energy", "deformed", "animation", "shapes", "campbell", "compare", "tradeoff", "sweep"]
OF_RUN = ["probes", "energy", "deformed"]  # without being asked
ENDINGS = {"animation": (".gif", ".mp4")}
PICTURES = (".png", ".svg", ".pdf")


def kinds_of(path):
    """What a path can be drawn as, those that are drawn without being asked first; and the path that holds it."""
    if os.path.isdir(path):
        has = lambda name: os.path.exists(os.path.join(path, name))  # noqa: E731
        for mark, kind in (("compare.json", "compare"), ("tradeoff.json", "tradeoff"), ("sweep.csv", "sweep"),
                           ("campbell.csv", "campbell")):
            if has(mark):
                return [kind], [kind], path
        if has("probes.csv"):
            return OF_RUN, OF_RUN + ["animation", "shapes"], path
        raise Fault(f"{path}: contains no results of floe; expected the folder of a run, a comparison, a "
                    "trade-off, a sweep or a Campbell diagram")
    if not os.path.exists(path):
        raise Fault(f"{path}: does not exist")
    folder, name = os.path.split(path)
    if name in ("result.h5", "probes.csv", "summary.json", "compare.json", "tradeoff.json", "sweep.csv", "sweep.h5",
                "campbell.csv"):
        return kinds_of(folder or ".")
    if path.endswith((".xdmf", ".h5")):
        return ["shapes"], ["shapes"], path
    raise Fault(f"{path}: expected a folder, shapes (.xdmf) or a reduced body (.h5)")


def wanted_kinds(path, asked):
    usual, possible, at = kinds_of(path)
    unknown = [kind for kind in asked if kind not in KINDS]
    if unknown:
        raise Fault(f"--kind {unknown[0]}: expected of {', '.join(KINDS)}")
    chosen = [kind for kind in possible if kind in asked] if asked else usual
    if not chosen:
        raise Fault(f"--kind {','.join(asked)}: {path} can be drawn as {', '.join(possible)}")
    return chosen, at


def target(options, path, kind, several):
    """The picture's file. @throws Fault  an ending that it cannot have"""
    endings = ENDINGS.get(kind, PICTURES)
    if options.out and not os.path.isdir(options.out) and os.path.splitext(options.out)[1]:
        if several:
            raise Fault(f"--out {options.out}: names one picture for several; expected a folder, or one --kind")
        if os.path.splitext(options.out)[1] not in endings:
            raise Fault(f"--out {options.out}: expected a name that ends in {' '.join(endings)}")
        return options.out
    folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
    if options.out:
        os.makedirs(options.out, exist_ok=True)
        folder = options.out
    name = kind if os.path.isdir(path) else f"{os.path.splitext(os.path.basename(path))[0]}-{kind}"
    return os.path.join(folder, name + (endings[0] if kind in ENDINGS else "." + (options.format or "png")))


def draw(kind, path, out, options, run):
    if kind == "compare":
        import compare
        compare.draw(compare.load(path), out, options.dpi, options.components)
    elif kind == "tradeoff":
        import tradeoff
        tradeoff.draw(*tradeoff.load(path), out, options.dpi)
    elif kind == "sweep":
        import sweep
        sweep.draw(path, out, options.dpi)
    elif kind == "campbell":
        import campbell
        campbell.draw(path, out, options.dpi)
    elif kind == "shapes":
        import shapes
        found = shapes.of_run(run(path)) if os.path.isdir(path) else shapes.load(path)
        shapes.draw(found, out, options.dpi, options.shapes, options.body, options.view)
    elif kind == "probes":
        import history
        history.draw(run(path), out, options.dpi, options.probes)
    elif kind == "energy":
        import energy
        energy.draw(run(path), out, options.dpi)
    elif kind == "deformed":
        import deformed
        deformed.draw(run(path), out, options.dpi, options.times, options.amplify, options.view)
    else:
        import animation
        animation.draw(run(path), out, options.dpi, options.frames, options.fps, options.amplify, options.view)


def numbers(text, name, count=None):
    try:
        values = [float(word) for word in text.split(",")] if text else []
    except ValueError:
        values = None
    if values is None or (count and len(values) != count):
        raise Fault(f"{name} {text}: expected {count or 'some'} numbers, separated by commas")
    return values


def read_options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("paths", nargs="+")
    for name in ("--kind", "--out", "--format", "--probes", "--times", "--body"):
        parser.add_argument(name, default="")
    parser.add_argument("--view", default="-60,25")
    parser.add_argument("--amplify", type=float, default=1.0)
    parser.add_argument("--fps", type=float, default=20.0)
    parser.add_argument("--components", action="store_true")
    for name, default in (("--shapes", 6), ("--frames", 100), ("--dpi", 150)):
        parser.add_argument(name, type=int, default=default)
    options = parser.parse_args()
    options.kind = [word for word in options.kind.split(",") if word]
    options.probes = [word for word in options.probes.split(",") if word]
    options.times = numbers(options.times, "--times")
    options.view = tuple(numbers(options.view, "--view", 2))
    return options


def work():
    options = read_options()
    chosen = []
    for path in options.paths:
        kinds, at = wanted_kinds(path, options.kind)
        chosen += [(kind, at) for kind in kinds]
    asked = {kind: word for word, kind in (("probes", "probes"), ("times", "deformed"), ("body", "shapes"),
                                           ("components", "compare"))
             if getattr(options, word)}
    for kind, word in asked.items():
        if kind not in (one for one, _ in chosen):
            raise Fault(f"--{word}: applies to --kind {kind}, which is not drawn")
    several = len(chosen) > 1
    targets = [target(options, path, kind, several) for kind, path in chosen]
    runs, skipped, damaged = {}, [], None

    def run(path):
        from results import Run
        if path not in runs:
            runs[path] = Run(path)
        return runs[path]

    for (kind, path), out in zip(chosen, targets):
        try:
            with reading(path):
                draw(kind, path, out, options, run)
            print(f"Picture: {out}")
        except Damaged as fault:  # the other pictures are drawn all the same
            damaged = damaged or fault
        except Fault as fault:  # of a picture that nobody asked for by its name
            if options.kind or kind in asked or not several:
                raise
            skipped.append(f"Note: no picture of {kind}: {fault}")
    for line in skipped:
        print(line)
    if damaged:
        raise damaged
    if len(skipped) == len(chosen):
        raise Fault("nothing to draw")


if __name__ == "__main__":
    sys.exit(guarded("plot", work))
