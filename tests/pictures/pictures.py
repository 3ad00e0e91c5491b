#!/usr/bin/env python3
"""`floe plot`: each kind of picture of small results is a valid file with something on it, and what is drawn are the file's numbers.

pictures.py FLOE: in a folder of its own; 0 if all is as it should be.
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import numpy as np

from small_scenes import BEAM, CRANK, PANEL, PLATE, TRUSS, floe, probes, write

FLOE = pathlib.Path(sys.argv[1]).resolve()


def drawn(path):
    """A picture that opens, with a share of it that is not background."""
    from PIL import Image

    image = Image.open(path)
    image.load()
    pixels = np.asarray(image.convert("L"))
    assert min(pixels.shape) > 100, (path, pixels.shape)
    share = float((pixels < 200).mean())
    assert 0.002 < share < 0.7, f"{path}: {share} of it is drawn"
    assert len(np.unique(pixels)) > 5, path
    return image


def each_kind(folder):
    """Without a word all that a folder has; by name the rest."""
    run, panel, plate = folder / "crank", folder / "panel", folder / "plate"
    said = floe(FLOE, folder, "plot", run)
    assert said == "".join(f"Picture: {run}/{kind}.png\n" for kind in ("probes", "energy", "deformed")), said
    floe(FLOE, folder, "plot", panel, plate, "--kind", "deformed,shapes", "--shapes", "2", "--dpi", "80")
    for path in [run / f"{kind}.png" for kind in ("probes", "energy", "deformed")] + [
            at / f"{kind}.png" for at in (panel, plate) for kind in ("deformed", "shapes")]:
        drawn(path)
    floe(FLOE, folder, "modes", "plate.yaml", "--write", "modes.xdmf")
    floe(FLOE, folder, "reduce", "plate.yaml", "-o", "plate.h5")
    floe(FLOE, folder, "plot", "modes.xdmf", "plate.h5", "-o", "elsewhere")
    drawn(folder / "elsewhere/modes-shapes.png")
    drawn(folder / "elsewhere/plate-shapes.png")


def of_several_runs(folder):
    floe(FLOE, folder, "compare", "beam.yaml", "--formulations", "nlffr,vm+md", "-o", "compare")
    floe(FLOE, folder, "campbell", "turning.yaml", "--speeds", "0:40:20", "--modes", "2", "-o", "campbell")
    floe(FLOE, folder, "sweep", "beam.yaml", "--vary", "loads.tip.force[2]=500,1000", "-o", "sweep")
    for kind in ("compare", "campbell", "sweep"):
        (folder / kind / f"{kind}.png").unlink(missing_ok=True)
        assert floe(FLOE, folder, "plot", kind) == f"Picture: {kind}/{kind}.png\n"
        drawn(folder / kind / f"{kind}.png")
    variant = {"name": "2 modes", "family": "modes", "formulation": "vm", "total": [0.02], "stopped": "", "motion": 1e-3}
    (folder / "tradeoff").mkdir()
    (folder / "tradeoff/tradeoff.json").write_text(json.dumps(
        {"title": "Hierarchy", "accuracy": 0.01, "choice": 1, "pareto_front": [0, 1],
         "variants": [variant, {**variant, "name": "selected for 1 %", "family": "accuracy", "total": [0.004], "motion": 3e-3,
                          "required": 0.01, "selected": "2 of 9 basis vectors"},
                   {**variant, "name": "gone", "stopped": "diverged at t = 1 s", "total": []}],
         "reference": {"name": "cfr", "words": "cfr, extrapolated", "error": 1e-4}}))
    floe(FLOE, folder, "plot", "tradeoff")
    drawn(folder / "tradeoff/tradeoff.png")


def of_a_tradeoff(folder):
    """The line is the Pareto front, and the selected model has its label, at its place."""
    import tradeoff
    floe(FLOE, folder, "tradeoff", "beam.yaml", "-o", "measured")
    drawn(folder / "measured/tradeoff.png")
    description, shown = tradeoff.load(folder / "measured")
    figure = kept(tradeoff, tradeoff.draw, description, shown, None, 100)
    axes = figure.axes[0]
    front = [description["variants"][i] for i in description["pareto_front"]]
    line = next(one for one in axes.lines if one.get_label() == "Pareto front")
    assert np.allclose(line.get_xdata(), [one["motion"] for one in front])
    assert np.allclose(line.get_ydata(), [100 * max(one["total"]) for one in front])
    assert all(a > b for a, b in zip(line.get_ydata(), line.get_ydata()[1:])), "the front goes down"
    labels = {one.get_text().split("  ")[-1]: one.xy for one in axes.texts if "accuracy" in one.get_text()}
    for one in description["variants"]:
        if one.get("required") and not one["stopped"]:
            at = labels[f"accuracy: {100 * one['required']:g} %"]
            assert np.allclose(at, (one["motion"], 100 * max(one["total"]))), (at, one)
    assert len(labels) >= 2, labels
    assert "cfr" in description["reference"]["words"]


def endings(folder):
    """SVG and PDF, by ending or by --format; animations."""
    run = folder / "crank"
    floe(FLOE, folder, "plot", run, "--kind", "probes", "-o", "p.svg", "--probes", "end,bend.y")
    texts = "".join(xml.parse(folder / "p.svg").getroot().itertext())
    assert len((folder / "p.svg").read_text()) > 5000 and texts is not None
    floe(FLOE, folder, "plot", run, "--kind", "energy", "--format", "pdf")
    assert (run / "energy.pdf").read_bytes().startswith(b"%PDF-") and (run / "energy.pdf").stat().st_size > 5000
    floe(FLOE, folder, "plot", run, "--kind", "animation", "--frames", "6", "--dpi", "60")
    gif = drawn(run / "animation.gif")
    assert gif.n_frames == 6, gif.n_frames
    gif.seek(0)
    first = np.asarray(gif.convert("L")).copy()
    gif.seek(4)
    assert (np.asarray(gif.convert("L")) != first).mean() > 1e-3, "nothing moves"
    if not shutil.which("ffmpeg"):
        print("SKIPPED: an MP4, for ffmpeg is not installed")
        told = floe(FLOE, folder, "plot", run, "--kind", "animation", "-o", "a.mp4", code=2)
        assert "needs ffmpeg" in told, told
        return
    floe(FLOE, folder, "plot", folder / "panel", "--kind", "animation", "-o", "a.mp4", "--frames", "6", "--dpi", "60")
    asked = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=codec_name,nb_read_frames", "-of",
                            "csv=p=0", folder / "a.mp4"], capture_output=True, text=True, check=True).stdout.strip()
    assert asked == "h264,6", asked


def kept(module, draw, *arguments):
    """The figure that a picture's module makes, instead of its file."""
    figures, save = [], module.save
    module.save = lambda figure, *_: figures.append(figure)
    try:
        draw(*arguments)
    finally:
        module.save = save
    return figures[0]


