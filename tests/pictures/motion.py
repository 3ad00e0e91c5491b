#!/usr/bin/env python3
"""The motion that `floe motion` writes for ParaView: every probe's node is where the probe says, at every instant, reduced and of full
order, in the plane and in space, on any number of ranks.

motion.py FLOE: in a folder of its own; 0 if all is as it should be.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import h5py
import numpy as np

from small_scenes import BEAM, CRANK, PANEL, PLATE, ROOT, floe, probes, write

FLOE = pathlib.Path(sys.argv[1]).resolve()


def frames(path):
    """Times, and at each the positions and deformations by body, as the XDMF file leads to them."""
    times, found, data = [], [], {}
    for body in xml.parse(path).findall("Domain/Grid"):
        assert body.get("CollectionType") == "Temporal"
        own = [float(grid.find("Time").get("Value")) for grid in body.findall("Grid")]
        times = times or own
        assert own == times
        found = found or [{} for _ in times]
        for frame, grid in zip(found, body.findall("Grid")):
            arrays = {}
            for item in grid.iter("DataItem"):
                name, where = item.text.strip().split(":")
                file = data.setdefault(name, h5py.File(path.parent / name, "r"))
                array = file[where][()]
                assert array.shape == tuple(int(n) for n in item.get("Dimensions").split()), where
                arrays[where.rpartition("/")[2]] = array
            frame[body.get("Name")] = arrays
    return np.array(times), found


def check_probe(folder, path, body, probe, node, tolerance=1e-10):
    """The node's place at each instant is the probe's."""
    times, found = frames(path)
    t, places = probes(folder)
    expected = places[probe]
    rows = [int(np.argmin(np.abs(t - at))) for at in times]
    assert np.allclose(t[rows], times, rtol=1e-12, atol=0) and len(times) > 10
    got = np.array([frame[body]["positions"][node] for frame in found])
    size = np.abs(expected).max()
    dimension = expected.shape[1]
    gap = np.abs(got[:, :dimension] - expected[rows]).max()
    assert gap < tolerance * size, f"{path} {body} {probe}: {gap} of {size}"
    assert np.ptp(got, axis=0).max() > 1e-3 * size, "nothing moves"
    return times, found


def planar(folder):
    write(folder, "crank.yaml", CRANK)
    write(folder, "beam.yaml", BEAM)
    for formulation in ("vm+md", "nlffr"):
        out = folder / f"crank-{formulation}"
        floe(FLOE, folder, "run", "crank.yaml", "--formulation", formulation, "-o", out)
        said = floe(FLOE, folder, "motion", out, "--frames", "0")
        assert "101 instants from t = 0 to 0.01 s, 9 nodes and 7 elements of crank, rod" in said, said
        check_probe(out, out / "motion.xdmf", "rod", "end", 6)
        _, found = check_probe(out, out / "motion.xdmf", "rod", "middle", 3)
        crank, rod = found[-1]["crank"]["positions"], found[-1]["rod"]["positions"]
        assert np.abs(crank[1] - rod[0]).max() < 1e-8  # the pin
        assert np.abs(crank[1] - 0.15 * np.array([np.cos(1.5), np.sin(1.5), 0])).max() < 1e-8
    for formulation in ("vm", "cfr", "nlffr"):
        out = folder / f"beam-{formulation}"
        floe(FLOE, folder, "run", "beam.yaml", "--formulation", formulation, "-o", out, ranks=2 if formulation == "cfr" else 1)
        floe(FLOE, folder, "motion", out)
        check_probe(out, out / "motion.xdmf", "beam", "tip", 8)


def enlarged(folder):
    """Deformations five times as large about the same frame; twenty instants at equal distances."""
    out = folder / "crank-vm+md"
    floe(FLOE, folder, "motion", out, "--frames", "20", "-o", "one.xdmf")
    floe(FLOE, folder, "motion", out, "--frames", "20", "--amplify", "5", "-o", "five.xdmf")
    times, one = frames(folder / "one.xdmf")
    _, five = frames(folder / "five.xdmf")
    assert len(times) == 20 and times[0] == 0 and abs(times[-1] - 0.01) < 1e-12
    for a, b in zip(one, five):
        for body in ("crank", "rod"):
            u = a[body]["deformation"]
            assert np.array_equal(u, b[body]["deformation"])
            assert np.abs(b[body]["positions"] - a[body]["positions"] - 4 * u).max() < 1e-12
    assert np.abs(one[-1]["rod"]["deformation"]).max() > 1e-5 and not one[-1]["crank"]["deformation"].any()
    taken = floe(FLOE, folder, "motion", out, "-o", "one.xdmf", code=2)
    assert taken == "floe: motion 'one.xdmf': exists; use another name, or replace it with --force\n", taken
    floe(FLOE, folder, "motion", out, "-o", "one.xdmf", "--force", "--frames", "3")
    assert len(frames(folder / "one.xdmf")[0]) == 3


def spatial(folder):
    write(folder, "panel.yaml", PANEL)
    for formulation in ("vm+md", "nlffr"):
        out = folder / f"panel-{formulation}"
        floe(FLOE, folder, "run", "panel.yaml", "--formulation", formulation, "-o", out)
        floe(FLOE, folder, "motion", out)
        check_probe(out, out / "motion.xdmf", "boom", "tip", 5)
        times, found = check_probe(out, out / "motion.xdmf", "panel", "corner", len(frames(out / "motion.xdmf")[1][0]["panel"]["positions"]) - 1)
        for frame in found:  # what the hub holds begins where the hub ends
            assert np.abs(frame["hub"]["positions"][2] - frame["boom"]["positions"][0]).max() < 1e-9


def from_a_file_on_ranks(folder):
    """A mesh from a file, partitioned: the run on two ranks, the motion on one and on three, to the last bit; and a reduced body."""
    shutil.copy(ROOT / "examples/blade/mesh.py", folder)
    subprocess.run([sys.executable, "mesh.py", "blade.msh", "12", "4"], cwd=folder, check=True)
    for name in ("scene.yaml", "gust.yaml"):
        text = (ROOT / "examples/blade" / name).read_text()
        lines = [line for line in text.splitlines() if not line.startswith("motion:")]
        text = "\n".join(lines).replace("modes: 8", "modes: 3").replace("lead: {at: blade.lead}", "lead: {at: blade.lead, quantity: position}")
        (folder / name).write_text(text + "\nmotion: {end: 0.04, step: 2e-3}\n")
    floe(FLOE, folder, "run", "scene.yaml", "-o", "meshed", ranks=2)
    floe(FLOE, folder, "run", "scene.yaml", "--formulation", "nlffr", "-o", "full", ranks=2)
    floe(FLOE, folder, "reduce", "scene.yaml", "-o", "blade.h5")
    (folder / "below").mkdir()
    floe(FLOE, folder, "run", "gust.yaml", "-o", "reduced")
    for name in ("meshed", "full", "reduced"):
        floe(FLOE, folder / "below", "motion", f"../{name}", "-o", f"{name}.xdmf")  # from another folder
        path = folder / "below" / f"{name}.xdmf"
        start = frames(path)[1][0]["blade"]["positions"]
        node = int(np.argmin(np.linalg.norm(start - probes(folder / name)[1]["lead"][0], axis=1)))
        check_probe(folder / name, path, "blade", "lead", node, 1e-9)
    floe(FLOE, folder, "motion", "full", "-o", "three.xdmf", ranks=3)
    for a, b in zip(frames(folder / "below/full.xdmf")[1], frames(folder / "three.xdmf")[1]):
        for name, array in a["blade"].items():
            assert np.array_equal(array, b["blade"][name]), name
    (folder / "blade.h5").unlink()
    told = floe(FLOE, folder, "motion", "reduced", "-o", "lost.xdmf", code=2)
    assert told == "floe: motion 'reduced': no body of the run has a mesh in its results\n", told
    assert not list(folder.glob("lost*")) and not list(folder.rglob(".*.partial"))


def held(folder):
    """A body that the ground clamps stands still: its frame is none of the unknowns."""
    write(folder, "plate.yaml", PLATE)
    for formulation in ("vm+md", "nlffr", "lffr"):
        out = folder / f"plate-{formulation}"
        floe(FLOE, folder, "run", "plate.yaml", "--formulation", formulation, "-o", out)
        floe(FLOE, folder, "motion", out)
        nodes = len(frames(out / "motion.xdmf")[1][0]["plate"]["positions"])
        check_probe(out, out / "motion.xdmf", "plate", "corner", nodes - 1)


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        for case in (planar, enlarged, spatial, held, from_a_file_on_ranks):
            case(folder)


if __name__ == "__main__":
    main()
