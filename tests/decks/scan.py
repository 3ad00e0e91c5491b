#!/usr/bin/python3
"""Which decks of a folder floe reads, and why it refuses the others: a table in Markdown.

    tests/decks/scan.py FLOE FOLDER [--first-order] [--ignore-others]

Decks with shells or beams count (.inp, .bdf, .nas, .dat; also .gz). Each is read by `floe modes` of a scene with one
free body, two modes. --first-order replaces elements of second order by their corners: what remains are the refusals
that do not come from elements. --ignore-others leaves out solids, springs and the like."""
import collections
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

SHELL_OR_BEAM = re.compile(r"(S\d|STRI|B3\d|B2\d)")
NASTRAN = re.compile(r"^(CQUAD|CTRI|CBAR|CBEAM)", re.M)
CORNERS = {"S8": ("S4", [0, 1, 2, 3]), "S8R": ("S4", [0, 1, 2, 3]), "S6": ("S3", [0, 1, 2]),
           "B32": ("B31", [0, 2]), "B32R": ("B31", [0, 2]), "B32H": ("B31", [0, 2])}


OTHERS = ("C3D4, C3D6, C3D8, C3D8R, C3D8I, C3D10, C3D15, C3D20, C3D20R, SPRINGA, SPRING1, SPRING2, DASHPOTA, GAPUNI, DCOUP3D, T3D2, "
          "D, M3D3, M3D4, CTETRA, CHEXA, CPENTA, CELAS1, CELAS2, CBUSH, CROD, CONROD, RBE3")


def types_of(text):
    return set(re.findall(r"^\*ELEMENT\b.*?TYPE\s*=\s*([A-Z0-9]+)", text.upper(), re.M))


def first_order(text):
    """The deck with the corners of its elements of second order."""
    lines, out, at = text.splitlines(), [], 0
    while at < len(lines):
        line = lines[at]
        at += 1
        kind = re.match(r"\*ELEMENT\b.*?TYPE\s*=\s*([A-Z0-9]+)", line.upper())
        new = CORNERS.get(kind.group(1)) if kind else None
        if not new:
            out.append(line)
            continue
        out.append(re.sub(kind.group(1), new[0], line, count=1, flags=re.I))
        data = ""
        while at < len(lines) and (not lines[at].startswith("*") or lines[at].startswith("**")):
            if not lines[at].startswith("**"):
                data += " " + lines[at].strip() + ("" if lines[at].strip().endswith(",") else ",")
            at += 1
        numbers = [w for w in re.split(r"[\s,]+", data) if w]
        count = 1 + {"S8": 8, "S8R": 8, "S6": 6}.get(kind.group(1), 3)
        for i in range(0, len(numbers) - count + 1, count):
            out.append(", ".join([numbers[i]] + [numbers[i + 1 + c] for c in new[1]]))
    return "\n".join(out) + "\n"


def reason_of(message):
    """The first line without places and names."""
    line = re.sub(r"^floe: |^error: ", "", message.strip().splitlines()[0] if message.strip() else "(nothing)")
    line = re.sub(r"^\S*deck\.\w+(:\d+)?: ", "", line)
    line = re.sub(r"\(B31,.*\)|; to leave them out.*", "", line).strip()
    return re.sub(r"\b(element|node|nodes|elements) \d+", r"\1 N", line)[:150]


def read(floe, path, deck, others):
    """None where it is read, else the reason."""
    scene = path / "scene.yaml"
    scene.write_text("bodies:\n  body:\n    frame: mean-axis\n    reduction: {modes: 2}\n    mesh: {file: {path: %s%s}}\n"
                     % (deck, ", ignore: [%s]" % OTHERS if others else ""))
    try:
        done = subprocess.run([floe, "modes", str(scene)], capture_output=True, text=True, timeout=120, errors="replace")
    except subprocess.TimeoutExpired:
        return "more than 120 s"
    if done.returncode in (0, 2):
        return None if done.returncode == 0 else reason_of(done.stderr)
    return f"exit code {done.returncode}: {reason_of(done.stderr)}"


def main():
    flags = [a for a in sys.argv[1:] if a.startswith("--")]
    floe, folder = [a for a in sys.argv[1:] if not a.startswith("--")]
    read_count, massless, refused = 0, 0, collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for file in sorted(pathlib.Path(folder).rglob("*")):
            name = file.name.removesuffix(".gz")
            ending = pathlib.Path(name).suffix
            if ending not in (".inp", ".bdf", ".nas", ".dat") or not file.is_file():
                continue
            text = (gzip.open(file) if file.suffix == ".gz" else open(file, "rb")).read().decode(errors="replace")
            if ending == ".inp":
                if not any(SHELL_OR_BEAM.match(kind) for kind in types_of(text)):
                    continue
            elif not NASTRAN.search(text.upper()):
                continue
            if "--first-order" in flags:
                text = first_order(text)
            deck = "deck" + ending
            (scratch / deck).write_text(text)
            reason = read(floe, scratch, deck, "--ignore-others" in flags)
            if reason is None or "has mass; expected a material" in reason:
                read_count += 1
                massless += reason is not None
            else:
                refused[reason].append(name)
    total = read_count + sum(map(len, refused.values()))
    print(f"{read_count} of {total} decks are read ({massless} of them without density).\n\n| decks | refused because | which |\n|---|---|---|")
    for reason, names in sorted(refused.items(), key=lambda item: -len(item[1])):
        print(f"| {len(names)} | {reason} | {', '.join(names[:6])}{', ...' if len(names) > 6 else ''} |")


main()
