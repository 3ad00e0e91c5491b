"""NumPy's .npz with the names of docs/exchange.md: what the reduced body's file holds, and the linear K and M."""
import io

import numpy as np

from reduced_body import from_hdf5, texts

ARRAYS = {
    "dimension": "body/dimension", "dofs": "body/dofs", "nodes": "body/nodes", "cells": "body/cells",
    **{name: f"inertia/{name}" for name in ("m", "s0", "C0", "S", "h", "M")},
    **{f"line_{name}": f"line/{name}" for name in ("m", "s0", "C0", "S", "h", "M")},
    **{name: f"elasticity/{name}" for name in ("bending", "F", "pairs")}, "damping": "damping",
    **{f"place_{name}": f"places/{name}" for name in ("x", "S", "psi")},
    **{f"column_{name}": f"columns/{name}" for name in ("omega", "new_part", "kept", "interaction")},
    "omega": "frequencies/omega", "residual": "frequencies/residual",
    "frame_origin": "frame/origin", "frame_axes": "frame/axes",
}
TEXTS = {
    "name": "body/name", "place_names": "places/names", "column_kind": "columns/kind", "column_label": "columns/label",
    "frame_kind": "frame/kind", **{f"made_{name}": f"made/{name}" for name in ("version", "commit", "date", "scene")},
}
SHAPE_ARRAYS = {
    "shape_positions": "shapes/positions", "shape_basis": "shapes/basis", "cell_nodes": "shapes/cells/nodes",
    "cell_kind": "shapes/cells/kind", "cell_part": "shapes/cells/part", "set_start": "shapes/sets/start",
    "set_nodes": "shapes/sets/nodes",
}
SHAPE_TEXTS = {"part_names": "shapes/parts", "set_names": "shapes/sets/names"}


def words(dataset):
    if dataset.shape == ():
        return np.array(texts(dataset)[0])
    return np.array(texts(dataset) if dataset.shape[0] else [], dtype=str)


def write(path, source, shapes=False):
    """@param source  the open HDF5 file"""
    body = from_hdf5(source)
    content = {"format": np.array("floe reduced body"), "version": np.array(5), "Q": body.Q, "W": body.W, "place_Q": body.place_Q,
               "strain_rate_damping": source["strain_rate_damping"][()] if "strain_rate_damping" in source else np.array(0.0)}
    if len(body.s0) == 3:
        content["place_H"] = source["places/H"][()] if "places/H" in source else np.zeros((len(body.places), 3, 3, 3))
    content.update({name: source[at][()] for name, at in ARRAYS.items()})
    content.update({name: words(source[at]) for name, at in TEXTS.items()})
    content.update(stiffness=body.stiffness, mass=body.mass_matrix, coordinate_label=np.array(body.labels, dtype=str),
                   coordinate_kind=np.array(body.kinds, dtype=str))
    if shapes:
        content.update({name: source[at][()] for name, at in SHAPE_ARRAYS.items()})
        content.update({name: words(source[at]) for name, at in SHAPE_TEXTS.items()})
    with io.BytesIO() as memory:
        np.savez_compressed(memory, **content)
        with open(path, "wb") as file:
            file.write(memory.getvalue())
