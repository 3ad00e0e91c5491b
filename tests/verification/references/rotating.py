"""Linear vibration of rotating beams and plates by Ritz's method, polynomials over the whole body.

Beam, clamped at the axis, flap:  int w''^2 + gamma^2 (1 - x^2)/2 w'^2 = omega^2 int w^2  (unit EI, rhoA, L); lag: omega^2 - gamma^2.
Plate, clamped at x = 0, in the plane of rotation: Kirchhoff's bending energy and the membrane forces of the rotating plane-stress
problem; unit D, rho h, a.
"""
import numpy as np

from ritz import basis, frequencies, gauss


def beam_flap(gamma, count=3, terms=16):
    x, w = gauss(40)
    f, f1, f2 = basis([0, 0, 1], terms, x)
    stiffness = f2.T @ (w[:, None] * f2) + gamma**2 * f1.T @ ((w * (1 - x**2) / 2)[:, None] * f1)
    return frequencies(stiffness, f.T @ (w[:, None] * f), count)


def products(ax, ay, weights, bx, by):
    """int weights (ax_i ay_j) (bx_k by_l), weights at all points of the grid: matrix of ij by kl."""
    n, m = ax.shape[1] * ay.shape[1], bx.shape[1] * by.shape[1]
    left = np.einsum("pi,qj->pqij", ax, ay).reshape(weights.size, n)
    right = np.einsum("pi,qj->pqij", bx, by).reshape(weights.size, m)
    return left.T @ (weights.reshape(-1, 1) * right)


def rotating_membrane(x, y, w, nu, terms):
    """Membrane forces at the points per unit Omega^2 (unit rho h): plane stress, clamped at x = 0, axis at (0, middle)."""
    fx, fx1, _ = basis([0, 1], terms, x)
    fy, fy1, _ = basis([1], terms, y)
    one = np.einsum("pi,qj->pqij", fx, fy).reshape(w.size, -1)
    dx = np.einsum("pi,qj->pqij", fx1, fy).reshape(w.size, -1)
    dy = np.einsum("pi,qj->pqij", fx, fy1).reshape(w.size, -1)
    zero = np.zeros_like(one)
    strains = [np.hstack([dx, zero]), np.hstack([zero, dy]), np.hstack([dy, dx])]
    elastic = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]]) / (1 - nu**2)
    area = w.reshape(-1, 1)
    stiffness = sum(elastic[a, b] * strains[a].T @ (area * strains[b]) for a in range(3) for b in range(3) if elastic[a, b])
    grid_x, grid_y = (g.reshape(-1, 1) for g in np.meshgrid(x, y, indexing="ij"))
    load = (np.hstack([one, zero]) * area * grid_x + np.hstack([zero, one]) * area * (grid_y - 0.5)).sum(0)
    solution = np.linalg.lstsq(stiffness, load, rcond=1e-13)[0]
    field = [e @ solution for e in strains]
    return [sum(elastic[a, b] * field[b] for b in range(3)).reshape(w.shape) for a in range(3)]


def plate_flap(gamma, width=1.0, nu=0.3, count=3, terms=14):
    """omega a^2 sqrt(rho h / D) of a cantilever plate a by width a, a along x."""
    x, wx = gauss(2 * terms + 6)
    y, wy = gauss(2 * terms + 6, 0.0, width)
    w = np.outer(wx, wy)
    f, f1, f2 = basis([0, 0, 1], terms, x)
    g, g1, g2 = basis([1], terms, y, 0.0, width)
    stiffness = products(f2, g, w, f2, g) + products(f, g2, w, f, g2) + 2 * (1 - nu) * products(f1, g1, w, f1, g1)
    mixed = products(f2, g, w, f, g2)
    stiffness += nu * (mixed + mixed.T)
    if gamma:
        n_x, n_y, n_xy = (gamma**2 * n for n in rotating_membrane(x, y, w, nu, terms))
        mixed = products(f1, g, w * n_xy, f, g1)
        stiffness += products(f1, g, w * n_x, f1, g) + products(f, g1, w * n_y, f, g1) + mixed + mixed.T
    return frequencies(stiffness, products(f, g, w, f, g), count)


def rows():
    for gamma, known in ((2, (4.1373196, 22.6149220, 62.2731841)), (6, (7.3603730, 26.8090817, 66.6839144)),
                         (12, (13.1701505, 37.6031123, 79.6144785))):
        for mode, (found, expected) in enumerate(zip(beam_flap(gamma), known), 1):
            yield f"rotating clamped beam, gamma = {gamma}, flap mode {mode}", found, expected, 2e-8
    for gamma, known in ((1, (3.6393, 8.6267, 21.429)), (3, (4.7677, 9.5316, 22.544)), (10, (11.1945, 16.6312, 31.956))):
        for mode, (found, expected) in enumerate(zip(plate_flap(gamma), known), 1):
            yield f"rotating square plate, gamma = {gamma}, mode {mode}", found, expected, 1e-5
    for mode, (found, expected) in enumerate(zip(plate_flap(0, width=0.5, count=5), (3.4392, 14.801, 21.434, 48.178, 60.159)), 1):
        yield f"cantilever plate, b/a = 1/2, mode {mode}", found, expected, 2e-4
