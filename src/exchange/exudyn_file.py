"""An .npz with the parameters of Exudyn's ObjectFFRFreducedOrder, by their names there; load_in_exudyn.py makes the object.

Zwoelfer and Gerstmayr 2020, nodal-based floating frame of reference with modal reduction: with ~ for the skew matrix of
each nodal vector of the modes Psi and of the nodes' places x, all by integrals over the mass instead of sums over nodes.
"""
import io

import numpy as np

import inertia_terms
from reduced_body import in_space, on_columns


def skew(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def side_by_side(blocks):
    """k blocks of 3 x 3 as 3 x 3k."""
    return np.concatenate(blocks, axis=1) if len(blocks) else np.zeros((3, 0))


def inertia(body):
    """The matrices of the quadratic velocity vector, from ~u' v = -u x v and ~u' ~v = (u.v) 1 - v u'."""
    k, trace = body.k, np.einsum("aa...->...", body.M)
    crossed = np.stack([body.M[c, b] - body.M[b, c] for _, b, c in inertia_terms.CYCLIC], axis=1)  # -int psi_j x psi_i
    both = np.einsum("ab,ji->jaib", np.eye(3), trace) - np.einsum("baji->jaib", body.M)
    return {
        "mPsiTildePsi": crossed.reshape(3 * k, k),
        "mPsiTildePsiTilde": both.reshape(3 * k, 3 * k),
        "mPhitTPsi": body.S,
        "mPhitTPsiTilde": side_by_side([skew(body.S[:, j]) for j in range(k)]),
        "mXRefTildePsi": -inertia_terms.Cr0(body).T,
        "mXRefTildePsiTilde": side_by_side([np.eye(3) * np.trace(body.h[:, :, j]) - body.h[:, :, j].T for j in range(k)]),
    }


def nodes_of(source, body, kept):
    """Places and displacements of all nodes of the mesh, else of the named places: n x 3, n x 3 x k."""
    if not source.attrs["shapes"]:
        return body.x, body.place_S
    basis = source["shapes/basis"][()][kept]  # k x n x dofs
    moves = 3 if basis.shape[2] == 6 else 2
    modes = np.zeros((basis.shape[1], 3, len(basis)))
    modes[:, :moves] = basis[:, :, :moves].transpose(1, 2, 0)
    return source["shapes/positions"][()], modes


def content_of(source, whole, all_columns):
    chosen = [i for i, kind in enumerate(whole.kinds) if all_columns or kind != "derivative"]
    body = on_columns(in_space(whole), chosen)
    x, modes = nodes_of(source, body, chosen)
    nearest = [int(np.argmin(np.linalg.norm(x - place, axis=1))) for place in body.x]
    return {
        "format": "floe body for Exudyn", "name": body.name, "placeNames": np.array(body.places, dtype=str),
        "placeNodes": np.array(nearest, dtype=int), "coordinateLabels": np.array(body.labels, dtype=str),
        "frameOrigin": np.pad(source["frame/origin"][()], (0, 3 - len(source["frame/origin"]))),
        "frameAxes": frame_axes(source), "massMatrixReduced": body.mass_matrix,
        "stiffnessMatrixReduced": body.stiffness, "dampingMatrixReduced": body.damping,
        "modeBasis": modes.reshape(-1, body.k), "referencePositions": x.reshape(-1), "physicsMass": body.m,
        "physicsInertia": inertia_terms.J0(body), "physicsCenterOfMass": body.s0 / body.m, **inertia(body),
    }


def frame_axes(source):
    axes = np.eye(3)
    own = source["frame/axes"][()]
    axes[:len(own), :len(own)] = own
    return axes


def write(path, source, body, all_columns=False):
    """@param source  the open HDF5 file of the body"""
    with io.BytesIO() as memory:
        np.savez_compressed(memory, **content_of(source, body, all_columns))
        with open(path, "wb") as file:
            file.write(memory.getvalue())
