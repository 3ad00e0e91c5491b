#!/usr/bin/env python3
"""Random one-token mutants of src against the tests: which of them does no test see?

mutate.py --count N --seed S [--room R...] [--files GLOB...] [--tests REGEX] [--retry] [--fresh]

Everything happens in a copy of the working tree (FOLDER/tree) with its own build folder. Each mutant: it does not compile
-> another one is drawn; its object file is the original's, or it is the initial value of an output argument -> equivalent;
else the tests run, those first that are near and fast, until one fails. FOLDER/results.jsonl has a line for each mutant: a
stopped campaign goes on where it was, with the tree that it began with (--fresh: begins anew). --retry takes the tree as it
is now and runs the tests on the survivors again, wherever their lines have gone.
"""
import argparse
import fnmatch
import hashlib
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import mutants

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIB = 1 << 30
FAILED = re.compile(r"^FAIL|\| FAIL", re.M)  # a line of a test of many cases, which need not come to its end
NOT_TESTS_OF_SRC = ("rooms", "manual", "package", "pictures/paraview", "pictures/browser", "mutants", "references", "table", "words")
AFTER_UNITS = ("worked.np1", "verification.np1", "convergence.np1", "exchange", "pictures/", "extremes", "examples/",
               "failure.np1", "restart.np1")


def synchronise(tree):
    """Makes the copy's files those of the working tree, and touches only what differs."""
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, text=True,
                           capture_output=True).stdout.splitlines()
    for old in {str(p.relative_to(tree)) for folder in ("src", "include", "tests") for p in tree.glob(f"{folder}/**/*")
                if p.is_file()} - set(names):
        (tree / old).unlink()
    for name in names:
        source, copy = ROOT / name, tree / name
        if not source.is_file():
            continue
        if not copy.exists() or copy.read_bytes() != source.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, copy)
            os.utime(copy)


def rooms_of(tree):
    """room -> the rooms that it may use."""
    text = (tree / "makefiles/rooms.cmake").read_text()
    return {name: uses.split() for name, uses in re.findall(r'^floe_room\((\w+) "[^"]*"([^)]*)\)', text, re.M)}


class Tests:
    """ctest's own list in the order in which they are run for a mutant of a room."""

    def __init__(self, tree, wanted):
        self.build = tree / "build"
        listed = json.loads(subprocess.run(["ctest", "--test-dir", self.build, "--show-only=json-v1"], check=True, text=True,
                                           capture_output=True).stdout)["tests"]
        self.all = {}
        for test in listed:
            if "command" not in test or test["name"].startswith(NOT_TESTS_OF_SRC) or not re.search(wanted, test["name"]):
                continue
            properties = {p["name"]: p["value"] for p in test["properties"]}
            command = list(test["command"])
            program = next((w for w in command if w.startswith(str(self.build)) and "/test_" in w), None)
            if program:
                command.insert(command.index(program) + 1, "--abort")
            self.all[test["name"]] = {"command": command, "cwd": properties.get("WORKING_DIRECTORY", self.build),
                                      "environment": dict(v.split("=", 1) for v in properties.get("ENVIRONMENT", [])),
                                      "target": pathlib.Path(program).name if program else "floe"}
        self.uses = rooms_of(tree)

    def order(self, room):
        dependants = [r for r in self.uses if room in self.uses[r] or room == "generate"]  # meshes of all tests
        near = [room, *dependants]

        def rank(name):
            unit = re.fullmatch(r"unit/(\w+)\.np(\d)", name)
            if unit:
                if unit[1] not in near:
                    return (9, 0, 0)
                return (1 if unit[2] == "1" else 2 if unit[1] == room else 4, int(unit[2]), near.index(unit[1]))
            for i, start in enumerate(AFTER_UNITS):
                if name.startswith(start):
                    return (3, i, 0)
            return (5, 0, 0)
        return [n for n in sorted(self.all, key=lambda n: (rank(n), n)) if rank(n)[0] < 9]