def numbers_of_the_files(folder):
    """Lines, faces and colours are what probes.csv, result.h5, campbell.csv have."""
    import campbell
    import deformed
    import energy
    import history
    import shapes
    from results import Run

    run = Run(str(folder / "crank"))
    with open(folder / "crank/probes.csv", newline="") as file:
        rows = list(csv.reader(file))
    table = {name.split(" [")[0]: column for name, column in zip(rows[0], np.array(rows[1:], float).T)}
    panels = kept(history, history.draw, run, "", 100).axes
    assert [panel.get_ylabel() for panel in panels] == ["end [m]", "middle [m]", "bend [m]"]
    for panel, probe in zip(panels, ("end", "middle", "bend")):
        for line, component in zip(panel.lines, "xy"):
            assert np.array_equal(line.get_xdata(), table["t"]) and np.array_equal(line.get_ydata(), table[f"{probe}.{component}"])
    panels = kept(energy, energy.draw, run, "", 100).axes
    parts = {line.get_label(): line.get_ydata() for line in panels[0].lines}
    assert np.allclose(parts["total"], parts["kinetic"] + parts["elastic"]) and "potential" not in parts  # no gravity
    assert np.array_equal(parts["kinetic"], run.energy[:, 0]) and np.allclose(panels[1].lines[0].get_ydata(), parts["total"] - parts["total"][0])
    raised = Run(str(folder / "crank"))
    raised.load()
    raised.energy = raised.energy + [0, 0, 7]  # relative to another origin
    raised.load = lambda: None
    lines = {line.get_label(): line.get_ydata() for line in kept(energy, energy.draw, raised, "", 100).axes[0].lines}
    assert np.allclose(lines["total"], parts["total"]), "the potential is that from the start on"
    summary = json.loads((folder / "crank/summary.json").read_text())
    drawn_rates = next(line for line in panels[2].lines if line.get_label() == "velocities").get_ydata()
    assert np.isclose(np.nanmax(drawn_rates), summary["constraints"]["greatest_velocity_violation"])
    _, places = probes(folder / "crank")
    axes = kept(deformed, deformed.draw, run, "", 100, [0.004, 0.01]).axes[0]
    ends = [collection.get_segments()[-1][-1] for collection in axes.collections[1::2]]  # crank, rod; crank, rod
    assert np.allclose(ends, places["end"][[40, 100]], atol=1e-12), ends

    plate = Run(str(folder / "plate"))
    figure = kept(deformed, deformed.draw, plate, "", 100, [0.05])
    faces = figure.axes[0].collections[0]
    elements = json.loads((folder / "plate/summary.json").read_text())["bodies"][0]["elements"]
    assert len(faces.get_paths()) == elements and figure.axes[0].get_title() == "t = 0.05 s"
    x, lengths = plate.moved(plate.bodies[0], plate.row_at(0.05))
    corner = int(np.argmin(np.linalg.norm(x - probes(folder / "plate")[1]["corner"][-1], axis=1)))
    assert np.linalg.norm(x[corner] - probes(folder / "plate")[1]["corner"][-1]) < 1e-10 and lengths[corner] > 1e-4
    assert np.isclose(figure.axes[-1].get_ylim()[1], lengths.max())  # the colour bar

    found = shapes.load(str(folder / "modes.xdmf"))
    assert found[0].labels[0].startswith("mode 1 (") and len(found[0].labels) == 4 + 10
    in_file = shapes.load(str(folder / "plate.h5"))
    assert in_file[0].labels[0].startswith("mode 1 (") and in_file[0].labels[0] == found[0].labels[0]
    a, b = np.asarray(found[0].fields[0]), np.asarray(in_file[0].fields[0])
    assert np.abs(a - b * np.sign((a * b).sum())).max() < 1e-6 * np.abs(a).max()  # the first column is the first mode

    with open(folder / "campbell/campbell.csv", newline="") as file:
        expected = [(float(r["speed [rad/s]"]), float(r["frequency [Hz]"])) for r in csv.DictReader(file) if r["mode"] == "1"]
    lines = kept(campbell, campbell.draw, str(folder / "campbell"), "", 100).axes[0].lines
    assert np.allclose(next(line for line in lines if line.get_label() == "1").get_xydata(), expected)


