"""Reduced matrices in Matrix Market's exchange format (Boisvert, Pozo and Remington 1996): the lower triangle."""
import numpy as np


def write(path, matrix, comments):
    """A symmetric matrix; numbers to the last bit."""
    symmetric = (matrix + matrix.T) / 2
    entries = [(i, j) for j, i in np.argwhere(symmetric.T) if i >= j]
    with open(path, "w", encoding="utf-8") as file:
        file.write("%%MatrixMarket matrix coordinate real symmetric\n")
        file.writelines(f"% {' '.join(line.split())}\n" for line in comments)
        file.write(f"{len(matrix)} {len(matrix)} {len(entries)}\n")
        file.writelines(f"{i + 1} {j + 1} {symmetric[i, j].item()!r}\n" for i, j in entries)


def matrices(body):
    """Letter -> matrix and what it is; C only of a damped body."""
    chosen = {"K": (body.stiffness, "linear stiffness"), "M": (body.mass_matrix, "mass in the fixed floating frame")}
    if np.any(body.damping):
        chosen["C"] = (body.damping, "damping")
    return chosen


def comments(body, what):
    return [f"{what} of the reduced body {body.name}, written by floe",
            "rows: " + ", ".join(body.labels)]
