"""One beam with von Karman's strain in one floating frame, by Ritz's method: polynomials u(x), w(x) over the whole length.

r = R(theta) (x + u, w);  U = int EA/2 (u' + w'^2/2)^2 + EI/2 w''^2;  T = int rhoA/2 |r.|^2 + rhoI/2 (theta. + w.')^2.
Pinned frame with a clamped root: w(0) = w(L) = u(0) = 0, theta = -w'(0); or theta is given and w(0) = w'(0) = u(0) = 0.
The positions' Jacobian gives mass and load; Newmark's method (beta = 1/4), two steps extrapolated.
"""
import numpy as np

from ritz import basis, gauss


class Ritz:
    def __init__(self, length, EA, EI, rhoA, rhoI, pinned, terms):
        x, w = gauss(3 * terms, 0.0, length)
        self.x, self.w, self.EA, self.EI, self.rhoA, self.rhoI = x, w, EA, EI, rhoA, rhoI
        bending = [0, length, -1] if pinned else [0, 0, 1]
        u, u1, _ = basis([0, 1], terms, x, 0.0, length)
        v, v1, v2 = basis(bending, terms, x, 0.0, length)
        zero = np.zeros_like(u)
        self.U, self.V, self.stretch = np.hstack([u, zero]), np.hstack([zero, v]), np.hstack([u1, zero])
        self.slope, self.curvature = np.hstack([zero, v1]), np.hstack([zero, v2])
        self.n = 2 * terms
        root = basis(bending, terms, np.zeros(1), 0.0, length)[1][0]
        self.angle = np.append(np.zeros(terms), -root)  # theta = angle . eta (pinned)
        tip = np.array([length])
        self.tip_u = np.append(basis([0, 1], terms, tip, 0.0, length)[0][0], np.zeros(terms))
        self.tip_v = np.append(np.zeros(terms), basis(bending, terms, tip, 0.0, length)[0][0])
        self.length = length

    def elastic(self, eta):
        slope = self.slope @ eta
        normal = self.w * self.EA * (self.stretch @ eta + slope**2 / 2)
        row = self.stretch + slope[:, None] * self.slope
        bent = self.curvature.T @ ((self.w * self.EI)[:, None] * self.curvature)
        return row.T @ normal + bent @ eta, \
            row.T @ ((self.w * self.EA)[:, None] * row) + self.slope.T @ (normal[:, None] * self.slope) + bent

    def inertia(self, eta, rate, theta, spin, spin_rate, angle):
        """Mass matrix and the force without eta..; angle: d theta / d eta, spin_rate: the given part of theta..."""
        c = np.stack([self.x + self.U @ eta, self.V @ eta])
        c_rate = np.stack([self.U @ rate, self.V @ rate])
        turn = np.stack([-c[1], c[0]])  # in the frame's axes: all vectors below, too
        J = np.stack([self.U, self.V]) + turn[:, :, None] * angle
        rest = spin_rate * turn - spin**2 * c + 2 * spin * np.stack([-c_rate[1], c_rate[0]])
        section = self.slope + angle
        w = self.w * self.rhoA
        mass = np.einsum("g,agi,agj->ij", w, J, J) + section.T @ ((self.w * self.rhoI)[:, None] * section)
        force = np.einsum("g,agi,ag->i", w, J, rest) + section.T @ (self.w * self.rhoI * spin_rate)
        return mass, force


def integrate(body, step, end, given, tip_force):
    """given(t): theta, theta., theta.. or None (pinned). @return  times, tip (u, v) in the frame, theta"""
    eta, rate, acceleration = (np.zeros(body.n) for _ in range(3))
    angle = np.zeros(body.n) if given else body.angle
    tips = [(0.0, 0.0, 0.0)]
    for i in range(1, int(round(end / step)) + 1):
        t = i * step
        base, speed, new = eta + step * rate + step**2 / 4 * acceleration, rate + step / 2 * acceleration, acceleration.copy()
        for _ in range(50):
            eta, rate = base + step**2 / 4 * new, speed + step / 2 * new
            theta, spin, spin_rate = given(t) if given else (angle @ eta, angle @ rate, 0.0)
            mass, inertial = body.inertia(eta, rate, theta, spin, spin_rate, angle)
            force, tangent = body.elastic(eta)
            fx, fy = tip_force(t)
            at = (np.cos(theta) * fx + np.sin(theta) * fy, -np.sin(theta) * fx + np.cos(theta) * fy)
            x, y = body.length + body.tip_u @ eta, body.tip_v @ eta
            load = at[0] * (body.tip_u - y * angle) + at[1] * (body.tip_v + x * angle)
            change = np.linalg.solve(mass + step**2 / 4 * tangent, load - force - inertial - mass @ new)
            new += change
            if step**2 / 4 * np.abs(change).max() < 1e-11 * body.length:
                break
        else:
            raise RuntimeError(f"no convergence at t = {t}")
        eta, rate, acceleration = base + step**2 / 4 * new, speed + step / 2 * new, new
        tips.append((body.tip_u @ eta, body.tip_v @ eta, given(t)[0] if given else angle @ eta))
    return np.array(tips)


def cantilever(step, rotary, terms=12):
    """Tip (u, v) of the paper's cantilever in the pinned frame at t = 0.5, 1, 1.5."""
    body = Ritz(100.0, 1.12e6, 9.36e6, 0.546, rotary, True, terms)
    tips = integrate(body, step, 1.5, None, lambda t: (0.0, 2500 * np.sin(9.5 * t)))
    u, v, theta = tips[[int(round(t / step)) for t in (0.5, 1.0, 1.5)]].T
    return np.stack([(100 + u) * np.cos(theta) - v * np.sin(theta) - 100, (100 + u) * np.sin(theta) + v * np.cos(theta)], 1)


def spin_up(step, terms=7):
    """Tip deflection of the spun-up beam at t = 2.5, 5, 7.5, 10 (Wu and Haug's data)."""
    body = Ritz(8.0, 6.895e10 * 7.3e-5, 6.895e10 * 8.218e-9, 2766.67 * 7.3e-5, 0.0, False, terms)
    speed, rise = 6.0, 15.0

    def given(t):
        k = 2 * np.pi / rise
        return (speed / rise * (t**2 / 2 + (np.cos(k * t) - 1) / k**2), speed / rise * (t - np.sin(k * t) / k),
                speed / rise * (1 - np.cos(k * t)))

    tips = integrate(body, step, 10.0, given, lambda t: (0.0, 0.0))
    return tips[[int(round(t / step)) for t in (2.5, 5.0, 7.5, 10.0)], 1]


def extrapolated(solve, step):
    coarse, fine = solve(step), solve(step / 2)
    return fine + (fine - coarse) / 3


def rows():
    found = extrapolated(lambda h: cantilever(h, 4.563), 2e-3)
    for t, tip, expected in zip((0.5, 1.0, 1.5), found, ((-.5570, 10.2012), (-5.8877, 20.0052), (-2.0382, 4.2024))):
        for name, x, y in zip("uv", tip, expected):
            yield f"paper's cantilever, von Karman, pinned frame: {name}({t})", x, y, 0.0015 / abs(y)
    for t, x, y in zip((2.5, 5.0, 7.5, 10.0), extrapolated(spin_up, 1e-2), (-.2145215, -.6272768, -.7150059, -.4381636)):
        yield f"spin-up of a beam, von Karman: tip's deflection at {t} s", x, y, 1.5e-4
