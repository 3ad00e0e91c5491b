"""What a load's membrane stresses do to bending, from the reduced von Karman energy (docs/exchange.md)."""
import numpy as np

from reduced_body import Fault


def geometric_stiffness(body):
    """K_geo(l) = sum_r (L K^-1 l)_r B_r as a function of loads: k x n -> n x k x k.

    Linear in l, symmetric. K theta_ij = -L'DB_ij makes K_geo(l)_ij = -l'theta_ij where theta_ij is in the basis.
    @throws Fault  K is singular: the body moves without strain in its frame
    """
    K, L, B = body.stiffness, body.linear_strain, body.bilinear_strain
    scale = 1 / np.sqrt(np.maximum(np.diag(K), np.finfo(float).tiny))
    try:
        factor = np.linalg.cholesky(K * np.outer(scale, scale))
    except np.linalg.LinAlgError:
        raise Fault("the reduced stiffness is singular, but geometric stiffness needs the static response to loads; "
                    "omit it with --no-geometric-stiffness") from None
    half = np.linalg.solve(factor, scale[:, None] * L.T)
    stress = np.linalg.solve(factor.T, half) * scale[:, None]  # K^-1 L'
    return lambda loads: np.tensordot(np.asarray(loads).T @ stress, B, 1)


def none(body):
    return lambda loads: np.zeros((np.shape(loads)[1], body.k, body.k))
