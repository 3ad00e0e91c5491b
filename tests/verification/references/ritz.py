"""Polynomial bases, quadrature and the symmetric eigenproblem that the reference computations share."""
import numpy as np
from numpy.polynomial import Polynomial, legendre


def gauss(count, low=0.0, high=1.0):
    x, w = legendre.leggauss(count)
    return 0.5 * (high - low) * (x + 1) + low, 0.5 * (high - low) * w


def basis(factor, count, x, low=0.0, high=1.0, step=1, first=0):
    """Values and first two derivatives at x of factor(x) P_k(z), z from -1 to 1 over [low, high], k = first, first + step, ...

    @return  three arrays, len(x) by count
    """
    z = Polynomial([-(high + low) / (high - low), 2 / (high - low)])
    fields = [Polynomial(factor) * legendre.Legendre.basis(first + step * k).convert(kind=Polynomial)(z) for k in range(count)]
    return tuple(np.stack([f.deriv(order)(x) for f in fields], axis=1) for order in range(3))


def frequencies(stiffness, mass, count):
    """Square roots of the smallest eigenvalues of K v = omega^2 M v."""
    scale = 1 / np.sqrt(np.diag(mass))
    factor = np.linalg.cholesky(scale[:, None] * mass * scale)
    left = np.linalg.solve(factor, scale[:, None] * stiffness * scale)
    values = np.linalg.eigvalsh(np.linalg.solve(factor, left.T))
    return np.sqrt(np.maximum(values[:count], 0))
