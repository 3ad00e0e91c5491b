"""Scenes whose body comes from a file that `floe reduce` wrote, and what can be wrong with that file."""
import pathlib
import subprocess
import sys

import h5py

from scenes import scene

FLOE = pathlib.Path(sys.argv[1]).resolve()
FROM_FILE = {"bodies": {"beam": {"reduced": "beam.h5"}}}


def from_file(changes=None):
    return scene({**FROM_FILE, **(changes or {})})


def made(change=None):
    """Makes the file, then changes it by `change(path)`."""
    def prepare(folder):
        (folder / "mesh.json").write_text(scene())
        subprocess.run([FLOE, "reduce", "mesh.json", "-o", "beam.h5"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        if change:
            change(folder / "beam.h5")
    return prepare


def attribute(name, value):
    def change(path):
        with h5py.File(path, "r+") as file:
            file.attrs.modify(name, value)
    return made(change)


def damage(path):
    with h5py.File(path, "r+") as file:
        file["inertia/S"][0, 0] += 1


cut = made(lambda path: path.write_bytes(path.read_bytes()[:3000]))
