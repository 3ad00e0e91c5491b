"""Answers that do not come from floe: closed forms, and small independent computations."""
import math

import numpy


def bisect(f, a, b):
    for _ in range(200):
        c = (a + b) / 2
        a, b = (c, b) if (f(a) > 0) == (f(c) > 0) else (a, c)
    return (a + b) / 2


CANTILEVER = bisect(lambda b: math.cos(b) * math.cosh(b) + 1, 1.5, 2.5) ** 2  # 3.516015 sqrt(EI / rhoA) / L^2


def with_tip_mass(ratio):
    """First frequency of a cantilever (L = EI = rhoA = 1) with a point mass of so many times its own at the tip."""
    def f(b):  # divided by cosh
        return (1 / math.cosh(b) + math.cos(b)
                + b * ratio * (math.cos(b) * math.tanh(b) - math.sin(b)))
    return bisect(f, 1e-4, 2.2) ** 2


def beam_in_segments(segments, elements=40):
    """First frequency of a clamped-free beam of segments (length, EI, rhoA), by cubic elements in numpy. K^-1 M is
    formed by compliances, so that contrasts cost no digits of the lowest frequency."""
    lengths, EI, rho = [], [], []
    for length, stiffness, mass in segments:
        lengths += [length / elements] * elements
        EI += [stiffness] * elements
        rho += [mass] * elements
    n = len(lengths)
    M = numpy.zeros((2 * n + 2, 2 * n + 2))
    for i, (l, r) in enumerate(zip(lengths, rho)):
        M[2 * i:2 * i + 4, 2 * i:2 * i + 4] += r * l / 420 * numpy.array(
            [[156, 22 * l, 54, -13 * l], [22 * l, 4 * l * l, 13 * l, -3 * l * l],
             [54, 13 * l, 156, -22 * l], [-13 * l, -3 * l * l, -22 * l, 4 * l * l]])
    M = M[2:, 2:]
    # Unit forces and moments at the nodes: curvature is linear in each element, and displacements follow by summation.
    x = numpy.concatenate([[0], numpy.cumsum(lengths)])
    flexibility = numpy.zeros((2 * n, 2 * n))
    for j in range(2 * n):
        at, moment = x[j // 2 + 1], j % 2
        w, slope = 0.0, 0.0
        for i, (l, e) in enumerate(zip(lengths, EI)):
            left, right = ((1.0, 1.0) if moment else (at - x[i], at - x[i + 1])) if x[i + 1] <= at * (1 + 1e-12) else (0, 0)
            w += slope * l + l * l * (left / 3 + right / 6) / e
            slope += l * (left + right) / 2 / e
            flexibility[2 * i, j], flexibility[2 * i + 1, j] = w, slope
    values = numpy.linalg.eigvals(flexibility @ M)
    return 1 / math.sqrt(values.real.max())


def rotating_beam(gamma, terms=24):
    """First frequency of flapping of a rotating cantilever (L = EI = rhoA = 1): Rayleigh-Ritz with x^2 P_n(2x - 1) in
    exact quadrature, scaled. Of vibrations in the plane of rotation: sqrt(flap^2 - gamma^2)."""
    points, weights = numpy.polynomial.legendre.leggauss(2 * terms + 8)
    x, weights = (points + 1) / 2, weights / 2
    shape, first, second = [], [], []
    for i in range(terms):
        p = numpy.polynomial.Legendre.basis(i, domain=[0, 1])
        v, d, dd = p(x), p.deriv(1)(x), p.deriv(2)(x)
        shape.append(x**2 * v), first.append(2 * x * v + x**2 * d), second.append(2 * v + 4 * x * d + x**2 * dd)
    shape, first, second = map(numpy.array, (shape, first, second))
    tension = gamma**2 * (1 - x**2) / 2
    K = (second * weights) @ second.T + (first * (weights * tension)) @ first.T
    M = (shape * weights) @ shape.T
    C = numpy.linalg.cholesky(M)
    A = numpy.linalg.solve(C, numpy.linalg.solve(C, K).T)
    return math.sqrt(numpy.linalg.eigvalsh((A + A.T) / 2)[0])


def stretch(gamma, EA):
    """Of the tip of a beam that turns about its root (L = rhoA = 1)."""
    k = gamma / math.sqrt(EA)
    return math.tan(k) / k - 1
