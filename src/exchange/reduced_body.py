"""A reduced body as `floe reduce` wrote it: plain arrays, and the same body in three dimensions."""
import contextlib
import dataclasses

import numpy as np


class Fault(Exception):
    """Something that the user should read, in one line."""


@contextlib.contextmanager
def damage(path):
    """@throws Fault  for what reading a file runs into that is not what floe wrote; h5py's OSErrors have no number"""
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, MemoryError, RuntimeError, TypeError, ValueError,
            OSError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise Fault(f"{path}: is damaged: {' '.join(str(error).split())} (see floe info)") from None


@dataclasses.dataclass
class Body:
    """The constants of docs/exchange.md: k coordinates q, d = 2 or 3."""
    name: str
    m: float
    s0: np.ndarray  # d
    C0: np.ndarray  # d x d
    S: np.ndarray  # d x k
    h: np.ndarray  # d x d x k
    M: np.ndarray  # d x d x k x k
    Q: np.ndarray  # d x k x k, first moments of second order; zero: none, or a file of a version before 4
    W: np.ndarray  # d x d x k x k, rotary inertia of second order; zero: none, or a file of version 1
    bending: np.ndarray  # k x k
    F: np.ndarray  # r x (k + pairs)
    pairs: np.ndarray  # pairs x 2, from 0
    damping: np.ndarray  # k x k, zero for none
    places: list  # names
    x: np.ndarray  # places x d
    place_S: np.ndarray  # places x d x k
    place_psi: np.ndarray  # places x 1 or 3 x k
    place_Q: np.ndarray  # places x d x k x k, displacement 1/2 q'Qq of second order at arms; zero: none, or before version 4
    kinds: list  # of each coordinate: mode, attachment, derivative
    labels: list
    omega: np.ndarray  # of each coordinate, 0 unless it is a mode

    @property
    def k(self):
        return len(self.bending)

    @property
    def mass_matrix(self):
        return np.einsum("aaij->ij", self.M)

    @property
    def linear_strain(self):
        """L, r x k: F z = L q + 1/2 q'B q."""
        return self.F[:, :self.k]

    @property
    def bilinear_strain(self):
        """B, r x k x k, symmetric."""
        B = np.zeros((len(self.F), self.k, self.k))
        for column, (a, b) in zip(self.F[:, self.k:].T, self.pairs):
            B[:, a, b] = B[:, b, a] = column
        return B

    @property
    def stiffness(self):
        return self.bending + self.linear_strain.T @ self.linear_strain


def open_file(path):
    """The HDF5 file. @throws Fault  not there, not a whole reduced body of a version that is known"""
    import h5py
    import os
    if not os.path.exists(path):
        raise Fault(f"{path}: does not exist")
    if not os.path.isfile(path):
        raise Fault(f"{path}: expected a file written by floe reduce, found a folder")
    try:
        file = h5py.File(path, "r")
    except OSError:
        raise Fault(f"{path}: expected a file written by floe reduce, found one that is not HDF5 or is cut "
                    "off") from None
    found = file.attrs.get("format")
    if not isinstance(found, bytes) or found.rstrip(b"\0") != b"floe reduced body":
        file.close()
        raise Fault(f"{path}: expected a file written by floe reduce, found an HDF5 file of another kind")
    for name, wanted, what in (("version", (1, 2, 3, 4, 5), "of another version of the format"),
                               ("complete", (1,), "that is incomplete")):
        if file.attrs.get(name) not in wanted:
            file.close()
            raise Fault(f"{path}: expected a complete reduced body of version 1 to 5; found one {what}")
    return file


def texts(dataset):
    return [word.rstrip(b"\0").decode() for word in np.atleast_1d(dataset[()])]


def read(path):
    """@throws Fault  as open_file; datasets that are missing or do not fit"""
    with damage(path), open_file(path) as file:
        body = from_hdf5(file)
    for field in dataclasses.fields(body):
        value = getattr(body, field.name)
        if isinstance(value, np.ndarray) and value.dtype.kind == "f" and not np.isfinite(value).all():
            raise Fault(f"{path}: is damaged: numbers that are not finite in {field.name} (see floe info)")
    return body