class Campaign:
    def __init__(self, arguments):
        self.arguments = arguments
        self.folder = pathlib.Path(arguments.folder).resolve()
        self.tree, self.build = self.folder / "tree", self.folder / "tree/build"
        if arguments.fresh and self.folder.exists():
            shutil.rmtree(self.folder)
        began = (self.tree / "CMakeLists.txt").exists()
        self.tree.mkdir(parents=True, exist_ok=True)
        self.original = self.folder / "original"  # of a file that is mutated now
        self.restore()
        if not began or arguments.retry:
            synchronise(self.tree)
        if not (self.build / "build.ninja").exists():
            self.shell(["cmake", "-S", self.tree, "-B", self.build, "-G", "Ninja", "-DFLOE_UNITY=OFF"])
        self.results = self.folder / "results.jsonl"
        self.done = [json.loads(line) for line in self.results.read_text().splitlines()] if self.results.exists() else []

    def shell(self, command):
        done = subprocess.run([str(c) for c in command], text=True, capture_output=True)
        if done.returncode:
            sys.exit(f"{command[0]} failed:\n{(done.stdout + done.stderr)[-3000:]}")

    def ninja(self, *targets):
        return subprocess.run(["ninja", "-C", self.build, f"-j{self.arguments.jobs}", *targets], text=True,
                              capture_output=True)

    def restore(self):
        """The mutated file as it was, also after a kill."""
        note = self.folder / "original.name"
        if self.original.exists() and note.exists():
            shutil.copy(self.original, self.tree / note.read_text())
        for file in (note, self.original):
            file.unlink(missing_ok=True)

    def place(self, name, text):
        file = self.tree / name
        shutil.copy(file, self.original)
        (self.folder / "original.name").write_text(name)
        file.write_text(text)

    def run(self, test, cpu, wall):
        """Whether the test passes, or why not; its seconds of processor and of clock."""
        scratch = self.folder / "scratch"
        shutil.rmtree(scratch, ignore_errors=True)
        scratch.mkdir()
        environment = {**os.environ, **test["environment"], "TMPDIR": str(scratch), "PYTHONUNBUFFERED": "1",
                       "OMPI_MCA_btl_vader_backing_directory": str(scratch), "OMPI_MCA_orte_tmpdir_base": str(scratch)}

        def limits():
            resource.setrlimit(resource.RLIMIT_CPU, (int(cpu) + 1, int(cpu) + 5))
            resource.setrlimit(resource.RLIMIT_FSIZE, (GIB, GIB))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_AS, (12 * GIB, 12 * GIB))
        began, used = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
        log = self.folder / "test.log"
        with open(log, "wb") as out:
            process = subprocess.Popen(test["command"], cwd=test["cwd"], env=environment, stdout=out, stderr=out,
                                       stdin=subprocess.DEVNULL, start_new_session=True, preexec_fn=limits)
            why, read = "", 0
            while process.poll() is None and not why:
                time.sleep(0.05 if time.monotonic() - began < 5 else 0.5)
                if time.monotonic() - began > wall:
                    why = "time-out"
                elif log.stat().st_size > read:
                    read = log.stat().st_size
                    if FAILED.search(log.read_text(errors="replace")):
                        why = "failed"
            if why:
                try:
                    os.killpg(process.pid, signal.SIGTERM)
                    process.wait(10)
                except (ProcessLookupError, subprocess.TimeoutExpired):
                    pass
            try:
                os.killpg(process.pid, signal.SIGKILL)  # and what it left
            except ProcessLookupError:
                pass
            process.wait()
        now = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime
        if not why and process.returncode not in (0, 77):  # 77: what the test needs is not installed
            why = "time-out" if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else "failed"
        return why, spent, time.monotonic() - began

    def baseline(self, tests, names):
        """Runs each test once without a mutant: all pass, and their times set the time-outs."""
        file = self.folder / "baseline.json"
        known = json.loads(file.read_text()) if file.exists() else {}
        for name in names:
            if name in known:
                continue
            why, cpu, wall = self.run(tests.all[name], 7200, 14400)
            if why:
                sys.exit(f"{name} {why} without a mutant:\n" + (self.folder / "test.log").read_text(errors="replace")[-3000:])
            known[name] = [round(cpu, 1), round(wall, 1)]
            print(f"without a mutant: {name} {cpu:.0f} s", flush=True)
            file.write_text(json.dumps(known, indent=1))
        return known

    def objects_of(self, name):
        return [p for p in self.build.glob(f"CMakeFiles/*.dir/{name}.o")]

    def judge(self, found, tests, times):
        """Compiles a mutant and runs the tests; its fate."""
        file = self.tree / found["file"]
        text = file.read_text()
        mutant = mutants.Mutant(found["start"], found["end"], found["put"], found["what"])
        if mutants.overwritten(text, mutant):
            return {"fate": "equivalent"}
        (target,) = self.objects_of(found["file"])
        kept = target.read_bytes()
        self.place(found["file"], mutant.of(text))
        try:
            if self.ninja(str(target.relative_to(self.build))).returncode:
                return {"fate": "does not compile"}
            if target.read_bytes() == kept:
                return {"fate": "equivalent"}
            began = time.monotonic()
            for name in tests.order(found["file"].split("/")[1]):
                test = tests.all[name]
                built = self.ninja(test["target"])
                if built.returncode:
                    return {"fate": "does not compile"}  # does not link: a template's other uses
                cpu, wall = times[name]
                why, _, _ = self.run(test, 30 + 4 * cpu, 120 + 20 * wall)
                if why:
                    return {"fate": "killed", "by": name, "how": why, "seconds": round(time.monotonic() - began)}
            return {"fate": "survived", "seconds": round(time.monotonic() - began)}
        finally:
            self.restore()
            os.utime(file)

    def draws(self):
        """All mutants of the chosen files in the order of the seed."""
        places = []
        for path in sorted((self.tree / "src").glob("*/*.cpp")):
            name = str(path.relative_to(self.tree))
            if self.arguments.room and path.parent.name not in self.arguments.room:
                continue
            if self.arguments.files and not any(fnmatch.fnmatch(name, f) for f in self.arguments.files):
                continue
            text = path.read_text()
            places += [(name, text, choices) for choices in mutants.mutants_of(text)]
        chance = random.Random(self.arguments.seed)
        chance.shuffle(places)
        for name, text, choices in places:
            mutant = chance.choice(choices)
            changed = mutant.of(text)
            begin, line = text.rfind("\n", 0, mutant.start) + 1, text.count("\n", 0, mutant.start) + 1
            after = changed[begin:changed.find("\n", mutant.start + len(mutant.put))]
            lines = text[begin:text.find("\n", mutant.end)]
            key = hashlib.sha256(f"{name}\0{changed}".encode()).hexdigest()[:16]
            yield {"key": key, "file": name, "line": line, "what": mutant.what, "begin": begin, "start": mutant.start,
                   "end": mutant.end, "put": mutant.put, "lines": lines, "before": " ".join(lines.split()),
                   "after": " ".join(after.split())}

    def where_now(self, survivor):
        """The survivor in the copy's sources as they are; None: its lines have changed."""
        file = self.tree / survivor["file"]
        text = file.read_text() if file.exists() else ""
        shift, length = survivor["start"] - survivor["begin"], survivor["end"] - survivor["start"]
        found = [m.start() for m in re.finditer("^" + re.escape(survivor["lines"]) + "$", text, re.M)]
        if not found:
            return None
        begin = min(found, key=lambda at: abs(text.count("\n", 0, at) + 1 - survivor["line"]))
        return {**survivor, "start": begin + shift, "end": begin + shift + length, "begin": begin,
                "line": text.count("\n", 0, begin) + 1}

    def record(self, found, fate):
        entry = {**found, **fate}
        self.done = [d for d in self.done if d["key"] != found["key"]] + [entry]
        draft = self.results.with_suffix(".draft")
        draft.write_text("".join(json.dumps(d) + "\n" for d in self.done))
        draft.replace(self.results)
        return entry

    def execute(self):
        arguments = self.arguments
        print("building the copy", flush=True)
        self.ninja("floe_version")  # build/include must be there for ccache to find what other copies compiled
        built = self.ninja()
        if built.returncode:
            sys.exit("the sources do not build without a mutant:\n" + built.stdout[-3000:])
        tests = Tests(self.tree, arguments.tests)
        survivors = [d for d in self.done if d["fate"] == "survived"]
        draws, known = survivors if arguments.retry else list(self.draws()), {d["key"]: d for d in self.done}
        rooms = {d["file"].split("/")[1] for d in draws}
        if not draws:
            sys.exit("nothing to mutate in the chosen files")
        names = sorted({n for room in rooms for n in tests.order(room)},
                       key=lambda n: min(tests.order(room).index(n) for room in rooms if n in tests.order(room)))
        times = self.baseline(tests, names)
        counted = []
        for found in draws:
            if sum(e["fate"] != "does not compile" for e in counted) >= arguments.count:
                break
            entry = known.get(found["key"])
            if not entry:
                entry = self.record(found, self.judge(found, tests, times))
                tell(entry)
            elif arguments.retry:
                now = self.where_now(found)
                entry = self.record(now, self.judge(now, tests, times)) if now else found
                tell(entry) if now else print(f"{found['file']}:{found['line']}: its lines have changed", flush=True)
            counted.append(entry)
        self.ninja()
        return report(self.done if arguments.retry else counted, arguments)


