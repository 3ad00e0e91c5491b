#!/usr/bin/env python3
"""What `floe motion` writes, opened and drawn by the VTK of ParaView off the screen: its nodes are at the end where the probes of result.h5 say.

vtk_reads.py FLOE: 0 if all is as it should be, 77 (skipped) without ParaView.
"""
import os
import pathlib
import shutil
import sys
import tempfile

import numpy as np

try:
    import vtkmodules.all as vtk
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    from vtkmodules.vtkIOXdmf3 import vtkXdmf3Reader
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError:
    print("SKIPPED: ParaView and its VTK are not installed (make check-look installs them)")
    sys.exit(77)
if not os.environ.get("DISPLAY"):  # this VTK draws into windows of X, also those that nobody sees
    if not shutil.which("xvfb-run"):
        print("SKIPPED: xvfb is not installed (make check-look installs it)")
        sys.exit(77)
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 640x480x24", sys.executable, *sys.argv])

from small_scenes import CRANK, PANEL, floe, probes, write

FLOE = pathlib.Path(sys.argv[1]).resolve()


def blocks(data):
    """Grids with their names."""
    found, iterator = {}, data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        found[iterator.GetCurrentMetaData().Get(vtk.vtkCompositeDataSet.NAME())] = iterator.GetCurrentDataObject()
        iterator.GoToNextItem()
    return found


def grids(reader):
    found, iterator = [], reader.GetOutputDataObject(0).NewIterator()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


def read(path, kind=vtkXdmfReader):
    """At the last instant."""
    reader = kind()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    key = vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    times = [information.Get(key, i) for i in range(information.Length(key))]
    reader.UpdateTimeStep(times[-1])
    return reader, times


def rendered(reader):
    """The picture, off the screen: height x width x 3."""
    surface = vtk.vtkCompositeDataGeometryFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("deformation")
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetLineWidth(4)
    scene = vtk.vtkRenderer()
    scene.SetBackground(1, 1, 1)
    scene.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(320, 240)
    window.AddRenderer(scene)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.Update()
    image = grab.GetOutput()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(240, 320, -1)


def check(folder, scene, body, probe):
    write(folder, "scene.yaml", scene)
    floe(FLOE, folder, "run", "scene.yaml", "-o", body)
    floe(FLOE, folder, "motion", body, "--frames", "12")
    reader, times = read(folder / body / "motion.xdmf")
    t, places = probes(folder / body)
    assert len(times) == 12 and abs(times[-1] - t[-1]) < 1e-12, times
    grid = blocks(reader.GetOutputDataObject(0))[body]
    x = vtk_to_numpy(grid.GetPoints().GetData())
    end = np.zeros(3)
    end[:places[probe].shape[1]] = places[probe][-1]
    gap = np.linalg.norm(x - end, axis=1).min()
    assert gap < 1e-6 * np.abs(x).max(), gap  # VTK's points may be of single precision
    assert grid.GetNumberOfCells() > 0 and grid.GetPointData().HasArray("deformation") and grid.GetCellData().HasArray("part")
    other, _ = read(folder / body / "motion.xdmf", vtkXdmf3Reader)  # ParaView offers both
    assert [g.GetNumberOfPoints() for g in grids(other)] == [g.GetNumberOfPoints() for g in grids(reader)]
    assert all(np.array_equal(vtk_to_numpy(a.GetPoints().GetData()), vtk_to_numpy(b.GetPoints().GetData()))
               for a, b in zip(grids(other), grids(reader)))
    picture = rendered(reader)
    dark = (picture < 250).any(axis=2).mean()
    assert 0.002 < dark < 0.9, f"{dark} of the picture is drawn"
    print(f"{body}: {gap:.2g} m from the probe at the end, {100 * dark:.1f} % of the picture drawn")


def check_shapes(folder):
    """What floe modes --write leaves, with both readers."""
    write(folder, "panel.yaml", PANEL)
    floe(FLOE, folder, "modes", "panel.yaml", "--write", "modes.xdmf")
    for kind in (vtkXdmfReader, vtkXdmf3Reader):
        reader = kind()
        reader.SetFileName(str(folder / "modes.xdmf"))
        reader.Update()
        assert sorted(g.GetNumberOfPoints() for g in grids(reader)) == [6, 20], kind.__name__


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        check_shapes(pathlib.Path(name))
        check(pathlib.Path(name), CRANK, "rod", "end")
        check(pathlib.Path(name), PANEL, "panel", "corner")


if __name__ == "__main__":
    main()
