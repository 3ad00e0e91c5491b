"""What a run of floe left, for pictures: its summary, its probes, and the place of every node at every instant.

    x = R + A (X + a u),  u = sum_j basis_j eta_j (reduced), or the dofs of the node (full order); a enlarges

in the layout of docs/runs.md.
"""
import json
import os

import numpy as np

from style import Damaged, Fault, read_json, read_series, read_units

CORNERS = {1: 1, 3: 2, 5: 3, 9: 4}  # of VTK's kinds of cells


def open_hdf5(path):
    import h5py

    try:
        return h5py.File(path, "r", locking=False)
    except TypeError:  # an h5py that knows no locking
        return h5py.File(path, "r")
    except OSError as error:
        raise Damaged(f"{path}: cannot be read as HDF5 ({str(error).splitlines()[0][:80]})") from error


def text_of(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class Mesh:
    """Nodes and cells: lines (pairs of nodes) and faces (triangles and quadrilaterals, -1 where unused)."""

    def __init__(self, positions, nodes, kinds):
        self.positions = positions
        self.lines = nodes[kinds == 3][:, :2]
        self.faces = nodes[(kinds == 5) | (kinds == 9)]

    @classmethod
    def of(cls, group):
        return cls(group["positions"][()], group["cells/nodes"][()], group["cells/kind"][()])

    @classmethod
    def of_mixed(cls, positions, cells):
        """From XDMF's mixed topology."""
        kind_of, at, nodes, kinds = {1: 1, 2: 3, 4: 5, 5: 9}, 0, [], []
        while at < len(cells):
            kind = kind_of[int(cells[at])]
            at += 2 if kind <= 3 else 1
            corners = [int(c) for c in cells[at:at + CORNERS[kind]]]
            at += len(corners)
            nodes.append(corners + [-1] * (4 - len(corners)))
            kinds.append(kind)
        return cls(positions, np.array(nodes, int).reshape(-1, 4), np.array(kinds, int))


class Body:
    def __init__(self, name, group, dimension, in_world, attitude, coordinates=None):
        self.name, self.dimension, self.in_world, self.attitude = name, dimension, in_world, attitude
        self.frame, self.elastic = (int(c) for c in group["columns_of_motion"][()])
        start = group["frame_at_start"][()]
        self.place, self.axes = start[0], start[1:].T
        shapes = group["shapes"]
        self.mesh = Mesh.of(shapes)
        self.basis = self.dofs = None
        self.coordinates = np.inf if coordinates is None else coordinates
        if self.elastic >= 0 and "basis" in shapes:
            basis = shapes["basis"][()]
            self.basis = np.zeros((len(basis), len(self.mesh.positions), 3))
            moves = 3 if dimension == 3 else 2
            self.basis[:, :, :moves] = basis[:, :, :moves]
        if "nodes_of_motion" in group:
            rows = group["nodes_of_motion"][()]
            self.dofs, self.arms = rows[:, 0].astype(int), rows[:, 1:]

    def frame_at(self, U, attitude):
        """Origin and axes (columns) of the floating frame in the world."""
        if self.attitude is not None:
            return U[self.frame:self.frame + 3], turned(attitude[self.attitude:self.attitude + 4])
        if self.frame < 0:
            return self.place, self.axes
        c, s = np.cos(U[self.frame + 2]), np.sin(U[self.frame + 2])
        return np.array([U[self.frame], U[self.frame + 1], 0]), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])

    def deformation(self, U):
        """Of each node, in the axes of the floating frame."""
        u = np.zeros_like(self.mesh.positions)
        if self.basis is not None:
            k = min(len(self.basis), len(U) - self.elastic, self.coordinates)  # formulation vm: the first ones
            u = np.tensordot(U[self.elastic:self.elastic + k], self.basis[:k], 1)
        if self.dofs is not None:
            if self.dimension == 3 and self.in_world:  # places and rotation vectors
                arms = rotated(U[self.dofs[:, None] + np.arange(3, 6)], self.arms @ self.axes.T)
                u = U[self.dofs[:, None] + np.arange(3)] + arms - self.place - self.mesh.positions @ self.axes.T
            elif self.dimension == 3:
                u = U[self.dofs[:, None] + np.arange(3)] + np.cross(U[self.dofs[:, None] + np.arange(3, 6)], self.arms)
            else:
                turn = U[self.dofs + 2]
                u[:, 0] = U[self.dofs] - turn * self.arms[:, 1]
                u[:, 1] = U[self.dofs + 1] + turn * self.arms[:, 0]
            if self.in_world:
                u = u @ self.axes
        return u


def rotated(turns, vectors):
    """Each vector turned by its rotation vector."""
    angle = np.linalg.norm(turns, axis=1, keepdims=True)
    n = turns / np.where(angle > 0, angle, 1)
    along = np.sum(n * vectors, axis=1, keepdims=True) * n
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(n, vectors)


def turned(q):
    """Axes of a unit quaternion (w, x, y, z), as columns."""
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Joint:
    """What a joint connects: of each end the body, its node nearest to the place and the way from there, in the frame's
    axes; or a point of the ground."""

    def __init__(self, name, kind, ends):
        self.name, self.kind, self.ends = name, kind, ends

    @property
    def grounded(self):
        return any(body is None for body, *_ in self.ends)

    def at(self, run, row, amplify=1.0):
        """Places of the ends in the world; those that are known."""
        found = []
        for body, node, way in self.ends:
            if body is None and way is None:  # of the ground, where the other end is at the start
                other = next(((b, n, w) for b, n, w in self.ends if b is not None), None)
                if other:
                    found.append(run.place(*other, 0, 1.0))
            elif body is None:
                found.append(way)
            else:
                found.append(run.place(body, node, way, row, amplify))
        return found