def from_hdf5(file):
    bending = file["elasticity/bending"][:]
    k = len(bending)
    kept = np.flatnonzero(file["columns/kept"][:])
    kinds, labels, omega = texts(file["columns/kind"]), texts(file["columns/label"]), file["columns/omega"][:]
    damping = file["damping"][:]
    inertia = {name: file[f"inertia/{name}"][()] for name in ("m", "s0", "C0", "S", "h", "M")}
    d = len(inertia["s0"])
    inertia["Q"] = file["inertia/Q"][()] if "inertia/Q" in file else np.zeros((d, k, k))
    inertia["W"] = file["inertia/W"][()] if "inertia/W" in file else np.zeros((d, d, k, k))
    F, pairs = file["elasticity/F"][:], file["elasticity/pairs"][:]
    names = texts(file["places/names"]) if file["places/names"].shape[0] else []
    x, place_S, place_psi = (file[f"places/{name}"][:] for name in ("x", "S", "psi"))
    place_Q = file["places/Q"][:] if "places/Q" in file else np.zeros((len(names), d, k, k))
    for name, value, shape in (
            ("elasticity/bending", bending, (k, k)), ("elasticity/F", F, (len(F), k + len(pairs))),
            ("inertia/S", inertia["S"], (d, k)), ("inertia/Q", inertia["Q"], (d, k, k)), ("inertia/M", inertia["M"], (d, d, k, k)), ("inertia/W", inertia["W"], (d, d, k, k)),
            ("inertia/h", inertia["h"], (d, d, k)), ("columns/kept", kept, (k,)),
            ("damping", damping, (k, k) if damping.size else damping.shape),
            ("places/x", x, (len(names), d)), ("places/S", place_S, (len(names), d, k)),
            ("places/Q", place_Q, (len(names), d, k, k)),
            ("places/psi", place_psi, (len(names), 1 if d == 2 else 3, k))):
        if value.shape != shape:
            raise ValueError(f"{name}: expected {shape}, found {value.shape}")
    if np.any(pairs < 0) or np.any(pairs >= k):
        raise ValueError(f"elasticity/pairs: expected numbers from 0 to {k - 1}")
    return Body(name=texts(file["body/name"])[0], **{**inertia, "m": float(inertia["m"])}, bending=bending, F=F,
                pairs=pairs, damping=damping if damping.size else np.zeros((k, k)), places=names,
                x=x, place_S=place_S, place_psi=place_psi, place_Q=place_Q,
                kinds=[kinds[i] for i in kept], labels=[labels[i] for i in kept], omega=omega[kept])


def padded(array, axes):
    """Zero along z on these axes."""
    return np.pad(array, [(0, 1 if axis in axes else 0) for axis in range(array.ndim)])


def in_space(body):
    """A body of the plane with z = 0, which does not move along z and turns about z; one in space as it is.

    What its sections hold out of the plane it does not know: C0_zz = 0.
    """
    if len(body.s0) == 3:
        return body
    psi = np.zeros((len(body.places), 3, body.k))
    psi[:, 2] = body.place_psi[:, 0]
    return dataclasses.replace(body, s0=padded(body.s0, [0]), C0=padded(body.C0, [0, 1]), S=padded(body.S, [0]),
                               h=padded(body.h, [0, 1]), M=padded(body.M, [0, 1]), W=padded(body.W, [0, 1]), Q=padded(body.Q, [0]), x=padded(body.x, [1]),
                               place_S=padded(body.place_S, [1]), place_Q=padded(body.place_Q, [1]), place_psi=psi)


def on_columns(body, chosen):
    """The linear body on some of the coordinates, the others held at zero."""
    pick = np.ix_(chosen, chosen)
    return dataclasses.replace(
        body, S=body.S[:, chosen], h=body.h[:, :, chosen], M=body.M[:, :, chosen][:, :, :, chosen],
        Q=body.Q[:, chosen][:, :, chosen], W=body.W[:, :, chosen][:, :, :, chosen],
        bending=body.stiffness[pick], F=np.zeros((0, len(chosen))), pairs=np.zeros((0, 2), int),
        damping=body.damping[pick], place_S=body.place_S[:, :, chosen], place_psi=body.place_psi[:, :, chosen],
        place_Q=body.place_Q[:, :, chosen][:, :, :, chosen],
        kinds=[body.kinds[i] for i in chosen], labels=[body.labels[i] for i in chosen], omega=body.omega[chosen])
