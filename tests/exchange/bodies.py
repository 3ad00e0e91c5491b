"""Small bodies for the tests of floe export, and what the file of a reduced body says, without the writers' code."""
import subprocess

import h5py
import numpy as np

# In the plane, clamped at its frame's origin: L = EI = rhoA = 1, radius of gyration 1e-3.
CANTILEVER = """
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 16}}
    section: {EA: 1e6, EI: 1, rhoA: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 5, derivatives: all}
joints: {root: {type: fixed, between: [ground, beam.start]}}
motion: {end: 1, step: 1e-3}
"""

# The same between two supports, in the frame of its chord.
PINNED = CANTILEVER.replace("{type: clamped, at: start}", "{type: pinned, from: start, to: end}")

# In space: shells, a static column at an edge, damping.
PLATE = """
bodies:
  plate:
    mesh: {plate: {along: [0.4, 0, 0], across: [0, 0.2, 0], elements: [4, 2]}}
    section: {thickness: 2e-3}
    material: {E: 7e10, nu: 0.3, rho: 2700}
    reduction: {modes: 3, derivatives: all}
    damping: {mass: 0.5, stiffness: 1e-5}
joints: {root: {type: fixed, between: [ground, plate.left]}}
loads: {tip: {type: force, at: plate.p3, force: [0, 0, 1]}}
motion: {end: 0.05, step: 1e-3}
"""

# In space, oblique: beams whose sections rotate.
BLADE = """
bodies:
  blade:
    mesh: {polyline: {points: [[0, 0, 0], [0.7, 0.1, 0.2], [1, 0.4, 0.1]], elements: [4, 3]}}
    section: {A: 1, Iy: 0.002, Iz: 0.01, J: 0.004, orientation: [0.1, 1, 0]}
    material: {E: 1e3, G: 400, rho: 1}
    frame: {type: clamped, at: start}
    reduction: {modes: 4, derivatives: all}
joints: {root: {type: fixed, between: [ground, blade.start]}}
motion: {end: 1, step: 1e-3}
"""

FINE = CANTILEVER.replace("elements: 16", "elements: 32").replace("modes: 5", "modes: 8")
SCENES = {"blade": BLADE, "cantilever": CANTILEVER, "fine": FINE, "pinned": PINNED, "plate": PLATE}


