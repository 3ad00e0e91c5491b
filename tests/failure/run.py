#!/usr/bin/env python3
"""Every bad input and every fault at the command line: exit code, message (once, on stderr), files, no hang.

run.py FLOE RANKS [NAME...]: runs the cases of cases.py (those whose name contains NAME) on so many ranks. RANKS may be
4:0/2, the first of every two cases, and 2:1/2, the others: each on one rank and on several, in half the time.
"""
import concurrent.futures
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import traceback

import cases
import results

TIME_LIMIT = 120  # s; on a quiet machine no case takes more than a tenth of it


class Run:
    """One run of floe in a folder of its own, and what came of it."""

    def __init__(self, case, floe, ranks, folder):
        self.case, self.folder = case, folder
        self.words = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        self.ranks = ranks
        if case.scene is not None:
            data = case.scene if isinstance(case.scene, bytes) else case.scene.encode()
            (folder / "scene.yaml").write_bytes(data)
        for name, text in case.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        if case.prepare:
            case.prepare(folder)
        command = [str(floe), *case.arguments]
        if case.file_size:  # in KiB; inherited, as is that the signal is ignored: writing fails as on a full disk
            command = ["bash", "-c", f"trap '' XFSZ; ulimit -f {case.file_size}; exec \"$@\"", "bash", *command]
        self.words += command

    def execute(self):
        began = time.monotonic()
        environment = {**cases.ENVIRONMENT, **self.case.environment}
        with open(self.folder / self.case.stdout, "wb") as out, open(self.folder / "stderr", "wb") as err:
            process = subprocess.Popen(self.words, cwd=self.folder, stdout=out, stderr=err, env=environment)
            try:
                if self.case.signal:
                    self.send(process)
                self.code = process.wait(TIME_LIMIT)
            except BaseException:
                process.terminate()  # mpirun ends its ranks, too
                process.wait(10)
                raise
        self.seconds = time.monotonic() - began
        self.stdout = (self.folder / "stdout").read_text(errors="replace") if self.case.stdout == "stdout" else ""
        self.stderr = (self.folder / "stderr").read_text(errors="replace")

    def send(self, process):
        """The signal, when some rows have been written: SIGKILL to one rank, others to what was started."""
        until = time.monotonic() + TIME_LIMIT
        while not any(p.read_text().count("\n") > 2 for p in self.folder.rglob("probes.csv")):
            assert process.poll() is None and time.monotonic() < until, "no rows to interrupt"
            time.sleep(0.05)
        while self.case.signal == signal.SIGKILL and not results.has_rows(self.folder / "out/result.h5"):
            assert process.poll() is None and time.monotonic() < until, "no rows in result.h5 to interrupt"
            time.sleep(0.3)
        target = process.pid
        if self.case.signal == signal.SIGKILL and self.ranks > 1:
            children = pathlib.Path(f"/proc/{target}/task/{target}/children").read_text().split()
            target = int(children[0])
        os.kill(target, self.case.signal)

    def judge(self):
        case = self.case
        assert self.code in case.codes, f"exit code {self.code}, not {case.codes}"
        for phrase in case.says:
            found = self.stderr.count(phrase)
            assert found == 1, f"stderr has {found} times {phrase!r}"
        for phrase in case.shows:
            assert phrase in self.stdout, f"stdout lacks {phrase!r}"
        for phrase in ("PETSC ERROR", "terminate called", "Segmentation", "Sanitizer", *case.never):
            assert phrase not in self.stderr + self.stdout, f"{phrase!r} in the output"
        own = [line for line in self.stderr.splitlines() if line.startswith("floe: ")]
        assert len(own) == len(set(own)), "a message stands twice"
        if case.lines is not None:
            assert len(own) == case.lines, f"{len(own)} messages, not {case.lines}"
        if case.check:
            case.check(self.folder)


def attempt(case, floe, ranks):
    """Empty, or what is wrong."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        run = Run(case, floe, ranks, pathlib.Path(name))
        try:
            run.execute()
            run.judge()
        except Exception as fault:
            expected = isinstance(fault, (AssertionError, subprocess.TimeoutExpired))
            text = str(fault) if expected else traceback.format_exc()
            (run.folder / "stdout").touch()
            out, err = ((run.folder / file).read_text(errors="replace")[-1500:] for file in ("stdout", "stderr"))
            return f"FAIL {case.name}: {text}\n  {' '.join(case.arguments)}\n--- stdout\n{out}\n--- stderr\n{err}\n"
        return ""


def main():
    floe, wanted = pathlib.Path(sys.argv[1]).resolve(), sys.argv[3:]
    ranks, _, part = sys.argv[2].partition(":")
    ranks, (one, of) = int(ranks), map(int, (part or "0/1").split("/"))
    chosen = [c for c in cases.CASES if min(ranks, 2) in c.ranks and (not wanted or any(w in c.name for w in wanted))][one::of]
    assert len({c.name for c in chosen}) == len(chosen) > 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        failed = 0
        for fault in pool.map(lambda c: attempt(c, floe, ranks), chosen):
            failed += bool(fault)
            print(fault, end="", flush=True)
    print(f"{len(chosen)} cases on {ranks} ranks, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
