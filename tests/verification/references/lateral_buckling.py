"""A geometrically exact rod in space without shear: a narrow cantilever under a force at its end, near its lateral buckling load.

r' = (1 + N/EA) R e_x, R' = R skew(kappa), kappa = diag(GJ, EIy, EIz)^-1 R'M, M = M_0 - r x F; the moment at the root M_0 by Newton's
method so that the end is free. Quaternions, Runge-Kutta's method of order 4: no element, no floating frame, no rotation assumed small.
Antman, Nonlinear problems of elasticity (1995), ch. 8, has the equations.
"""
import numpy as np

LENGTH, EA = 1.0, 1e6
STIFFNESS = np.array([1.0, 1.0, 1e3])  # GJ, EIy, EIz
CRITICAL = 4.0126 * np.sqrt(STIFFNESS[0] * STIFFNESS[1]) / LENGTH**2
SIDEWAYS = 0.005  # of the load


def rotation(q):
    q = q / np.linalg.norm(q)
    w, v = q[0], q[1:]
    skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * skew + 2 * skew @ skew


def end_of(root, force, steps):
    """Position of the end and the moment that is left there."""
    def rate(y):
        R = rotation(y[3:])
        kappa = (R.T @ (root - np.cross(y[:3], force))) / STIFFNESS
        q, turn = y[3:], np.empty(4)
        turn[0] = -q[1:] @ kappa / 2
        turn[1:] = (q[0] * kappa + np.cross(q[1:], kappa)) / 2
        return np.concatenate([(1 + R[:, 0] @ force / EA) * R[:, 0], turn])

    y, h = np.array([0, 0, 0, 1.0, 0, 0, 0]), LENGTH / steps
    for _ in range(steps):
        a = rate(y)
        b = rate(y + h / 2 * a)
        c = rate(y + h / 2 * b)
        d = rate(y + h * c)
        y = y + h / 6 * (a + 2 * b + 2 * c + d)
    return y[:3], root - np.cross(y[:3], force)


def tip(share, steps=60):
    """Displacement of the end at a share of the critical load, followed from 0.3 of it; Newton's steps are bounded."""
    root = np.zeros(3)
    for part in np.append(np.arange(0.3, share, 0.05), share):
        force = CRITICAL * part * np.array([0, -1.0, SIDEWAYS])
        if not root.any():
            root = np.cross([LENGTH, 0, 0], force)
        for _ in range(100):
            left = end_of(root, force, steps)[1]
            J = np.column_stack([(end_of(root + e, force, steps)[1] - end_of(root - e, force, steps)[1]) / 2e-6
                                 for e in 1e-6 * np.eye(3)])
            step = np.linalg.solve(J, left)
            root = root - step * min(1, 0.3 / np.abs(step).max())
            if np.abs(step).max() < 1e-11 * np.abs(root).max():
                break
        else:
            raise RuntimeError("no equilibrium")
    return end_of(root, force, steps)[0] - [LENGTH, 0, 0]


def rows():
    found = tip(0.9)
    yield "narrow cantilever at 0.9 of its lateral buckling load, tip y", found[1], -0.001690762, 1e-4
    yield "the same, tip z", found[2], 0.024877689, 1e-4
