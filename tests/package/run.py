#!/usr/bin/env python3
"""Installs floe into a folder of its own and builds swing.cpp against it twice: by find_package and by pkg-config."""
import math
import os
import subprocess
import sys
import tempfile


def run(*command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def check(printed):
    """A rigid rod falls from the horizontal to the bottom in K(1/sqrt 2) sqrt(2 L/(3 g)); this one is nearly rigid."""
    times = [tuple(map(float, line.split())) for line in printed.splitlines()]
    assert len(times) == 3, printed
    for length, time in times:
        rigid = 1.8540746773 * math.sqrt(2 * length / (3 * 9.81))
        assert abs(time / rigid - 1) < 0.05, (length, time, rigid)


def main():
    build, here = sys.argv[1], os.path.dirname(os.path.abspath(__file__))
    with tempfile.TemporaryDirectory() as folder:
        prefix, own = os.path.join(folder, "prefix"), os.path.join(folder, "build")
        run("cmake", "--install", build, "--prefix", prefix)
        assert "floe" in run(os.path.join(prefix, "bin", "floe"), "--version")
        run("cmake", "-S", here, "-B", own, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", own)
        check(run(os.path.join(own, "swing")))
        found = next(os.path.join(path, "pkgconfig") for path, folders, _ in os.walk(prefix) if "pkgconfig" in folders)
        flags = run("pkg-config", "--cflags", "--libs", "floe", PKG_CONFIG_PATH=found).split()
        program = os.path.join(folder, "swing")
        run("c++", "-O0", os.path.join(here, "swing.cpp"), "-o", program, *flags)
        check(run(program))


if __name__ == "__main__":
    main()
