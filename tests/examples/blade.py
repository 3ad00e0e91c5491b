#!/usr/bin/env python3
"""The blade of examples/blade on a coarse mesh: mesh to reduced file to motion, and shapes for ParaView.

blade.py FLOE: in a folder of its own; 0 if all is as it should be.
"""
import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import h5py
import numpy as np

FLOE = pathlib.Path(sys.argv[1]).resolve()
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/blade"


def floe(folder, *words, ranks=1):
    command = (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [str(FLOE), *words]
    return subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def probes(folder):
    with open(folder / "probes.csv", newline="", encoding="utf-8") as file:
        return np.array([[float(x) for x in row] for row in list(csv.reader(file))[1:]])


def motion_from_the_file(folder):
    """The file is made on two ranks; from it the blade moves as from its mesh."""
    for name in ("scene.yaml", "gust.yaml"):
        text = re.sub(r"motion: .*", "motion: {end: 0.06, step: 2e-3}", (EXAMPLE / name).read_text())
        (folder / name).write_text(text.replace("modes: 8", "modes: 3"))
    floe(folder, "reduce", "scene.yaml", "-o", "blade.h5", ranks=2)
    for name in ("scene.yaml", "gust.yaml"):  # the sizes of the mesh, though one of them has none
        assert re.search(r"blade +288 +1050 +clamped", floe(folder, "check", name)), name
    floe(folder, "run", "scene.yaml", "-o", "meshed")
    floe(folder, "run", "gust.yaml", "-o", "reduced")
    meshed, reduced = probes(folder / "meshed"), probes(folder / "reduced")
    assert np.abs(meshed).max() > 0.05
    assert np.abs(meshed - reduced).max() < 1e-8 * np.abs(meshed).max(), np.abs(meshed - reduced).max()


def frequencies(text):
    return np.array([float(line.split()[2]) for line in text.splitlines() if re.match(r"blade +\d+ +[\d.]+ +[\d.]+ ", line)])


def by_subdomains(folder):
    """The options files of domain decomposition find the frequencies of the factor; one rank is refused."""
    (folder / "free.yaml").write_text(re.sub(r"(?m)^joints:\n .*\n", "", (folder / "scene.yaml").read_text()))
    for scene, name in (("free.yaml", "subdomains_free.opts"), ("scene.yaml", "subdomains.opts")):
        options = ["-options_file", str(EXAMPLE / "options" / name)]
        direct = frequencies(floe(folder, "modes", scene))
        found = frequencies(floe(folder, "modes", scene, *options, ranks=3))
        assert len(direct) == 3 and np.allclose(found, direct, rtol=1e-5), (scene, direct, found)
    one = subprocess.run([FLOE, "modes", "scene.yaml", *options], cwd=folder, capture_output=True, text=True)
    assert one.returncode == 2 and "expected several ranks" in one.stderr, one.stderr


def items(folder, name):
    """Every array that the XDMF file names, with the dimensions and types it is said to have."""
    arrays = {}
    for item in xml.parse(folder / name).iter("DataItem"):
        file, path = item.text.strip().split(":")
        with h5py.File(folder / file) as data:
            array = data[path][()]
        assert array.shape == tuple(int(n) for n in item.get("Dimensions").split()), path
        assert array.dtype == {"Float": np.float64, "Int": np.int64}[item.get("NumberType")], path
        arrays[path] = array
    return arrays


def check_topology(cells, count, nodes):
    at, corners = 0, {1: 1, 2: 2, 4: 3, 5: 4}
    for _ in range(count):
        kind = cells[at]
        at += 2 if kind <= 2 else 1
        assert np.all((cells[at:at + corners[kind]] >= 0) & (cells[at:at + corners[kind]] < nodes))
        at += corners[kind]
    assert at == len(cells)


def shapes_for_pictures(folder):
    """The same on one rank and on four; fields with names, on all nodes."""
    for ranks in (1, 4):
        floe(folder, "modes", "scene.yaml", "--write", f"on{ranks}.xdmf", ranks=ranks)
    one, four = (items(folder, f"on{ranks}.xdmf") for ranks in (1, 4))
    assert one.keys() == four.keys() and len(one) == 3 + 2 * (3 + 6)
    for path, array in one.items():
        assert np.allclose(array, four[path], rtol=0, atol=1e-6 * np.abs(array).max()), path
        if array.dtype == np.int64 or path.endswith("positions"):
            assert np.array_equal(array, four[path]), path
    grid = xml.parse(folder / "on1.xdmf").find(".//Grid")
    names = [attribute.get("Name") for attribute in grid.iter("Attribute")]
    assert names[0] == "part" and re.fullmatch(r"mode 1 \(\d+\.?\d* Hz\)", names[1]) and names[2] == names[1] + ", rotation"
    assert "derivative 1,2" in names
    nodes = len(one["/blade/positions"])
    check_topology(one["/blade/cells"], int(grid.find("Topology").get("NumberOfElements")), nodes)
    mode = one["/blade/field_1/displacement"]
    root = one["/blade/positions"][:, 0] == 0
    assert np.all(mode[root] == 0) and np.abs(mode).max() > 0.1
    again = subprocess.run([FLOE, "modes", "scene.yaml", "--write", "on1.xdmf"], cwd=folder, capture_output=True, text=True)
    assert again.returncode == 2 and again.stderr.count("exists; use another name") == 1, again.stderr
    assert not list(folder.glob(".*.partial"))


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        shutil.copy(EXAMPLE / "mesh.py", folder)
        subprocess.run([sys.executable, "mesh.py", "blade.msh", "24", "6"], cwd=folder, check=True)
        motion_from_the_file(folder)
        by_subdomains(folder)
        shapes_for_pictures(folder)


if __name__ == "__main__":
    main()
