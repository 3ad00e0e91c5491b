"""`floe modes --write-matrices`: the matrices have the frequencies that floe finds, on one rank and on two."""
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

import readers
from bodies import CANTILEVER, PINNED, PLATE, close, floe

FLOE = pathlib.Path(sys.argv[1]).resolve()


def table(text):
    """Frequencies [rad/s] that floe prints."""
    return np.array([float(row.group(1)) for row in re.finditer(r"^\s*\w+\s+\d+\s+\S+\s+(\S+)\s+\S+\s*$", text, re.M)])


def rows_of(path):
    lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    assert [int(line[0]) for line in lines] == list(range(1, len(lines) + 1))
    return [(int(node), dof, np.array(x, float)) for _, node, dof, *x in lines]


def load(folder, body):
    K, M = (readers.matrix_market(folder / f"{body}-{letter}.mtx") for letter in "KM")
    rows = rows_of(folder / f"{body}-rows.txt")
    assert len(rows) == len(K) == len(M)
    return K, M, rows


def lowest(K, M, count):
    half = np.linalg.inv(np.linalg.cholesky(K))  # M is singular where rotations have no mass
    return 1 / np.sqrt(np.linalg.eigvalsh(half @ M @ half.T)[::-1][:count])


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene, text, body in (("cantilever", CANTILEVER, "beam"), ("pinned", PINNED, "beam"),
                                  ("plate", PLATE, "plate")):
            (folder / f"{scene}.yaml").write_text(text)
            said = floe(FLOE, folder, "modes", f"{scene}.yaml", "--write-matrices", scene)
            K, M, rows = load(folder / scene, body)
            printed = table(said)
            assert len(printed) >= 3, said
            close(lowest(K, M, len(printed)), printed, 1e-5, f"frequencies of {scene}, printed with 6 digits")
            done = subprocess.run(["mpirun", "-n", "2", str(FLOE), "modes", f"{scene}.yaml", "--write-matrices",
                                   f"{scene}2"], cwd=folder, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            K2, M2, rows2 = load(folder / f"{scene}2", body)
            close(K2, K, 1e-12, "K on two ranks")
            close(M2, M, 1e-12, "M on two ranks")
            assert [row[:2] for row in rows2] == [row[:2] for row in rows]
            assert all(np.array_equal(a[2], b[2]) for a, b in zip(rows, rows2))
            if scene == "cantilever":  # a unit force at the tip: L^3/3EI and L^2/2EI
                tip = {dof: i for i, (_, dof, x) in enumerate(rows) if abs(x[0] - 1) < 1e-12}
                u = np.linalg.solve(K, np.eye(len(K))[tip["v"]])
                close([u[tip["v"]], u[tip["rz"]]], [1 / 3, 1 / 2], 1e-8, "the tip under a force")
                assert not any(abs(x[0]) < 1e-12 for _, _, x in rows)  # the clamp has no rows
        (folder / "full").mkdir()
        (folder / "full" / "mine.txt").write_text("mine")
        said = floe(FLOE, folder, "modes", "plate.yaml", "--write-matrices", "full", code=2)
        assert len(said.strip().splitlines()) == 1 and "--force" in said, said
        assert [path.name for path in (folder / "full").iterdir()] == ["mine.txt"]
        print("passed: matrices")


if __name__ == "__main__":
    main()
