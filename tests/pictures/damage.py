#!/usr/bin/env python3
"""What floe plot, report and export do with damaged files and a full disk: one line, an exit code, nothing half-written.

damage.py FLOE [--all]. Each attempt is a process of its own that has the scripts loaded. Without --all plot and report
get one of two flipped files, and one of them one of three values of each dataset.
"""
import contextlib
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import traceback

import h5py

ALL = "--all" in sys.argv
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = {"plot": ROOT / "src/plot", "report": ROOT / "src/plot", "export": ROOT / "src/exchange"}
SCENE = """
bodies:
  beam:
    mesh: {line: {from: [0, 0], to: [1, 0], elements: 4}}
    section: {EA: 12000, EI: 1, rhoA: 1}
    reduction: {modes: 2, derivatives: all}
joints: {clamp: {type: fixed, between: [ground, beam.start]}}
loads: {tip: {type: force, at: beam.end, force: [0, "0.5*sin(9*t)"]}}
motion: {end: 0.05, step: 0.005}
probes: {tip: {at: beam.end}}
"""


def attempt(name, words, folder, file_size=None):
    """In a process of its own. @return  exit code (negative: signal), stdout, stderr"""
    said = [folder.parent / "stdout", folder.parent / "stderr"]
    child = os.fork()
    if child == 0:
        code = 99
        try:
            for number, path in zip((1, 2), said):
                os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
            os.chdir(folder)
            if file_size is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))
            sys.path.insert(0, str(SCRIPTS[name]))
            sys.argv = [name, *words]
            module = __import__(name)
            code = module.main() if name == "export" else module.guarded(name, module.work)
            sys.stdout.flush()
        except SystemExit as end:
            code = end.code
        except BaseException:  # what a user would see
            traceback.print_exc()
        finally:
            with contextlib.suppress(Exception):
                sys.stderr.flush()
            os._exit(code if isinstance(code, int) else 98)
    _, state = os.waitpid(child, 0)
    code = os.waitstatus_to_exitcode(state)
    return code, *(path.read_text(errors="replace") for path in said)


def check(what, name, words, folder, codes, file_size=None, phrase=""):
    """One line where it failed; no file but those that it says it has written."""
    before = {path for path in folder.rglob("*")}
    code, out, err = attempt(name, words, folder, file_size)
    assert code in codes, (what, name, code, err)
    assert "Traceback" not in err, (what, name, err)
    lines = err.strip().splitlines()
    assert len(lines) == (1 if code else 0), (what, name, code, err)
    assert not code or (lines[0].startswith(f"floe: {name}: ") and phrase in lines[0]), (what, name, err)
    written = [line.split(": ", 1)[1] for line in out.splitlines() if line.startswith(("Picture: ", "Report: ", "Written: "))]
    new = {path for path in folder.rglob("*")} - before
    assert {path.name for path in new} <= {os.path.basename(path) for path in written}, (what, name, new, written)
    for path in new:
        path.unlink()
    return code


def flipped(data, chance):
    data = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return bytes(data)


