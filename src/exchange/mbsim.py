"""A flexible body of MBSim: XML with its nonlinear stiffness (FlexibleFfrBody), or HDF5 (ExternalFlexibleFfrBody)."""
from xml.sax.saxutils import quoteattr

import numpy as np

from reduced_body import in_space

FLEXIBLE = "http://www.mbsim-env.de/MBSimFlexibleBody"
MBSIM = "http://www.mbsim-env.de/MBSim"
VALUES = "http://www.mbsim-env.de/MBXMLUtils"


def nonlinear_stiffness(body):
    """Knl1 (k x k x k) and Knl2 (k x k x k x k), first indices those of the arrays. MBSim's elastic force is

        (K + sum_i q_i (Knl1_i' + 1/2 Knl1_i) + 1/2 sum_ij q_i q_j Knl2_ij) q,

    the gradient of 1/2 q'Kq + (Lq).b + 1/2 |b|^2, b = 1/2 q'Bq, with Knl1_i = L'B_i and Knl2_ij = B_i'B_j.
    """
    L, B = body.linear_strain, body.bilinear_strain
    return np.einsum("ra,rib->iab", L, B), np.einsum("ria,rjb->ijab", B, B, optimize=True)


class Writer:
    """Elements with indentation."""

    def __init__(self, file):
        self.file, self.depth = file, 0

    def line(self, text):
        self.file.write("  " * self.depth + text + "\n")

    def element(self, name, content, attributes=""):
        """@param content  called to write what is in it"""
        self.line(f"<{name}{attributes}>")
        self.depth += 1
        content()
        self.depth -= 1
        self.line(f"</{name}>")

    def value(self, name, array):
        """A scalar, a vector or a matrix; of more dimensions an array of arrays (ele, or rows of ele)."""
        array = np.asarray(array)
        if array.ndim == 0:
            self.line(f"<{name}>{float(array)!r}</{name}>")
        elif array.ndim <= 2:
            kind, inner = ("xmlVector", self.numbers) if array.ndim == 1 else ("xmlMatrix", self.rows)
            self.element(name, lambda: self.element(kind, lambda: inner(array), f' xmlns="{VALUES}"'))
        else:
            self.element(name, lambda: self.array(array))

    def array(self, array):
        for each in array:
            if array.ndim == 3:
                self.value("ele", each)
            else:
                self.element("row", lambda: self.array(each))  # noqa: B023  called at once

    def vectors(self, name, arrays):
        """An array of vectors."""
        self.element(name, lambda: [self.value("ele", each) for each in arrays])

    def numbers(self, vector):
        self.line("".join(f"<ele>{x.item()!r}</ele>" for x in vector))

    def rows(self, matrix):
        for row in matrix:
            self.line("<row>" + "".join(f"<ele>{float(x)!r}</ele>" for x in row) + "</row>")


def motion(out, planar):
    """Three or six coordinates of the floating frame."""
    for of, function in (("Translation", "TranslationAlongAxesXY" if planar else "TranslationAlongAxesXYZ"),
                         ("Rotation", "RotationAboutZAxis" if planar else "RotationAboutAxesXYZ")):
        out.element(f"stateDependent{of}", lambda: out.line(f'<{function} xmlns="{MBSIM}"/>'))  # noqa: B023


def frames(out, body):
    def one(number):
        out.line(f"<nodeNumber>{number}</nodeNumber>")

    for i, name in enumerate(body.places):
        out.element("NodeFrame", lambda: one(i + 1), f" name={quoteattr(name)}")  # noqa: B023


def write_xml(path, body):
    """One element, to be put among the objects of an MBSim model or embedded there; its order is that of the schema."""
    planar, body = len(body.s0) == 2, in_space(body)

    def content():
        for name, value in (
                ("mass", body.m), ("positionIntegral", body.s0), ("positionPositionIntegral", body.C0),
                ("shapeFunctionIntegral", body.S), ("positionShapeFunctionIntegralArray", body.h),
                ("shapeFunctionShapeFunctionIntegralArray", body.M), ("stiffnessMatrix", body.stiffness),
                ("dampingMatrix", body.damping)):
            if name != "dampingMatrix" or np.any(value):
                out.value(name, value)
        if len(body.pairs):
            first, second = nonlinear_stiffness(body)
            out.value("nonlinearStiffnessMatrixOfFirstOrderArray", first)
            out.value("nonlinearStiffnessMatrixOfSecondOrderArray", second)
        if body.places:
            out.value("nodeNumbers", np.arange(1, len(body.places) + 1))
            out.vectors("nodalRelativePositionArray", body.x)
            out.value("nodalShapeMatrixOfTranslationArray", body.place_S)
            out.value("nodalShapeMatrixOfRotationArray", body.place_psi)
        motion(out, planar)
        if body.places:
            out.element("frames", lambda: frames(out, body))
        else:
            out.line("<frames/>")
        out.line("<contours/>")

    with open(path, "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0" encoding="UTF-8"?>\n')
        out = Writer(file)
        out.element("FlexibleFfrBody", content, f' xmlns="{FLEXIBLE}" name={quoteattr(body.name)}')


def write_hdf5(path, body):
    """The input data file of ExternalFlexibleFfrBody: the linear body, because that reader supports no nonlinear stiffness."""
    import h5py
    body = in_space(body)
    upper = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
    content = {
        "mass": body.m, "position integral": body.s0, "position position integral": body.C0,
        "shape function integral": body.S, "stiffness matrix": body.stiffness,
        "position shape function integral": body.h.reshape(9, -1),
        "shape function shape function integral": np.concatenate([body.M[a, b] for a, b in upper]),
    }
    if np.any(body.damping):
        content["damping matrix"] = body.damping
    if body.places:
        content["node numbers"] = np.arange(1, len(body.places) + 1, dtype=np.int32)
        content["nodal relative position"] = body.x.reshape(-1)
        content["nodal shape matrix of translation"] = body.place_S.reshape(-1, body.k)
        content["nodal shape matrix of rotation"] = body.place_psi.reshape(-1, body.k)
    # MBSim's reader goes through groups and attributes in the order of their creation, which HDF5 does not keep unasked.
    with h5py.File("memory", "w", driver="core", backing_store=False, track_order=True) as file:
        ordered = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        ordered.set_attr_creation_order(h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED)
        for name, value in content.items():
            value = np.asarray(value)
            space, kind = h5py.h5s.create_simple(value.shape), h5py.h5t.py_create(value.dtype, logical=True)
            h5py.h5d.create(file.id, name.encode(), kind, space, dcpl=ordered).write(
                h5py.h5s.ALL, h5py.h5s.ALL, np.ascontiguousarray(value))
        file.flush()
        image = file.id.get_file_image()
    with open(path, "wb") as target:  # whose faults, unlike HDF5's, can be reported
        target.write(image)
