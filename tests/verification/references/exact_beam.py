"""Geometrically exact plane beams without shear: absolute positions and slopes, cubic in each element.

A point of the axis is r(x), a = r', b = r''.  U = int EA/2 (|a| - 1)^2 + EI/2 (a x b / a.a)^2,  T = int rhoA/2 |r.|^2 + rhoI/2 theta.^2,
theta = atan2(a).  No rotation is assumed small, no floating frame, no mass at points: nothing is shared with floe. Newmark's
method (beta = 1/4), step and mesh halved to see the error. Gerstmayr and Irschik (J. Sound Vib. 318, 2008) use this element.
"""
import numpy as np

from ritz import gauss


class Beam:
    def __init__(self, elements, length, EA, EI, rhoA, rhoI=0.0, start=(0.0, 0.0), points=4):
        self.EA, self.EI, self.rhoA, self.rhoI = EA, EI, rhoA, rhoI
        h = length / elements
        s, w = gauss(points)
        self.w = np.tile(w * h, (elements, 1))  # element, point
        self.n = 4 * (elements + 1)
        self.dofs = 4 * np.arange(elements)[:, None] + np.arange(8)
        shape = [np.stack(f, axis=1) for f in (
            (1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, h * (s**3 - s**2)),
            ((6 * s**2 - 6 * s) / h, 1 - 4 * s + 3 * s**2, (6 * s - 6 * s**2) / h, 3 * s**2 - 2 * s),
            ((12 * s - 6) / h**2, (6 * s - 4) / h, (6 - 12 * s) / h**2, (6 * s - 2) / h))]
        self.N, self.A, self.B = (np.einsum("gi,ab->gaib", f, np.eye(2)).reshape(points, 2, 8) for f in shape)
        self.M = self.assemble(self.rhoA * np.einsum("eg,gai,gaj->eij", self.w, self.N, self.N))
        self.lumps = np.zeros(self.n)  # point masses at dofs
        self.q0 = np.zeros((elements + 1, 4))
        self.q0[:, 0] = start[0] + h * np.arange(elements + 1)
        self.q0[:, 1], self.q0[:, 2] = start[1], 1.0
        self.q0 = self.q0.ravel()

    def assemble(self, blocks):
        full = np.zeros((self.n, self.n))
        np.add.at(full, (self.dofs[:, :, None], self.dofs[:, None, :]), blocks)
        return full

    def gather(self, parts):
        full = np.zeros(self.n)
        np.add.at(full, self.dofs, parts)
        return full

    def elastic(self, q):
        """Energy, force and tangent of U."""
        e = q[self.dofs]
        a, b = np.einsum("gai,ei->ega", self.A, e), np.einsum("gai,ei->ega", self.B, e)
        n = np.einsum("ega,ega->eg", a, a)
        length = np.sqrt(n)
        t, strain = a / length[..., None], length - 1
        cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        k = cross / n
        c_a = np.stack([b[..., 1], -b[..., 0]], -1)
        k_b = np.stack([-a[..., 1], a[..., 0]], -1) / n[..., None]
        k_a = c_a / n[..., None] - 2 * (cross / n**2)[..., None] * a
        one, skew = np.eye(2), np.array([[0.0, -1.0], [1.0, 0.0]])
        outer = lambda x, y: x[..., :, None] * y[..., None, :]
        n2 = n[..., None, None]
        k_aa = (-2 * (outer(c_a, a) + outer(a, c_a)) - 2 * cross[..., None, None] * one) / n2**2 \
            + 8 * cross[..., None, None] * outer(a, a) / n2**3
        k_ba = skew / n2 - 2 * outer(k_b, a) / n2
        e_aa = (one - outer(t, t)) / length[..., None, None]
        normal, moment = self.w * self.EA * strain, self.w * self.EI * k
        f_a = normal[..., None] * t + moment[..., None] * k_a
        f_b = moment[..., None] * k_b
        w = self.w[..., None, None]
        aa = w * (self.EA * outer(t, t) + self.EI * outer(k_a, k_a)) + normal[..., None, None] * e_aa + moment[..., None, None] * k_aa
        ba = w * self.EI * outer(k_b, k_a) + moment[..., None, None] * k_ba
        bb = w * self.EI * outer(k_b, k_b)
        force = self.gather(np.einsum("gai,ega->ei", self.A, f_a) + np.einsum("gai,ega->ei", self.B, f_b))
        mixed = np.einsum("gai,egab,gbj->eij", self.B, ba, self.A, optimize=True)
        tangent = np.einsum("gai,egab,gbj->eij", self.A, aa, self.A, optimize=True) + mixed + mixed.transpose(0, 2, 1) \
            + np.einsum("gai,egab,gbj->eij", self.B, bb, self.B, optimize=True)
        return 0.5 * np.sum(normal * strain + moment * k), force, self.assemble(tangent)

    def rotary(self, q, v, acceleration):
        """Force rhoI theta.. dtheta/da of the sections, its mass matrix, and the energy."""
        if not self.rhoI:
            return np.zeros(self.n), 0.0, 0.0
        a, rate, second = (np.einsum("gai,ei->ega", self.A, x[self.dofs]) for x in (q, v, acceleration))
        n = np.einsum("ega,ega->eg", a, a)
        g = np.stack([-a[..., 1], a[..., 0]], -1) / n[..., None]
        mixed, difference = 2 * a[..., 0] * a[..., 1] / n**2, (a[..., 1] ** 2 - a[..., 0] ** 2) / n**2
        quadratic = mixed * (rate[..., 0] ** 2 - rate[..., 1] ** 2) + 2 * difference * rate[..., 0] * rate[..., 1]
        spin = np.einsum("ega,ega->eg", g, rate)
        moment = self.rhoI * self.w * (np.einsum("ega,ega->eg", g, second) + quadratic)
        force = self.gather(np.einsum("gai,ega->ei", self.A, moment[..., None] * g))
        row = np.einsum("ega,gai->egi", g, self.A)
        mass = self.assemble(self.rhoI * np.einsum("eg,egi,egj->eij", self.w, row, row))
        return force, mass, 0.5 * self.rhoI * np.sum(self.w * spin**2)

    def energy(self, q, v):
        return self.elastic(q)[0] + 0.5 * v @ (self.M @ v + self.lumps * v) + self.rotary(q, v, 0 * v)[2]


