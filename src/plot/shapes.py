"""Shapes of modes, attachment modes and derivatives: of `floe modes --write`, of a reduced body, or of a run."""
import os

import numpy as np

from results import Mesh, open_hdf5, text_of
from style import Fault, MAP, pyplot, save
from view import Box, View, draw_mesh, draw_scale, set_frame

WIDTH = 7.6  # inches
OF_BASIS = "basis vectors, each orthonormalised against the previous ones,"
SHARE = 0.12  # of the body's length: how far the shape's maximum displacement is drawn


class Shapes:
    """A body's mesh and named displacements of its nodes, named by `labels`.

    what: `shapes`; of a basis, that they are its vectors, orthonormalised in their order.
    """

    def __init__(self, body, mesh, labels, fields, dimension, what):
        self.body, self.mesh, self.labels, self.fields = body, mesh, labels, fields
        self.dimension, self.what = dimension, what


def of_modes(file):
    """Written by floe modes --write."""
    found = []
    for name in file:
        group = file[name]
        mesh = Mesh.of_mixed(group["positions"][()], group["cells"][()])
        count = sum(member.startswith("field_") for member in group)
        fields = [group[f"field_{i + 1}/displacement"] for i in range(count)]
        labels = [text_of(field.attrs.get("description", f"field {i + 1}")) for i, field in enumerate(fields)]
        flat = not mesh.positions[:, 2].any() and not any(np.any(field[:, 2]) for field in fields)
        found.append(Shapes(name, mesh, labels, fields, 2 if flat and not len(mesh.faces) else 3, "shapes"))
    return found


def of_reduced(file, path):
    """A reduced body's basis: orthonormalised, the modes first."""
    if "shapes" not in file:
        raise Fault(f"{path}: contains no shapes; reduce the body again")
    dimension = 2 if file["shapes/basis"].shape[2] == 3 else 3
    kept = file["columns/kept"][()] == 1
    labels = [text_of(label) for label, stays in zip(file["columns/label"][()], kept) if stays]
    omega = file["columns/omega"][()][kept]
    labels = [f"{label} ({w / (2 * np.pi):.4g} Hz)" if w > 0 else label for label, w in zip(labels, omega)]
    return [Shapes(text_of(file["body/name"][()]) if "body/name" in file else os.path.basename(path),
                   Mesh.of(file["shapes"]), labels, moves_of(file["shapes/basis"], dimension), dimension, OF_BASIS)]


def of_run(run):
    found = []
    for body in run.bodies:
        if body.basis is None or len(body.basis) == 0:
            continue
        said = next((b for b in run.summary["bodies"] if b["name"] == body.name), {})
        hertz = iter(f["Hz"] for f in said.get("frequencies") or [])
        labels = []
        for column in (c for c in said.get("basis") or [] if c["kept"]):
            frequency = next(hertz, None) if column["kind"] == "mode" else None
            labels.append(column["column"] + (f" ({frequency:.4g} Hz)" if frequency is not None else ""))
        if len(labels) != len(body.basis):
            labels = [f"column {i + 1}" for i in range(len(body.basis))]
        found.append(Shapes(body.name, body.mesh, labels, body.basis, body.dimension, OF_BASIS))
    return found


def moves_of(basis, dimension):
    fields = np.zeros((basis.shape[0], basis.shape[1], 3))
    moves = 3 if dimension == 3 else 2
    fields[:, :, :moves] = basis[:, :, :moves]
    return fields


def load(path):
    data = path[:-5] + ".h5" if path.endswith(".xdmf") else path
    file = open_hdf5(data)
    form = text_of(file.attrs.get("format", ""))
    if form == "floe shapes":
        return of_modes(file)
    if form == "floe reduced body":
        return of_reduced(file, path)
    raise Fault(f"{path}: contains neither shapes nor a reduced body written by floe")


def draw(found, path, dpi, count=6, body=None, direction=(-60.0, 25.0)):
    names = [shapes.body for shapes in found]
    if body:
        if body not in names:
            raise Fault(f"--body {body}: is not there; expected of {', '.join(names)}")
        found = [shapes for shapes in found if shapes.body == body]
    panels = [(shapes, i) for shapes in found for i in range(min(count, len(shapes.labels)))]
    if not panels:
        raise Fault("there are no shapes: no body was reduced")
    draw_panels(panels, len(found) > 1, path, dpi, direction)
    return path


def draw_panels(panels, several, path, dpi, direction):
    plt = pyplot()
    from matplotlib.colors import Normalize

    drawn = []
    for shapes, i in panels:
        X, field = shapes.mesh.positions, np.asarray(shapes.fields[i])
        lengths = np.linalg.norm(field, axis=1)
        greatest = float(lengths.max(initial=0))
        size = float(np.linalg.norm(X.max(0) - X.min(0)))
        moved = X + (SHARE * size / greatest if greatest > 0 else 0) * field
        view, box = View(shapes.dimension, *direction), Box()
        box.add(view, X)
        box.add(view, moved)
        drawn.append((shapes, i, view, moved, lengths / greatest if greatest > 0 else lengths, *box.limits(0.04)))
    ratio = max(float((high - low)[1] / (high - low)[0]) for *_, low, high in drawn)
    columns = min(len(drawn), 3 if ratio > 0.3 else 2)
    lines = -(-len(drawn) // columns)
    height = float(np.clip(WIDTH / columns * ratio, 0.8, 3.6)) + 0.35
    figure, axes = plt.subplots(lines, columns, squeeze=False, layout="constrained",
                                figsize=(WIDTH + 0.8, lines * height + 0.6))
    for panel in axes.flat:
        panel.set_axis_off()
    norm = Normalize(0, 1)
    for panel, (shapes, i, view, moved, lengths, low, high) in zip(axes.flat, drawn):
        draw_mesh(panel, view, shapes.mesh, shapes.mesh.positions, colour="0.75", width=1.0, fill="0.94",
                  edge="0.8", order=1)
        draw_mesh(panel, view, shapes.mesh, moved, lengths, norm, width=2.4, order=2)
        panel.set_xlim(low[0], high[0])
        panel.set_ylim(low[1], high[1])
        panel.set_aspect("equal")
        panel.set_title((f"{shapes.body}: " if several else "") + shapes.labels[i], fontsize=9)
    bar = figure.colorbar(plt.cm.ScalarMappable(norm, MAP), ax=axes, shrink=0.8, aspect=30)
    bar.set_label("displacement / maximum [-]")
    single = panels[0][0].body + ": " if not several else ""
    figure.suptitle(f"{single}{panels[0][0].what} on the undeformed body (grey)", fontsize=11)
    save(figure, path, dpi, 256)