def floe(program, folder, *words, code=0):
    done = subprocess.run([str(program), *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


def make(program, folder):
    for name, text in SCENES.items():
        (folder / f"{name}.yaml").write_text(text)
        floe(program, folder, "reduce", f"{name}.yaml", "-o", f"{name}.h5")


class Truth:
    """A body by its file: energy as the file's description states it, and masses at points that have its constants."""

    def __init__(self, path):
        self.file = h5py.File(path, "r")
        get = lambda name: self.file[name][()]  # noqa: E731
        self.bending, self.F, self.pairs = get("elasticity/bending"), get("elasticity/F"), get("elasticity/pairs")
        self.k, self.d = len(self.bending), int(get("body/dimension"))
        self.m = float(get("inertia/m"))
        self.damping = get("damping")
        self.omega = get("frequencies/omega")
        self.places = [name.rstrip(b"\0").decode() for name in get("places/names")]
        kept = get("columns/kept") == 1
        self.kinds = [kind.rstrip(b"\0").decode() for kind in get("columns/kind")[kept]]
        self.x, self.S, self.psi = (self.in_space(get(f"places/{name}"), 1) for name in ("x", "S", "psi"))
        if self.d == 2:  # turns about z
            self.psi = np.zeros_like(self.S)
            self.psi[:, 2] = get("places/psi")[:, 0]
        self.points()
        W = get("inertia/W") if "inertia/W" in self.file else np.zeros((self.d, self.d, self.k, self.k))
        self.W = self.in_space(self.in_space(W, 0), 1)

    def in_space(self, array, axis):
        width = [(0, 0)] * array.ndim
        width[axis] = (0, 3 - array.shape[axis]) if array.shape[axis] < 3 else (0, 0)
        return np.pad(array, width)

    def points(self):
        """The Gram matrix of the functions 1, x_a, N_ai under the mass, factored: point masses 1 (p of them) at which
        they have the values one (p), place (p x 3), N (p x 3 x k)."""
        d, k = self.d, self.k
        get = lambda name: self.file[f"inertia/{name}"][()]  # noqa: E731
        n = 1 + d + d * k
        gram = np.zeros((n, n))
        gram[0, 0] = get("m")
        gram[0, 1:1 + d] = get("s0")
        gram[0, 1 + d:] = get("S").reshape(-1)
        gram[1:1 + d, 1:1 + d] = get("C0")
        gram[1:1 + d, 1 + d:] = get("h").reshape(d, d * k)
        gram[1 + d:, 1 + d:] = get("M").transpose(0, 2, 1, 3).reshape(d * k, d * k)
        gram = np.triu(gram) + np.triu(gram, 1).T
        values, vectors = np.linalg.eigh(gram)
        assert values[0] > -1e-12 * values[-1], "a mass distribution's Gram matrix is not negative"
        Y = vectors * np.sqrt(np.maximum(values, 0))
        self.one = Y[0]
        self.place = self.in_space(Y[1:1 + d].T, 1)
        self.N = self.in_space(Y[1 + d:].reshape(d, k, n).transpose(2, 0, 1), 1)

    def velocity(self, q, motion):
        """Of each point, body axes; motion = (v, omega, q')."""
        v, omega, rate = motion[:3], motion[3:6], motion[6:]
        return self.one[:, None] * v + np.cross(omega, self.place + self.N @ q) + self.N @ rate

    def rotary(self, q, p):
        """int rho a x n(q, p), n the displacement of second order of sections that rotate, twice."""
        W = np.einsum("abij,i,j->ab", self.W, q, p)
        return np.array([W[1, 2] - W[2, 1], W[2, 0] - W[0, 2], W[0, 1] - W[1, 0]])

    def mass_matrix(self, q):
        """Of (v, omega, q'): the Hessian of the kinetic energy."""
        columns = np.array([self.velocity(q, e).reshape(-1) for e in np.eye(6 + self.k)])
        mass = columns @ columns.T
        C = np.einsum("abij,i,j->ab", self.W, q, q)
        mass[3:6, 3:6] += np.trace(C) * np.eye(3) - (C + C.T) / 2
        for i, e in enumerate(np.eye(self.k)):
            mass[3:6, 6 + i] += self.rotary(q, e)
            mass[6 + i, 3:6] += self.rotary(q, e)
        return mass

    def quadratic(self, q, omega, rate):
        """What the equations of motion hold beside mass matrix x accelerations (a, alpha, q''), from the kinetic energy
        by Lagrange's and Euler's equations at v = 0."""
        motion = np.concatenate([np.zeros(3), omega, rate])
        step = 1.0  # differences of what is quadratic in q are exact
        along = (self.mass_matrix(q + step * rate) - self.mass_matrix(q - step * rate)) / (2 * step)
        momentum = self.mass_matrix(q) @ motion
        force = along @ motion
        force[:3] += np.cross(omega, momentum[:3])
        force[3:6] += np.cross(omega, momentum[3:6])
        for i, e in enumerate(np.eye(self.k)):
            energy = [0.5 * motion @ self.mass_matrix(q + s * step * e) @ motion for s in (1, -1)]
            force[6 + i] -= (energy[0] - energy[1]) / (2 * step)
        return force

    def energy(self, q):
        s = np.array([q[a] * q[b] * (0.5 if a == b else 1) for a, b in self.pairs])
        return 0.5 * q @ self.bending @ q + 0.5 * np.sum((self.F @ np.concatenate([q, s])) ** 2)

    def stiffness(self, at=None):
        """The Hessian of the energy, a quartic: the chain rule for z = (q, s(q))."""
        q = np.zeros(self.k) if at is None else at
        Z = np.zeros((self.k + len(self.pairs), self.k))
        Z[:self.k] = np.eye(self.k)
        s = np.zeros(len(self.pairs))
        for p, (a, b) in enumerate(self.pairs):
            s[p] = q[a] * q[b] * (0.5 if a == b else 1)
            Z[self.k + p, a] += q[b]
            if a != b:
                Z[self.k + p, b] += q[a]
        weight = self.F.T @ (self.F @ np.concatenate([q, s]))
        K = self.bending + Z.T @ (self.F.T @ self.F) @ Z
        for p, (a, b) in enumerate(self.pairs):
            K[a, b] += weight[self.k + p]
            if a != b:
                K[b, a] += weight[self.k + p]
        return K


def frequencies(K, M):
    half = np.linalg.inv(np.linalg.cholesky(M))
    return np.sqrt(np.linalg.eigvalsh(half @ K @ half.T))


def close(found, expected, tolerance, what=""):
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    assert found.shape == expected.shape, (what, found.shape, expected.shape)
    scale = np.max(np.abs(expected), initial=0) or 1.0
    error = np.max(np.abs(found - expected), initial=0) / scale
    assert error <= tolerance, f"{what}: off by {error:.3g} of the greatest number, allowed {tolerance:.3g}"