def simulate(beam, step, end, load, fixed, velocity=None, driven=None):
    """Newmark's method. load(t, q): generalised forces. fixed: dofs that stand. driven(t): dofs with their q, q., q..

    @return  (q, q.) at every step
    """
    q, v = beam.q0.copy(), np.zeros(beam.n) if velocity is None else velocity.copy()
    held = list(fixed)
    if driven:
        dofs, *state = driven(0.0)
        held += list(dofs)
        acceleration = np.zeros(beam.n)
        q[dofs], v[dofs], acceleration[dofs] = state
    else:
        acceleration = np.zeros(beam.n)
    free = np.setdiff1d(np.arange(beam.n), held)
    mass = beam.M + np.diag(beam.lumps)
    rest = load(0.0, q) - beam.elastic(q)[1] - mass @ acceleration - beam.rotary(q, v, acceleration)[0]
    inertia = mass + beam.rotary(q, v, acceleration)[1]
    acceleration[free] = np.linalg.solve(inertia[np.ix_(free, free)], rest[free])
    steps = int(round(end / step))
    history = [(q.copy(), v.copy())]
    grid = np.ix_(free, free)
    for i in range(1, steps + 1):
        t = i * step
        base = q + step * v + step**2 / 4 * acceleration
        speed = v + step / 2 * acceleration
        new = acceleration.copy()
        if driven:
            dofs, place, rate, second = driven(t)
            new[dofs] = second
        for _ in range(30):
            q, v = base + step**2 / 4 * new, speed + step / 2 * new
            if driven:
                q[dofs], v[dofs] = place, rate
            _, force, tangent = beam.elastic(q)
            turning, turning_mass, _ = beam.rotary(q, v, new)
            rest = (load(t, q) - force - mass @ new - turning)[free]
            change = np.linalg.solve((mass + turning_mass)[grid] + step**2 / 4 * tangent[grid], rest)
            new[free] += change
            if step**2 / 4 * np.abs(change).max() < 1e-12:
                break
        else:
            raise RuntimeError(f"Newton's method did not converge at t = {t}")
        q, v, acceleration = base + step**2 / 4 * new, speed + step / 2 * new, new
        if driven:
            q[dofs], v[dofs] = place, rate
        history.append((q.copy(), v.copy()))
    return history


def cantilever(elements, step, rotary=4.563):
    """Tip (u, v) of the paper's cantilever at t = 0.5, 1, 1.5."""
    beam = Beam(elements, 100.0, 1.12e6, 9.36e6, 0.546, rotary)

    def load(t, q):
        f = np.zeros(beam.n)
        f[-3] = 2500 * np.sin(9.5 * t)
        return f

    history = simulate(beam, step, 1.5, load, (0, 1, 3))
    return np.array([history[int(round(t / step))][0][-4:-2] - (100, 0) for t in (0.5, 1.0, 1.5)])


