"""docs/extremes.md from the results of the studies."""
import datetime
import os
import platform
import subprocess

import numpy

HEAD = """# Numerical extremes

Every row varies one parameter to an extreme. At each point floe either returns a result or refuses with an exit code and a message of one
line. The error of a result is measured relative to a reference that floe did not compute (a closed form, a table, a few lines of numpy), to the same
scene in another form (in other units, at another scale), or to a run without the extreme.
Anything else fails the campaign: an error above its limit, a missing warning, a number that is not finite, a crash, a message of
PETSc. `make check` runs some of the points ({quick}), `make extremes` all of them, and writes this page.

Written by `make extremes` on {date}, floe {version}, {machine}: {points} points, {missed} missed, {failed} failed, {seconds:.0f} s.

*Maximum error* is that of all points of the row with a result, relative to the *limit* of the point.
"""


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((l.split(":")[1].strip() for l in file if l.startswith("model name")), platform.machine())


def version(floe):
    """With its commit."""
    return subprocess.run([floe, "--version"], capture_output=True, text=True, check=False).stdout.strip().removeprefix("floe ")


def number(x):
    return "0" if x == 0 else f"{x:.1e}" if x < 1e-3 else f"{x:.2g}"


def clean(text):
    return text.replace("|", "\\|").replace("\n", " ")


def row(study, found):
    answered = [f for f in found if f.error is not None and not f.miss]
    refused = [f for f in found if f.refusal is not None and not f.miss]
    failed = [f for f in found if f.fault or f.miss]
    held, worst = f"{len(found) - len(failed)} of {len(found)}", ""
    if answered:
        most = max(answered, key=lambda f: f.error / f.point.limit if f.point.limit else numpy.inf)
        worst = f"{number(most.error)} at {most.point.label} (limit {number(most.point.limit or 0)})"
    words = []
    if refused:
        one = refused[0]
        words.append(f"{len(refused)} refused with exit code {one.refusal.code}: \"{clean(one.refusal.text)}\"")
    notes = [f for f in answered if f.note]
    if notes:
        words.append(f"{notes[-1].point.label}: {clean(notes[-1].note)}")
    if study.remark:
        words.append(clean(study.remark))
    words += [f"**missed** at {f.point.label}: {clean(f.miss)}: {f.point.misses.cause}" if f.miss else
              f"**failed** at {f.point.label}: {clean(f.fault)}" for f in failed]
    return f"| {study.name} | {clean(study.extreme)} | {clean(study.against)} | {held} | {worst} | {'; '.join(words)} |"


def write(path, results, floe, seconds):
    studies = []
    for found in results:
        if found.study not in studies:
            studies.append(found.study)
    head = HEAD.format(quick=sum(f.point.quick for f in results), date=datetime.date.today().isoformat(),
                       version=version(floe), machine=processor(), points=len(results),
                       missed=sum(bool(f.miss) for f in results), failed=sum(bool(f.fault) for f in results),
                       seconds=seconds)
    lines = [head, "| extreme | range | reference | passed | maximum error | refusals, remarks, misses |",
             "| ------- | ----- | --------- | -----: | ------------- | ------------------------- |"]
    lines += [row(study, [f for f in results if f.study is study]) for study in studies]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "notes.md"), encoding="utf-8") as file:
        lines += ["", file.read().strip()]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
