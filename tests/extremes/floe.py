"""Runs floe on scenes that are dictionaries (JSON is YAML), and reads what it leaves."""
import copy
import csv
import json
import os
import pathlib
import subprocess
import tempfile

import h5py
import numpy

from study import Refusal

TIME_LIMIT = 900  # s

ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
               "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_mpi_yield_when_idle": "0"}


def changed(scene, changes):
    """A scene with some entries replaced (`motion.end`: 1), added, or removed (None)."""
    tree = copy.deepcopy(scene)
    for path, value in changes.items():
        *folders, name = path.split(".")
        place = tree
        for folder in folders:
            place = place.setdefault(folder, {})
        if value is None:
            place.pop(name, None)
        else:
            place[name] = copy.deepcopy(value)
    return tree


class Outcome:
    """What a run left: its summary, times, probes by column (`tip.y`), states and energies."""

    def __init__(self, folder, out, err):
        self.out, self.err = out, err
        self.summary = json.loads((folder / "summary.json").read_text())
        self.warnings = self.summary.get("warnings", [])
        self.t, self.probes = read_probes(folder / "probes.csv")
        self.U = self.V = self.energy = self.attitude = None
        if (folder / "result.h5").exists():
            with h5py.File(folder / "result.h5") as result:
                motion = result["motion"]
                self.U, self.V, self.energy = motion["U"][:], motion["V"][:], motion["energy"][:]
                self.attitude = motion["attitude"][:] if "attitude" in motion else None
        for values in (self.t, *self.probes.values()):
            assert numpy.isfinite(values).all(), "a number that is none"

    def end(self, column):
        return self.probes[column][-1]

    def vector(self, probe):
        """Rows of a probe's components."""
        return numpy.stack([v for name, v in self.probes.items() if name.rsplit(".", 1)[0] == probe], axis=1)

    def warned(self, *phrases):
        return any(all(p in w for p in phrases) for w in self.warnings)


def read_probes(path):
    if not path.exists():
        return numpy.zeros(0), {}
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [word.split(" [")[0] for word in rows[0]]
    values = numpy.array([[float(word) for word in row] for row in rows[1:]]).reshape(-1, len(names))
    return values[:, 0], {name: values[:, i] for i, name in enumerate(names) if i > 0}


class Floe:
    def __init__(self, program):
        self.program = str(pathlib.Path(program).resolve())

    def call(self, folder, *words, most=3):
        """Standard output and error. Raises Refusal where floe refuses in the manner it promises: a line for each
        fault."""
        done = subprocess.run([self.program, *words], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True,
                              errors="replace", timeout=TIME_LIMIT, check=False)
        if done.returncode == 0:
            assert "nan" not in done.stdout.split(), f"a number that is none:\n{done.stdout}"
            return done.stdout, done.stderr
        own = [line[6:] for line in done.stderr.splitlines() if line.startswith("floe: ")]
        strange = [p for p in ("PETSC ERROR", "terminate called", "Segmentation", "Sanitizer") if p in done.stderr]
        assert done.returncode in (1, 2) and own and len(own) <= most and not strange, \
            f"no refusal, but exit code {done.returncode} and\n{done.stderr[-1500:]}"
        raise Refusal(done.returncode, own[0])

    def _made(self, command, scene, words, files=None, keep=None):
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
            folder = pathlib.Path(name)
            (folder / "scene.yaml").write_text(scene if isinstance(scene, str) else json.dumps(scene))
            for file, text in (files or {}).items():
                (folder / file).write_text(text)
            try:
                out, err = self.call(folder, command, "scene.yaml", "-o", "out", *words)
            except Refusal:
                if keep is not None and (folder / "out/summary.json").exists():
                    keep.append(Outcome(folder / "out", "", ""))
                raise
            return Outcome(folder / "out", out, err)

    def run(self, scene, formulation="vm+md", *words, estimate=False, **rest):
        words = ("--formulation", formulation, *words, *(() if estimate else ("--no-estimate",)))
        return self._made("run", scene, words, **rest)

    def static(self, scene, formulation="nlffr", *words, **rest):
        return self._made("static", scene, ("--formulation", formulation, *words), **rest)

    def campbell_points(self, scene, speeds, formulation="nlffr", *words, **rest):
        words = ("--formulation", formulation, "--speeds", speeds, *words)
        return self._made("campbell", scene, words, **rest).summary["speeds"]

    def campbell(self, scene, speeds, formulation="nlffr", *words, **rest):
        """Exponents at each speed: lists of (omega, growth), in ascending order; real ones have omega = 0."""
        return [[(0.0, growth) for growth in at.get("real_exponents_per_s", [])] +
                [(v["rad_per_s"], v["growth_per_s"]) for v in at.get("vibrations", [])]
                for at in self.campbell_points(scene, speeds, formulation, *words, **rest)]

    def modes(self, scene, **rest):
        """Of the first body [rad/s]."""
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
            folder = pathlib.Path(name)
            (folder / "scene.yaml").write_text(json.dumps(scene))
            for file, text in rest.get("files", {}).items():
                (folder / file).write_text(text)
            out, _ = self.call(folder, "modes", "scene.yaml")
        return [float(line.replace("|", " ").split()[3]) for line in out.splitlines() if is_row(line)]


def relative(values, reference):
    """Greatest difference over the greatest size."""
    values, reference = numpy.asarray(values, float), numpy.asarray(reference, float)
    assert values.shape == reference.shape, f"{values.shape} values for {reference.shape}"
    size = numpy.abs(reference).max()
    return float(numpy.abs(values - reference).max() / size) if size > 0 else float(numpy.abs(values).max() > 0)


def is_row(line):
    """Of the table of modes: body, number, frequencies, residual."""
    words = line.replace("|", " ").split()
    return len(words) >= 5 and words[1].isdigit()