def paths_show_all_load_parameters(folder):
    """t of a path of equilibria falls below its first value, and its last one need not be the maximum."""
    import energy
    import history
    from results import Run

    write(folder, "truss.yaml", TRUSS)
    for points in (30, 1000):
        result = f"truss_{points}"
        floe(FLOE, folder, "static", "truss.yaml", "--formulation", "cfr", "--path", "--at", "20", "--steps", "20", "--points", points, "-o", result)
        run = Run(str(folder / result))
        run.load()
        assert min(run.t) < -1 and (run.t[-1] < 0) == (points == 30)
        for module in (energy, history):
            panel = kept(module, module.draw, run, "", 100).axes[-1]
            assert np.allclose(panel.get_xlim(), (min(run.t), max(run.t))) and panel.get_xlabel() == "load parameter t [s]"


def vibrations_are_followed(folder):
    """Each line of the diagram is a track, through crossings; one that ends and one that begins are others."""
    import campbell
    from style import MORE_COLOURS

    of = [lambda x: 30 + 0.6 * x, lambda x: 60 + 0.02 * x, lambda x: 80 - 0.35 * x, lambda x: 120 - 0.001 * x * x]
    rows = [(x, track + 1, line(x)) for x in range(0, 101, 5) for track, line in enumerate(of)] + [(105, 2, 62.1)]
    results = folder / "tracks"
    results.mkdir()
    with open(results / "campbell.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["speed [rad/s]", "mode", "track", "frequency [Hz]", "growth [1/s]", "remark"])
        table.writerows([x, 1, track, hertz, "", "unstable" if hertz > 119 else ""] for x, track, hertz in rows)
        table.writerow([50, "", "", "", 3, "unstable, without oscillation"])
    with open(results / "summary.json", "w") as file:
        json.dump({"scene": {"title": "crossings"}}, file)
    tracks, unstable, _ = campbell.load(str(results))
    assert sorted(tracks) == [1, 2, 3, 4]
    for track, line in enumerate(of):
        points = [(x, line(x)) for x in range(0, 101, 5)] + ([(105, 62.1)] if track == 1 else [])
        assert np.allclose(tracks[track + 1], points), points
    assert unstable == [(x, 120 - 0.001 * x * x) for x in range(0, 35, 5)] + [(50, 0)], unstable
    assert len(set(MORE_COLOURS)) == len(MORE_COLOURS) >= 14


def names_of_events_are_apart(folder):
    """Many events close to one another, and at the right edge: no name covers another or is cut."""
    import history
    from results import Run

    run = Run(str(folder / "crank"))
    run.summary["events"] = [{"name": f"event {i}", "t": t} for i, t in enumerate(
        [1e-3, 1.1e-3, 1.15e-3, 2e-3, 9.9e-3, 9.95e-3])] + [{"name": "far", "t": 5e-3}]
    figure = kept(history, history.draw, run, "", 100)
    figure.canvas.draw()
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert len(boxes) == 7
    for i, a in enumerate(boxes):
        assert a.x0 >= 0 and a.x1 <= figure.bbox.x1 and a.y1 <= figure.bbox.y1, figure.axes[0].texts[i]
        for b in boxes[:i]:
            assert a.x1 <= b.x0 + 1 or b.x1 <= a.x0 + 1 or a.y1 <= b.y0 + 1 or b.y1 <= a.y0 + 1, (a, b)
    run.summary["events"] = [{"name": f"stop {i}", "t": 1e-3 + 1e-5 * i} for i in range(30)]
    figure = kept(history, history.draw, run, "", 100)
    assert any("more events" in text.get_text() for text in figure.axes[0].texts)


def joints_are_where_they_hold(folder):
    """The pin between crank and rod is at both their ends, the motor at the ground; in space the hinge of the panel."""
    import deformed
    import mechanism
    from results import Run

    run = Run(str(folder / "crank"))
    joints = {joint.name: joint for joint in run.joints}
    assert set(joints) == {"motor", "pin"} and joints["motor"].grounded and not joints["pin"].grounded
    for row in (0, 50, 100):
        one, two = joints["pin"].at(run, row)
        assert np.allclose(one, two, atol=1e-6) and np.allclose(one[:2], 0.15 * np.array([np.cos(150 * run.t[row]), np.sin(150 * run.t[row])]), atol=1e-6)
        assert np.allclose(joints["motor"].at(run, row), 0, atol=1e-9)
    assert [body.rigid for body in run.bodies] == [True, False]
    axes = kept(deformed, deformed.draw, run, "", 100, [0.004]).axes[0]
    marks = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o"]
    assert any(np.allclose(mark, joints["pin"].at(run, run.row_at(0.004))[0][:2]) for mark in marks), marks
    data = mechanism.joint_data(run)
    assert [one["kind"] for one in data] == ["driven", "revolute"] and data[0]["ground"] == [0, 0, 0]
    panel = Run(str(folder / "panel"))
    for joint in panel.joints:
        one, two = joint.at(panel, len(panel.t) - 1)
        if joint.kind == "spherical":
            assert np.linalg.norm(one - two) < 1e-6, (joint.name, one, two)
    assert "hinge" in {joint.name for joint in panel.joints}


def comparisons(folder):
    """A row for each probe: the length of its vector, and its error; components on request."""
    import compare

    description = compare.load(str(folder / "compare"))
    figure = kept(compare, compare.draw, description, "", 100)
    assert [axes.get_ylabel() for axes in figure.axes] == ["|tip| [m]", "error of tip [m]\nagainst NLFFR"]
    series = next(run["series"] for run in description["runs"] if run["name"] == "nlffr")
    line = next(line for line in figure.axes[0].lines if line.get_color() == "black")
    assert np.allclose(line.get_ydata(), np.hypot(series["tip.x"], series["tip.y"]))
    legend = figure.legends[0].get_window_extent(figure.canvas.get_renderer())
    assert legend.x0 >= 0 and legend.x1 <= figure.bbox.x1
    labels = [axes.get_ylabel() for axes in kept(compare, compare.draw, description, "", 100, True).axes]
    assert labels[:2] == ["tip.x [m]", "tip.y [m]"] and len(labels) == 3
    floe(FLOE, folder, "plot", "compare", "--components", "-o", "components.png")
    drawn(folder / "components.png")


def faults(folder):
    """One line, exit code 2, nothing written."""
    for words, phrase in (
            (["nothing"], "plot: nothing: does not exist"),
            (["crank", "--kind", "energies"], "--kind energies: expected of probes, energy,"),
            (["crank", "--kind", "campbell"], "crank can be drawn as probes, energy, deformed, animation, shapes"),
            (["crank", "-o", "one.png"], "--out one.png: names one picture for several"),
            (["crank", "--kind", "energy", "-o", "one.bmp"], "expected a name that ends in .png .svg .pdf"),
            (["crank", "--kind", "deformed", "--times", "0.5"], "--times 0.5: the run goes from 0 to 0.01 s"),
            (["crank", "--kind", "deformed", "--times", "now"], "--times now: expected some numbers"),
            (["crank", "--times", "9"], "--times 9: the run goes from 0 to 0.01 s"),
            (["crank", "--body", "zz", "--kind", "deformed"], "--body: applies to --kind shapes, which is not drawn"),
            (["crank", "--probes", "tip"], "--probes: no column tip; expected of end.x, end.y"),
            (["crank", "--kind", "probes", "--probes", "tip"], "--probes: no column tip; expected of end.x, end.y"),
            (["plate.yaml"], "plate.yaml: expected a folder"),
            (["empty"], "empty: contains no results of floe"),
            (["crank", "-log_view"], "-log_view: plot has no options of PETSc"),
            (["crank", "--amplify", "much"], "--amplify: is much; expected a number")):
        (folder / "empty").mkdir(exist_ok=True)
        told = floe(FLOE, folder, "plot", *words, code=2)
        assert phrase in told and told.count("\n") == 1, (words, told)
    assert not list(folder.glob("one.*"))
    hidden = folder / "hidden"  # a Python that has no matplotlib
    (hidden / "matplotlib").mkdir(parents=True)
    (hidden / "matplotlib/__init__.py").write_text("raise ModuleNotFoundError(\"No module named 'matplotlib'\", name='matplotlib')\n")
    done = subprocess.run([FLOE, "plot", "crank"], cwd=folder, capture_output=True, text=True,
                          env={**__import__("os").environ, "PYTHONPATH": str(hidden)})
    assert done.returncode == 1 and "install the package python3-matplotlib" in done.stderr and done.stderr.count("\n") == 1, done


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        for scene, text in (("crank", CRANK), ("panel", PANEL), ("plate", PLATE)):
            write(folder, f"{scene}.yaml", text)
            floe(FLOE, folder, "run", f"{scene}.yaml", "-o", scene)
        write(folder, "beam.yaml", BEAM)
        write(folder, "turning.yaml", BEAM, **{"joints: {clamp: {type: fixed": "joints: {clamp: {type: driven, angle: 0*t"})
        for case in (each_kind, of_several_runs, of_a_tradeoff, endings, numbers_of_the_files, paths_show_all_load_parameters,
                     vibrations_are_followed, names_of_events_are_apart, joints_are_where_they_hold, comparisons, faults):
            case(folder)


if __name__ == "__main__":
    main()