def pendulum(elements, step):
    """Tip of the flexible pendulum at t = 0.25, 0.5, 1."""
    beam = Beam(elements, 1.0, 1.2e4, 1.0, 1.0)
    weight = -9.81 * beam.M @ np.tile([0.0, 1.0, 0.0, 0.0], elements + 1)
    history = simulate(beam, step, 1.0, lambda t, q: weight, (0, 1))
    return np.array([history[int(round(t / step))][0][-4:-2] for t in (0.25, 0.5, 1.0)])


def moment_arm(elements, step):
    """Tip of the moment-driven arm at t = 2.5 and 5, and its energy at t = 5."""
    beam = Beam(elements, 10.0, 4.8e4, 1e3, 1.0, 1 / 48)

    def load(t, q):
        f = np.zeros(beam.n)
        moment = 80 * max(0.0, 1 - abs(t - 2.5) / 2.5)
        f[2:4] = moment * np.array([-q[3], q[2]]) / (q[2] ** 2 + q[3] ** 2)
        return f

    history = simulate(beam, step, 5.0, load, (0, 1))
    tips = [history[int(round(t / step))][0][-4:-2] for t in (2.5, 5.0)]
    return np.append(np.ravel(tips), beam.energy(*history[-1]))


def slider_crank(elements, step, end=0.006):
    """Deflection of the rod's middle from its chord over its length at t = 0.005, and its maximum up to `end`."""
    radius, speed, length, diameter, slider = 0.15, 150.0, 0.3, 6e-3, 0.033378
    area = np.pi * diameter**2 / 4
    inertia = np.pi * diameter**4 / 64
    beam = Beam(elements, length, 2e11 * area, 2e11 * inertia, 7870 * area, 7870 * inertia, start=(radius, 0.0))
    beam.lumps[-4] = slider
    velocity = np.zeros((elements + 1, 4))
    velocity[:, 1] = radius * speed * (1 - np.linspace(0, 1, elements + 1))
    velocity[:, 3] = -radius * speed / length

    def driven(t):
        c, s = radius * np.cos(speed * t), radius * np.sin(speed * t)
        return [0, 1], np.array([c, s]), speed * np.array([-s, c]), -(speed**2) * np.array([c, s])

    history = simulate(beam, step, end, lambda t, q: np.zeros(beam.n), (beam.n - 3,), velocity.ravel(), driven)
    deflections = []
    for q, _ in history:
        first, last, middle = q[:2], q[-4:-2], q[2 * elements:2 * elements + 2]
        chord = (last - first) / np.linalg.norm(last - first)
        deflections.append((chord[0] * (middle - first)[1] - chord[1] * (middle - first)[0]) / length)
    return np.array([deflections[int(round(0.005 / step))], max(deflections)])


def extrapolated(solve, elements, step):
    """Order 2 in the step, mesh as fine as given: from two steps."""
    coarse, fine = solve(elements, step), solve(elements, step / 2)
    return fine + (fine - coarse) / 3


def rows():
    for rotary, known in ((4.563, ((-.5488, 10.1357), (-5.9187, 20.0187), (-1.6595, 3.7311))),
                          (0.0, ((-.5111, 9.9503), (-6.0616, 19.9918), (-1.4359, 3.7054)))):
        found = extrapolated(lambda n, h: cantilever(n, h, rotary), 20, 2e-3)
        words = "with" if rotary else "without"
        for t, tip, expected in zip((0.5, 1.0, 1.5), found, known):
            for name, x, y in zip("uv", tip, expected):
                yield f"paper's cantilever, {words} rotary inertia: {name}({t})", x, y, 0.01 / abs(y)
    for t, tip, expected in zip((0.25, 0.5, 1.0), extrapolated(pendulum, 20, 2e-3),
                                ((.90953, -.40740), (-.05782, -.99742), (-.98765, .05193))):
        for name, x, y in zip("xy", tip, expected):
            yield f"flexible pendulum: {name}({t})", x, y, 2e-5 / abs(y)
    for name, x, y in zip(("x(2.5)", "y(2.5)", "x(5)", "y(5)", "energy(5)"), extrapolated(moment_arm, 10, 1e-2),
                          (9.7245, 2.1598, .6959, 9.9782, 59.9527)):
        yield f"moment-driven arm: {name}", x, y, 2e-4 / abs(y)
    for name, x, y in zip(("at 0.005 s", "maximum"), extrapolated(slider_crank, 10, 1e-5), (.015097, .015388)):
        yield f"slider-crank, deflection of the rod: {name}", x, y, 1e-3
