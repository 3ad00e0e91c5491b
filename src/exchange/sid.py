"""Standard Input Data of a flexible body (Wallrapp 1993; Schwertassek and Wallrapp 1999), with terms of first order.

Conventions, and where geometric stiffness comes from: docs/exchange.md.
"""
import math

import numpy as np

import geometric_stiffness
import inertia_terms
from reduced_body import Fault, in_space, on_columns

INDENT = "    "


def number(value):
    """Fortran's 1.5D+00, with all digits of a double."""
    return f"{value: .16E}".replace("E", "D")


def taylor(name, nq, m0, m1=None, depth=2):
    """Lines of an expansion m0 + sum_i m1[:, i, :] q_i; zeros are not written.

    structure: 0 for zero, 3 for a full matrix. m1 is rows x coordinates x columns.
    """
    nrow, ncol = m0.shape
    first = m1 is not None and np.any(m1)
    lines = [f"{INDENT * depth}{name}"]
    inner = INDENT * (depth + 1)
    for key, value in (("order", int(first)), ("nrow", nrow), ("ncol", ncol), ("nq", nq), ("nqn", 0),
                       ("structure", 3 if first or np.any(m0) else 0)):
        lines.append(f"{inner}{key:<22}= {value:4d}")
    lines += [f"{inner}{f'm0( {r + 1}, {c + 1})':<22}={number(m0[r, c])}" for r, c in np.argwhere(m0)]
    if first:
        for r, i, c in np.argwhere(m1):
            lines.append(f"{inner}{f'm1( {r + 1}, {i + 1}, {c + 1})':<22}={number(m1[r, i, c])}")
    return lines + [f"{INDENT * depth}end {name}"]


def six(J):
    """xx, yy, zz, xy, xz, yz of the first and last axis, as a column."""
    rows = [J[0, ..., 0], J[1, ..., 1], J[2, ..., 2], J[0, ..., 1], J[0, ..., 2], J[1, ..., 2]]
    return np.stack(rows)[..., None]


def skew(v):
    """v~, for each column of a 3 x k: 3 x k x 3."""
    x, y, z = v
    o = np.zeros_like(x)
    return np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(0, 2, 1)


def by_load(stiffnesses):
    """n x k x k, symmetric -> k x k x n."""
    return stiffnesses.transpose(1, 2, 0)


def by_axis(blocks):
    """Columns of rows x 3k, three for each coordinate, as k for each axis."""
    rows = len(blocks)
    return blocks.reshape(rows, -1, 3).transpose(0, 2, 1).reshape(rows, -1)


def terms(whole, body, stiffness_of, axis_first):
    """All expansions of the body, name -> (m0, m1 or None).

    @param whole         the body with all its columns, whose stresses stiffness_of knows; reference loads are its
    @param body          on the columns that stay
    @param stiffness_of  loads on all columns -> n x k x k on those that stay
    @param axis_first    columns of Gr and Ge: all coordinates of an axis together, as FEMBS has them, else all axes of a
                         coordinate
    """
    ordered = by_axis if axis_first else lambda blocks: blocks
    geometric = lambda reference: by_load(stiffness_of(-reference))  # noqa: E731  inertia acts against acceleration
    return {
        "mdCM": (body.s0[:, None], body.S[:, :, None]),
        "J": (six(inertia_terms.J0(body)), six(inertia_terms.J1(body))),
        "Ct": (body.S.T, geometric(whole.S.T) + body.Q.transpose(1, 2, 0)),
        "Cr": (inertia_terms.Cr0(body), inertia_terms.Cr1(body) + geometric(inertia_terms.Cr0(whole))),
        "Me": (body.mass_matrix, None),
        "Gr": (ordered(inertia_terms.Gr0(body)), None),
        "Ge": (ordered(inertia_terms.Ge0(body)), None),
        "Oe": (inertia_terms.Oe0(body), inertia_terms.Oe1(body) + geometric(inertia_terms.Oe0(whole))),
        "ksigma": (np.zeros((body.k, 1)), None),
        "Ke": (body.stiffness, None),
        "De": (body.damping, None),
    }


def node(whole, body, stiffness_of, i):
    """Expansions of place i, likewise; rows of phi and psi carry the stiffness of a unit force and moment there."""
    return {
        "origin": (body.x[i][:, None], body.place_S[i][:, :, None]),
        "phi": (body.place_S[i], -stiffness_of(whole.place_S[i].T)),
        "psi": (body.place_psi[i], -stiffness_of(whole.place_psi[i].T)),
        "AP": (np.eye(3), skew(body.place_psi[i])),
    }


def frequency(body, i):
    omega = body.omega[i] or math.sqrt(max(body.stiffness[i, i], 0) / body.mass_matrix[i, i])
    return omega / (2 * math.pi)


def one_line(text):
    return " ".join(text.split())


def heading(body, geometric, all_columns):
    about = [f"reduced body {one_line(body.name)}, written by floe",
             "with geometric stiffness of first order" if geometric else "no geometric stiffness",
             "ksigma = 0",
             "all columns" if all_columns else "modes and attachment modes only"]
    about += [f"node {i + 1} is {one_line(name)}" for i, name in enumerate(body.places)]
    return f"{len(body.places):5d} {body.k:5d}    :No. nodes, No. modes: " + "; ".join(about)


def lines_of(whole, geometric, all_columns, axis_first):
    whole = in_space(whole)
    all_stiffness = (geometric_stiffness.geometric_stiffness if geometric else geometric_stiffness.none)(whole)
    chosen = [i for i, kind in enumerate(whole.kinds) if all_columns or kind != "derivative"]
    if chosen != list(range(len(chosen))):  # the basis was orthonormalised in its order
        raise Fault("a derivative precedes a mode or attachment mode, which contains a part of it; use --columns all")
    body = on_columns(whole, chosen)

    def stiffness_of(loads):
        return all_stiffness(loads)[:, chosen][:, :, chosen]

    yield heading(body, geometric, all_columns)
    yield from ["part", f"{INDENT}new modal = ", f"{INDENT * 2}refmod"]
    yield from [f"{INDENT * 3}{'mass':<22}={number(body.m)}", f"{INDENT * 3}{'nelastq':<22}= {body.k:4d}"]
    for i, label in enumerate(body.labels):
        name = "" if body.kinds[i] == "mode" else f" {one_line(label)}"
        yield f"{INDENT * 3}{f'ielastq ({i + 1:4d})':<22}= Eigen Mode {i + 1:4d} : {frequency(body, i):12.6g} Hz{name}"
    yield from [f"{INDENT * 2}end refmod", f"{INDENT * 2}frame"]
    for i in range(len(body.places)):
        yield from [f"{INDENT * 3}new node              = {i + 1:4d}", f"{INDENT * 4}{'rframe':<22}= body ref"]
        for name, expansion in node(whole, body, stiffness_of, i).items():
            yield from taylor(name, body.k, *expansion, depth=4)
        yield f"{INDENT * 3}end node"
    yield f"{INDENT * 2}end frame"
    for name, expansion in terms(whole, body, stiffness_of, axis_first).items():
        yield from taylor(name, body.k, *expansion)
    yield from [f"{INDENT}end modal", "end part"]


def write(path, body, geometric=True, all_columns=False, axis_first=True):
    """@param geometric  whether the terms of first order hold geometric stiffness
    @param all_columns  else modes and static columns; the derivatives then act by geometric stiffness alone
    @param axis_first   of terms()"""
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(line + "\n" for line in lines_of(body, geometric, all_columns, axis_first))
