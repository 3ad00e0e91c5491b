"""What `floe export` refuses: one line, exit code 2, nothing written or changed: refusals.py FLOE."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py

from bodies import CANTILEVER, floe

FLOE = pathlib.Path(sys.argv[1]).resolve()


def changed(folder, name, change):
    shutil.copy(folder / "body.h5", folder / name)
    with h5py.File(folder / name, "r+") as file:
        change(file)


def prepare(folder):
    (folder / "scene.yaml").write_text(CANTILEVER)
    floe(FLOE, folder, "reduce", "scene.yaml", "-o", "body.h5")
    (folder / "text.h5").write_text("not HDF5\n")
    (folder / "cut.h5").write_bytes((folder / "body.h5").read_bytes()[:3000])
    with h5py.File(folder / "other.h5", "w") as file:
        file["a"] = 1
    changed(folder, "later.h5", lambda file: file.attrs.modify("version", 6))
    changed(folder, "partial.h5", lambda file: file.attrs.modify("complete", 0))
    changed(folder, "lacking.h5", lambda file: file.__delitem__("elasticity/F"))

    def infinite(file):
        file["inertia/S"][0, 0] = float("inf")

    def wide(file):
        del file["elasticity/pairs"]
        file["elasticity/pairs"] = [[0, 99]]

    changed(folder, "infinite.h5", infinite)
    changed(folder, "wide.h5", wide)
    changed(folder, "shapeless.h5", lambda file: file.attrs.modify("shapes", 0))
    (folder / "there.npz").write_text("mine")
    (folder / "taken-M.mtx").write_text("mine")
    (folder / "folder.xml").mkdir()


CASES = [  # words, what the line says
    (["body.h5", "-o", "body.dat"], "ends in .npz"),
    (["body.h5", "-o", "body"], "ends in .npz"),
    (["body.h5", "-o", "body.x", "--format", "nastran"], "npz"),
    (["body.h5"], "--out"),
    (["absent.h5", "-o", "a.npz"], "absent.h5: does not exist"),
    (["folder.xml", "-o", "a.npz"], "found a folder"),
    (["text.h5", "-o", "a.npz"], "text.h5: expected a file written by floe reduce"),
    (["cut.h5", "-o", "a.npz"], "cut.h5: expected a file written by floe reduce"),
    (["other.h5", "-o", "a.npz"], "of another kind"),
    (["later.h5", "-o", "a.npz"], "another version"),
    (["partial.h5", "-o", "a.npz"], "incomplete"),
    (["lacking.h5", "-o", "a.sid"], "lacking.h5: is damaged"),
    (["infinite.h5", "-o", "a.xml"], "infinite.h5: is damaged: numbers that are not finite in S"),
    (["wide.h5", "-o", "a.xml"], "wide.h5: is damaged"),
    (["shapeless.h5", "-o", "a.npz", "--shapes"], "shapeless.h5 has none"),
    (["body.h5", "-o", "there.npz"], "there.npz: exists; --force"),
    (["body.h5", "-o", "taken.mtx"], "taken-M.mtx: exists; --force"),
    (["body.h5", "-o", "folder.xml"], "is a folder"),
    (["body.h5", "-o", "body.h5", "--format", "mbsim-hdf5", "--force"], "is the reduced body itself"),
    (["body.h5", "-o", "nowhere/a.npz"], "there is no folder nowhere"),
    (["body.h5", "-o", "a.sid", "--shapes"], "--shapes: is of the format npz"),
    (["body.h5", "-o", "a.npz", "--columns", "all"], "--columns: is of the format sid"),
    (["body.h5", "-o", "a.sid", "--columns", "some"], "modes"),
    (["body.h5", "-o", "a.xml", "--no-geometric-stiffness"], "--no-geometric-stiffness: is of the format sid"),
]


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder)
        before = contents(folder)
        for words, expected in CASES:
            done = subprocess.run([FLOE, "export", *words], cwd=folder, capture_output=True, text=True)
            said = done.stderr.strip()
            assert done.returncode == 2, (words, done.returncode, done.stdout, said)
            assert len(said.splitlines()) == 1 and said.startswith("floe: ") and expected in said, (words, said)
            assert contents(folder) == before, (words, "changed the folder")
        floe(FLOE, folder, "export", "body.h5", "-o", "there.npz", "--force")
        assert (folder / "there.npz").read_bytes()[:2] == b"PK"
        print(f"passed: {len(CASES)} refusals")


if __name__ == "__main__":
    main()