def tell(entry):
    if entry["fate"] != "does not compile":
        by = f" by {entry['by']} ({entry['how']})" if "by" in entry else ""
        print(f"{entry['file']}:{entry['line']}: {entry['what']}: {entry['fate']}{by}", flush=True)


def report(entries, arguments):
    fates = {f: [e for e in entries if e["fate"] == f] for f in ("killed", "survived", "equivalent", "does not compile")}
    for entry in fates["survived"]:
        print(f"\nsurvived: {entry['file']}:{entry['line']} ({entry['what']})\n  - {entry['before']}\n  + {entry['after']}")
    killed, survived, equivalent = (len(fates[f]) for f in ("killed", "survived", "equivalent"))
    rate = 100 * (killed + equivalent) / max(killed + survived + equivalent, 1)
    print(f"\nseed {arguments.seed}: {killed + survived + equivalent} mutants compiled ({len(fates['does not compile'])} did "
          f"not): {killed} killed, {equivalent} equivalent (same object file, or initial value of an output argument), {survived} survived: {rate:.1f} % killed or "
          "equivalent")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--room", nargs="*", default=[])
    parser.add_argument("--files", nargs="*", default=[], help="patterns such as src/fem/shell_*.cpp")
    parser.add_argument("--tests", default="", help="regular expression of the tests' names")
    parser.add_argument("--folder", default=ROOT / "build-mutate")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--retry", action="store_true", help="the survivors again, in the tree as it is now")
    parser.add_argument("--fresh", action="store_true", help="forgets the campaign, copies the sources as they are now")
    sys.exit(Campaign(parser.parse_args()).execute())


if __name__ == "__main__":
    main()
