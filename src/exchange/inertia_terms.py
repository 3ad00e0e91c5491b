"""The blocks of a floating body's equations of motion, from its constants; axes x, y, z are 0, 1, 2.

    [ m 1     sym       ] [ a     ]   [ w~ w~ c + 2 w~ Ct'q.               ]
    [ c~   J            ] [ alpha ] + [ w~ J w + sum Gr_j q_j. w           ] + [0, 0, Ke q + De q.] = forces
    [ Ct   Cr   Me      ] [ q..   ]   [ sum Ge_j q_j. w + Oe (w w)         ]

(w w) = (w_x^2, w_y^2, w_z^2, w_x w_y, w_y w_z, w_z w_x). A name that ends in 1 is the derivative by q_i, i its second
index; geometric stiffness is not in here.
"""
import numpy as np

CYCLIC = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]


def moments(C):
    """tr(C) 1 - C over the first two axes."""
    trace = np.einsum("aa...->...", C)
    return np.multiply.outer(np.eye(3), trace) - C


def J0(body):
    return moments(body.C0)


def J1(body):
    """3 x k x 3."""
    return moments(body.h + body.h.swapaxes(0, 1)).transpose(0, 2, 1)


def Cr0(body):
    """k x 3: int rho (x cross N_i)."""
    return np.stack([body.h[b, c] - body.h[c, b] for _, b, c in CYCLIC], axis=1)


def skew_forms(body):
    """k x k x 3: the part of Cr1 that is gyroscopic."""
    return np.stack([body.M[c, b] - body.M[b, c] for _, b, c in CYCLIC], axis=2)


def Cr1(body):
    """k x k x 3."""
    return skew_forms(body) + np.stack([body.W[b, c] - body.W[c, b] for _, b, c in CYCLIC], axis=2)


def Gr0(body):
    """3 x 3k, a block of three columns for each coordinate."""
    blocks = 2 * moments(body.h.swapaxes(0, 1))  # 3 x 3 x k
    return blocks.transpose(0, 2, 1).reshape(3, -1)


def Ge0(body):
    """k x 3k, a block of three columns for each coordinate."""
    return 2 * skew_forms(body).reshape(body.k, -1)


def quadratic(H):
    """The six columns of Oe from H_ab = int rho c_a N_b: along the last axis."""
    squares = [-(H[b, b] + H[c, c]) for _, b, c in CYCLIC]
    return np.stack(squares + [H[a, b] + H[b, a] for a, b in ((0, 1), (1, 2), (2, 0))], axis=-1)


def Oe0(body):
    """k x 6."""
    return quadratic(body.h)


def Oe1(body):
    """k x k x 6."""
    return quadratic(body.M + body.W)


def second_order_share(body):
    """What spin about the worst axis of the frame changes of the stiffness by W, at 1 rad/s: W_bb + W_cc against K, in the
    largest eigenvalue. Zero where nothing rotates or K is singular."""
    values, vectors = np.linalg.eigh(body.stiffness)
    if not len(values) or values[0] <= 1e-12 * values[-1]:
        return 0.0
    half = vectors / np.sqrt(values)
    return max(np.abs(np.linalg.eigvalsh(half.T @ (body.W[b, b] + body.W[c, c]) @ half)).max() for _, b, c in CYCLIC)
