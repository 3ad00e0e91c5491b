"""Clamped square plate under uniform pressure, von Karman's equations, edges immovable: Ritz's method on a quarter.

Energy of unit E, h = 1 and half edge 1: D/2 int (w_xx + w_yy)^2 (clamped edges: Gauss' curvature integrates to 0) + membrane energy
of eps = (u_x + w_x^2/2, v_y + w_y^2/2, u_y + v_x + w_x w_y) - int p w. The membrane solution is eliminated, w found by Newton's method.
"""
import numpy as np

from ritz import basis, gauss

NU = 0.3


def fields(terms, points):
    """Values and derivatives at the quarter's points: w even, even; u odd, even; v even, odd. All vanish at the edges."""
    x, w = gauss(points)
    even2 = basis([1, 0, -2, 0, 1], terms, x, -1, 1, 2, 0)  # (1 - x^2)^2
    even = basis([1, 0, -1], terms, x, -1, 1, 2, 0)
    odd = basis([1, 0, -1], terms, x, -1, 1, 2, 1)

    def pair(a, b):
        return np.einsum("pi,qj->pqij", a, b).reshape(points * points, -1)

    deflection = {"1": pair(even2[0], even2[0]), "x": pair(even2[1], even2[0]), "y": pair(even2[0], even2[1]),
                  "lap": pair(even2[2], even2[0]) + pair(even2[0], even2[2])}
    u, u_x, u_y = pair(odd[0], even[0]), pair(odd[1], even[0]), pair(odd[0], even[1])
    v_x, v_y = pair(even[1], odd[0]), pair(even[0], odd[1])
    zero = np.zeros_like(u)
    strains = np.stack([np.hstack([u_x, zero]), np.hstack([zero, v_y]), np.hstack([u_y, v_x])])
    return np.outer(w, w).ravel(), deflection, strains


def centre_deflections(loads, terms=9, points=30):
    """W/h for each Q = q a^4 / (E h^4), a the whole edge."""
    w, f, strains = fields(terms, points)
    elastic = np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]]) / (1 - NU**2)
    bending = f["lap"].T @ (w[:, None] * f["lap"]) / (12 * (1 - NU**2))
    weighted = np.einsum("ab,p,bpn->apn", elastic, w, strains)
    membrane = np.einsum("apm,apn->mn", strains, weighted)
    inverse = np.linalg.inv(membrane)
    eta = np.zeros(f["1"].shape[1])
    middle = basis([1, 0, -2, 0, 1], terms, np.zeros(1), -1, 1, 2)[0][0]
    centre = np.outer(middle, middle).ravel()
    found = []
    for load in loads:
        pressure = (w * load / 16) @ f["1"]  # half edge 1: a = 2
        for _ in range(50):
            w_x, w_y = f["x"] @ eta, f["y"] @ eta
            slopes = np.stack([w_x[:, None] * f["x"], w_y[:, None] * f["y"], w_x[:, None] * f["y"] + w_y[:, None] * f["x"]])
            quadratic = np.stack([w_x**2 / 2, w_y**2 / 2, w_x * w_y])
            load_of_w = np.einsum("apn,ap->n", weighted, quadratic)
            strain = np.einsum("apn,n->ap", strains, -inverse @ load_of_w) + quadratic
            stress = np.einsum("ab,p,bp->ap", elastic, w, strain)
            force = bending @ eta + np.einsum("apn,ap->n", slopes, stress) - pressure
            coupling = np.einsum("apn,apm->nm", weighted, slopes)
            tangent = bending + np.einsum("apm,ab,p,bpn->mn", slopes, elastic, w, slopes, optimize=True) - coupling.T @ inverse @ coupling
            tangent += f["x"].T @ (stress[0][:, None] * f["x"]) + f["y"].T @ (stress[1][:, None] * f["y"])
            mixed = f["x"].T @ (stress[2][:, None] * f["y"])
            tangent += mixed + mixed.T
            step = np.linalg.solve(tangent, -force)
            eta += step
            if abs(centre @ step) < 1e-9:
                break
        else:
            raise RuntimeError(f"Newton's method did not converge at Q = {load}")
        found.append(centre @ eta)
    return found


def rows():
    loads = (1, 25, 100, 200)
    for load, found, expected in zip(loads, centre_deflections(loads), (.013816, .326962, .937420, 1.364028)):
        yield f"clamped square plate, Q = {load}: W/h", found, expected, 1e-5