def files_of_a_run(whole, folder, chance):
    """Damaged copies of a run's folder: cut off, bits flipped."""
    for name in ("result.h5", "summary.json", "probes.csv"):
        data = (whole / name).read_bytes()
        cut = [data[:size] for size in (0, 1, len(data) // 3, len(data) // 2, len(data) - 1)]
        for i, one in enumerate(cut + [flipped(data, chance) for _ in range(10)]):
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(whole, folder)
            (folder / name).write_bytes(one)
            yield f"{name}, {i}", name


def datasets(path):
    names = []
    with h5py.File(path) as file:
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    return names


def with_dataset(source, target, name, value):
    shutil.copy(source, target)
    with h5py.File(target, "r+") as file:
        del file[name]
        if value is not None:
            file[name] = value


def run_is_damaged(work, chance):
    whole, folder = work / "out", work / "copy"
    failed = 0
    for i, (what, name) in enumerate(files_of_a_run(whole, folder, chance)):
        flipped_bits = int(what.split(", ")[1]) >= 5
        for script in ("plot", "report")[i % 2:i % 2 + 1] if flipped_bits and not ALL else ("plot", "report"):
            failed += check(what, script, ["."], folder, (0, 1, 2)) != 0
        if name == "result.h5" and what.endswith(", 2"):  # cut off at a third
            check(what, "report", ["."], folder, (2,))
    values = (None, "text", [[1, 2], [3, 4]])
    for d, name in enumerate(datasets(whole / "result.h5")):
        for i, value in enumerate(values):
            scripts = [script for s, script in enumerate(("plot", "report")) if ALL or d % 6 == 2 * i + s]
            if not scripts:
                continue
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(whole, folder)
            with_dataset(whole / "result.h5", folder / "result.h5", name, value)
            for script in scripts:
                failed += check(f"{name}: {value}", script, ["."], folder, (0, 2)) != 0
    for text in ("{}", "[]", '{"bodies": 3, "scene": 1}', "null"):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(whole, folder)
        (folder / "summary.json").write_text(text)
        for script in ("plot", "report"):
            failed += check(f"summary {text}", script, ["."], folder, (0, 2)) != 0
    assert failed > (50 if ALL else 20), failed


def body_is_damaged(work, chance):
    folder = work / "bodies"
    folder.mkdir()
    source, target = work / "body.h5", folder / "bad.h5"
    data, failed = source.read_bytes(), 0
    outs = ("a.npz", "a.sid", "a.xml", "a.h5mbs", "a.mtx")
    for i in range(30):
        target.write_bytes(data[:chance.randrange(len(data))] if i < 5 else flipped(data, chance))
        failed += check(f"body {i}", "export", ["bad.h5", "-o", chance.choice(outs)], folder, (0, 1, 2)) != 0
    for name in datasets(source):
        for value in (None, "text", [[1, 2], [3, 4]], float("nan")):
            with_dataset(source, target, name, value)
            check(f"{name}: {value}", "export", ["bad.h5", "-o", chance.choice(outs)], folder, (0, 2))
    assert failed >= 5, failed


def disk_is_full(work, _):
    folder = work / "full"
    shutil.copytree(work / "out", folder)
    shutil.copy(work / "body.h5", folder)
    for script, words, name in (("plot", ["--kind=probes", "."], "probes.png"), ("plot", ["--kind=energy", "--format=svg", "."], "energy.svg"),
                                ("plot", ["--kind=animation", "--frames=3", "."], "animation.gif"), ("report", ["."], "report.html"),
                                *(("export", ["body.h5", "-o", out], out) for out in ("a.npz", "a.sid", "a.xml", "a.h5mbs"))):
        check("full disk", script, words, folder, (1,), 512, name.split(".")[0])
        check("room", script, words, folder, (0,))


def floe(program, folder, *words):
    subprocess.run([program, *words], cwd=folder, check=True, capture_output=True)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    chance = random.Random(17)
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        (work / "scene.yaml").write_text(SCENE)
        floe(program, work, "run", "scene.yaml", "-o", "out")
        floe(program, work, "reduce", "scene.yaml", "-o", "body.h5")
        for path in set(map(str, SCRIPTS.values())):  # loaded once, for all attempts
            sys.path.insert(0, path)
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot  # noqa: F401
        full = subprocess.run(f"{program} plot out --kind probes >/dev/full", shell=True, cwd=work, capture_output=True, text=True)
        assert full.returncode == 1 and full.stderr.count("\n") == 1 and "standard output" in full.stderr, full
        (work / "out/probes.png").unlink()
        for case in (run_is_damaged, body_is_damaged, disk_is_full):
            case(work, chance)
            print(f"passed: {case.__name__}", flush=True)


if __name__ == "__main__":
    main()
