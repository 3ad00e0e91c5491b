"""Geometrically exact plane beams with shear (Reissner's strains), three nodes an element and two points (no locking).

Gamma = R(theta)' r' - (1, 0), kappa = theta'.  U = int EA/2 G1^2 + GA/2 G2^2 + EI/2 kappa^2; T = int rhoA/2 |r.|^2 + rhoI/2 theta.^2.
Newmark's method (beta = 1/4). Simo and Vu-Quoc (J. Appl. Mech. 53, 1986) give the equations and the flying beam.
"""
import numpy as np

from ritz import gauss


def flying_beam(elements, step, end=5.0, times=(2.5, 5.0)):
    """Ends (loaded x, y, free x, y) of the flying beam of Simo and Vu-Quoc at the times."""
    EA, GA, EI, rhoA, rhoI, length = 1e4, 1e4, 500.0, 1.0, 10.0, 10.0
    h, nodes = length / elements, 2 * elements + 1
    dofs = 6 * np.arange(elements)[:, None] + np.arange(9)
    n = 3 * nodes

    def shapes(s):
        return (np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], 1),
                np.stack([4 * s - 3, 4 - 8 * s, 4 * s - 1], 1) / h)

    s, w = gauss(2)
    N, D = shapes(s)
    w = w * h
    s3, w3 = gauss(3)
    N3, _ = shapes(s3)
    block = np.einsum("g,gi,gj->ij", w3 * h, N3, N3)
    M = np.zeros((n, n))
    for row in dofs:
        M[np.ix_(row, row)] += np.kron(block, np.diag([rhoA, rhoA, rhoI]))

    def elastic(q):
        e = q[dofs].reshape(elements, 3, 3)
        theta = np.einsum("gi,ei->eg", N, e[:, :, 2])
        a = np.einsum("gi,eic->egc", D, e[:, :, :2])
        c, s_ = np.cos(theta), np.sin(theta)
        g1, g2 = c * a[..., 0] + s_ * a[..., 1] - 1, -s_ * a[..., 0] + c * a[..., 1]
        kappa = np.einsum("gi,ei->eg", D, e[:, :, 2])
        # strains' gradients on (a_x, a_y, theta, theta'), and of the shear forces'
        grad = np.zeros((elements, 2, 3, 4))
        grad[..., 0, 0], grad[..., 0, 1], grad[..., 0, 2] = c, s_, g2
        grad[..., 1, 0], grad[..., 1, 1], grad[..., 1, 2] = -s_, c, -(g1 + 1)
        grad[..., 2, 3] = 1
        stress = np.stack([EA * g1, GA * g2, EI * kappa], -1)
        second = np.zeros((elements, 2, 4, 4))
        x = -stress[..., 0] * s_ - stress[..., 1] * c
        y = stress[..., 0] * c - stress[..., 1] * s_
        second[..., 0, 2] = second[..., 2, 0] = x
        second[..., 1, 2] = second[..., 2, 1] = y
        second[..., 2, 2] = -stress[..., 0] * (g1 + 1) - stress[..., 1] * g2
        hessian = np.einsum("egsi,s,egsj->egij", grad, np.array([EA, GA, EI]), grad) + second
        B = np.zeros((2, 4, 9))
        B[:, 0, 0::3] = B[:, 1, 1::3] = B[:, 3, 2::3] = D
        B[:, 2, 2::3] = N
        f = np.einsum("g,gai,egsa,egs->ei", w, B, grad, stress, optimize=True)
        k = np.einsum("g,gai,egab,gbj->eij", w, B, hessian, B, optimize=True)
        force, tangent = np.zeros(n), np.zeros((n, n))
        np.add.at(force, dofs, f)
        np.add.at(tangent, (dofs[:, :, None], dofs[:, None, :]), k)
        return force, tangent

    q = np.zeros((nodes, 3))
    q[:, 0], q[:, 1] = np.linspace(6, 0, nodes), np.linspace(0, 8, nodes)
    q[:, 2] = np.arctan2(8, -6)
    q = q.ravel()
    v, acceleration, found = np.zeros(n), np.zeros(n), []

    def load(t):
        f = np.zeros(n)
        f[:3] = np.array([20, 0, -200]) * max(0.0, 1 - abs(t - 2.5) / 2.5)
        return f

    for i in range(1, int(round(end / step)) + 1):
        base, speed, new = q + step * v + step**2 / 4 * acceleration, v + step / 2 * acceleration, acceleration.copy()
        for _ in range(30):
            force, tangent = elastic(base + step**2 / 4 * new)
            change = np.linalg.solve(M + step**2 / 4 * tangent, load(i * step) - force - M @ new)
            new += change
            if step**2 / 4 * np.abs(change).max() < 1e-11:
                break
        else:
            raise RuntimeError("Newton's method did not converge")
        q, v, acceleration = base + step**2 / 4 * new, speed + step / 2 * new, new
        if any(abs(i * step - t) < step / 4 for t in times):
            found.append(np.append(q[:2], q[-3:-1]))
    return np.array(found)


def rows():
    coarse, fine = flying_beam(16, 0.01), flying_beam(16, 0.005)
    finer_mesh = flying_beam(32, 0.01)
    found = fine + (fine - coarse) / 3 + (finer_mesh - coarse)
    known = ((3.5781, 0.0539, 3.8383, 8.5401), (18.5849, 7.9246, 12.0207, 0.3973))
    for t, at, expected in zip((2.5, 5.0), found, known):
        for name, x, y in zip(("loaded x", "loaded y", "free x", "free y"), at, expected):
            yield f"flying beam in the plane, {name}({t})", x, y, 1e-3 / abs(y)