def joints_of(file, names, bodies):
    found, known = [], {body.name: body for body in bodies}
    for joint in json.loads(text_of(file["motion/joints"][()])) if "motion/joints" in file else []:
        ends = []
        for end in joint["ends"]:
            number, x = end["body"], np.array(end["x"], float)
            body = known.get(names[number]) if number >= 0 else None
            if number >= 0 and body is None:
                continue  # without mesh in the results
            if body is None:
                ends.append((None, None, x if number == -1 else None))
                continue
            node = int(np.argmin(np.linalg.norm(body.mesh.positions - x, axis=1)))
            ends.append((body, node, x - body.mesh.positions[node]))
        if any(body is not None for body, *_ in ends):
            found.append(Joint(joint["name"], joint["kind"], ends))
    return found


class Run:
    """The folder of a run: the summary at once, the rest when it is asked for."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = read_json(os.path.join(folder, "summary.json"))
        self._bodies = None

    @property
    def title(self):
        scene = self.summary.get("scene", {})
        return scene.get("title") or scene.get("file") or self.folder

    @property
    def time_label(self):
        """Of equilibria (floe static) t is no time: loads grow with it."""
        static = self.summary.get("integration", {}).get("type") == "static"
        return "load parameter t [s]" if static else "time [s]"

    def probes(self):
        path = os.path.join(self.folder, "probes.csv")
        return read_series(path), read_units(path)

    def load(self):
        """@throws Fault  there is no motion, or one that does not say where nodes are"""
        if self._bodies is not None:
            return
        path = os.path.join(self.folder, "result.h5")
        if not os.path.exists(path):
            raise Fault(f"{path}: does not exist; expected the results of a run")
        file = open_hdf5(path)  # stays open: states are read when they are asked for
        if "motion/dimension" not in file:
            raise Fault(f"{path}: has no node positions of the bodies; run the scene again with this version")
        t = file["motion/t"][:, 0]
        rows = len(t) if np.isfinite(t).all() else int(np.argmin(np.isfinite(t)))
        if rows == 0:
            raise Fault(f"{path}: has no instant yet")
        self.t, self.U = t[:rows], file["motion/U"]
        self.energy = file["motion/energy"][:rows]
        self.constraints = file["motion/constraints"][:rows] if "motion/constraints" in file else None
        self.attitudes = file["motion/attitude"] if "motion/attitude" in file else None
        self.dimension = int(file["motion/dimension"][()])
        summary = json.loads(text_of(file["summary"][()]))
        self.scene_text = text_of(file["scene"][()])
        self.without = []
        self._bodies, frames = [], 0
        for name in (body["name"] for body in summary["bodies"]):
            group, attitude = file["bodies"][name], None
            if self.dimension == 3 and group["columns_of_motion"][0] >= 0:
                attitude = 4 * frames
                frames += 1
            try:
                group["shapes"]
            except KeyError:  # none, or the file that it is in is not there any more
                self.without.append(name)
                continue
            said = next(b for b in summary["bodies"] if b["name"] == name)
            self._bodies.append(Body(name, group, self.dimension, summary.get("formulation") == "cfr", attitude,
                                     said.get("reduced_coordinates")))
            self._bodies[-1].rigid = bool(said.get("rigid"))
        self._joints = joints_of(file, [body["name"] for body in summary["bodies"]], self._bodies)

    @property
    def bodies(self):
        self.load()
        return self._bodies

    @property
    def joints(self):
        """Joints with an end on a body that has a mesh here; none of results of versions that did not write them."""
        self.load()
        return self._joints

    def place(self, body, node, way, row, amplify):
        """A place on a body beside one of its nodes, in the world."""
        _, A = body.frame_at(self.U[row], self.attitude_at(row))
        return self.moved(body, row, amplify)[0][node] + A @ way

    @property
    def is_path(self):
        """Of equilibria along a path (floe static --path) t also falls."""
        self.load()
        return bool((np.diff(self.t) < 0).any())

    def spread_rows(self, count):
        """Rows nearest to instants at equal distances; of a path at equal distances in their numbers."""
        self.load()
        count = min(count, len(self.t))
        if self.is_path:
            rows = [int(round(row)) for row in np.linspace(0, len(self.t) - 1, count)]
        else:
            rows = [self.row_at(t) for t in np.linspace(self.t[0], self.t[-1], count)]
        return list(dict.fromkeys(rows))

    def row_at(self, t):
        self.load()
        return int(np.argmin(np.abs(self.t - t)))

    def attitude_at(self, row):
        return self.attitudes[row] if self.attitudes is not None else None

    def moved(self, body, row, amplify=1.0):
        """Places of the body's nodes, and the length of each one's deformation (not enlarged)."""
        U = self.U[row]
        R, A = body.frame_at(U, self.attitude_at(row))
        u = body.deformation(U)
        return R + (body.mesh.positions + amplify * u) @ A.T, np.linalg.norm(u, axis=1)
