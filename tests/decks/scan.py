#!/usr/bin/python3
"""Which decks of a folder floe reads, and why it refuses the others: a table in Markdown.

    tests/decks/scan.py FLOE FOLDER [--ignore-others] [--table PAGE]

Decks with shells or beams count (.inp, .bdf, .nas, .dat; also .gz). Each is read by `floe modes` of a scene with one
free body, two modes; where the deck has no section for some elements, the scene gives one. --ignore-others leaves out solids, springs and the like. --table writes a line for each
deck between the marks `<!-- decks -->` and `<!-- end of decks -->` of a page: elements, read or why not, and the first
frequency of the body without supports beside that of CalculiX (ccx) on its elements alone: without steps, supports,
links and what floe ignores, of decks with at least 20 shells and beams. There materials without *DENSITY have 1, in both programs."""
import collections
import gzip
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SHELL_OR_BEAM = re.compile(r"(S\d|STRI|B3\d|B2\d)")
NASTRAN = re.compile(r"^(CQUAD|CTRI|CBAR|CBEAM)", re.M)
OTHERS = ("C3D4, C3D6, C3D8, C3D8R, C3D8I, C3D10, C3D15, C3D20, C3D20R, SPRINGA, SPRING1, SPRING2, DASHPOTA, GAPUNI, DCOUP3D, T3D2, "
          "D, M3D3, M3D4, CTETRA, CHEXA, CPENTA, CELAS1, CELAS2, CBUSH, CROD, CONROD, RBE3")


def types_of(text):
    return set(re.findall(r"^\*ELEMENT\b.*?TYPE\s*=\s*([A-Z0-9]+)", text.upper(), re.M))


def reason_of(message):
    """The first line without places and names."""
    line = re.sub(r"^floe: |^error: ", "", message.strip().splitlines()[0] if message.strip() else "(nothing)")
    line = re.sub(r"^\S*scene\.yaml:\d+:\d+: [\w.]+: ", "", line)  # the place in the scene, before that in the deck
    line = re.sub(r"^.*?\.(inp|bdf|nas|dat)(:\d+)?: ", "", line)
    line = re.sub(r"\(B31,.*\)|; to leave .*", "", line).strip()
    return re.sub(r"\b(element|node|nodes|elements) \d+", r"\1 N", line)[:150]


SECTIONS = ["section: {thickness: 0.01}", "section: {shape: rectangle, width: 0.01, height: 0.01}"]


def read_anyhow(floe, path, deck, others):
    """None where it is read, perhaps with a section of the scene, else the reason without one; and whether it took one."""
    reason = read(floe, path, deck, others)
    if reason and re.search("has no section|property \\d+, which is not defined|has a thickness;", reason):
        for section in SECTIONS:
            if read(floe, path, deck, others, f"    {section}\n    material: {{E: 2e11, nu: 0.3, rho: 7800}}\n") is None:
                return None, True
    return reason, False


def read(floe, path, deck, others, section=""):
    """None where it is read, else the reason."""
    scene = path / "scene.yaml"
    scene.write_text("bodies:\n  body:\n    frame: mean-axis\n    reduction: {modes: 2}\n%s    mesh: {file: {path: \"%s\"%s}}\n"
                     % (section, deck, ", ignore: [%s]" % OTHERS if others else ""))
    try:
        done = subprocess.run([floe, "modes", str(scene)], capture_output=True, text=True, timeout=120, errors="replace")
    except subprocess.TimeoutExpired:
        return "more than 120 s"
    if done.returncode in (0, 2):
        return None if done.returncode == 0 else reason_of(done.stderr)
    return f"exit code {done.returncode}: {reason_of(done.stderr)}"


def decks(folder):
    """Name, text and path of each deck with shells or beams."""
    for file in sorted(pathlib.Path(folder).rglob("*")):
        name = file.name.removesuffix(".gz")
        ending = pathlib.Path(name).suffix
        if ending not in (".inp", ".bdf", ".nas", ".dat") or not file.is_file():
            continue
        text = (gzip.open(file) if file.suffix == ".gz" else open(file, "rb")).read().decode(errors="replace")
        if ending == ".inp" and not any(SHELL_OR_BEAM.match(kind) for kind in types_of(text)):
            continue
        if ending == ".inp" or NASTRAN.search(text.upper()):
            yield name, text, file.resolve()


KEPT = {"NODE", "ELEMENT", "NSET", "ELSET", "MATERIAL", "ELASTIC", "DENSITY", "SHELLSECTION", "BEAMSECTION", "BEAMGENERALSECTION",
        "ORIENTATION", "NODALTHICKNESS", "MASS", "INCLUDE"}


def elements_alone(text):
    """The deck's shells, beams and masses with their sections; materials without *DENSITY get 1."""
    blocks = [b for b in re.split(r"(?m)^(?=\*[^*])", text) if b.startswith("*")]
    keyword = lambda b: re.sub(r"\s", "", b.split(",")[0].split("\n")[0]).upper().lstrip("*")
    kept = []
    for block in blocks:
        if keyword(block) == "STEP":
            break
        kind = re.search(r"TYPE\s*=\s*([A-Z0-9]+)", block.split("\n")[0].upper()) if keyword(block) == "ELEMENT" else None
        if keyword(block) not in KEPT or (kind and kind.group(1) != "MASS" and not SHELL_OR_BEAM.match(kind.group(1))):
            continue
        kept.append(block if block.endswith("\n") else block + "\n")
    for i in reversed([i for i, b in enumerate(kept) if keyword(b) == "MATERIAL"]):
        rest = [keyword(b) for b in kept[i + 1:]]
        if "DENSITY" not in rest[:rest.index("MATERIAL") if "MATERIAL" in rest else None]:
            kept.insert(i + 1, "*DENSITY\n1.\n")
    return "".join(kept)


def counts_of(text):
    """`24 S8R, 3 MASS` of a deck of CalculiX."""
    counts, kind = collections.Counter(), None
    nodes = {"S8": 8, "S8R": 8, "S6": 6, "S4": 4, "S4R": 4, "S3": 3, "B31": 2, "B31R": 2, "B32": 3, "B32R": 3, "MASS": 1}
    fields = 0
    for line in text.upper().splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            fields = 0
            found = re.match(r"\*ELEMENT\b.*?TYPE\s*=\s*([A-Z0-9]+)", line)
            kind = found.group(1) if found else None
        elif kind:
            fields += len([w for w in line.split(",") if w.strip()])
            if fields > nodes.get(kind, 0):
                counts[kind] += 1
                fields = 0
    return ", ".join(f"{n} {kind}" for kind, n in sorted(counts.items()))


def first_frequency(floe, folder, text):
    """Of floe and of CalculiX, free of supports, in Hz; None where there is none."""
    alone = elements_alone(text)
    (folder / "alone.inp").write_text(alone)
    own = reference = None
    done = subprocess.run([floe, "check", "alone.inp", "--frequencies", "1"], cwd=folder, capture_output=True, text=True, timeout=300, errors="replace")
    found = re.findall(r"^body +1 +([-+.\de]+)$", done.stdout, re.M)
    if done.returncode == 0 and found:
        own = float(found[-1])
    if own and shutil.which("ccx"):
        (folder / "ccx.inp").write_text(alone + "*STEP\n*FREQUENCY\n10\n*END STEP\n")
        try:
            subprocess.run(["ccx", "ccx"], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, timeout=20)
            rows = re.findall(r"^\s+\d+\s+([-\d.E+]+)\s+([-\d.E+]+)\s+([-\d.E+]+)\s+[-\d.E+]+\s*$", (folder / "ccx.dat").read_text(), re.M)
            reference = float(rows[6][2])
        except (subprocess.TimeoutExpired, OSError, IndexError):
            pass
        for file in folder.glob("ccx.*"):
            file.unlink()
    return own, reference


def table(floe, folder, page):
    """A line for each deck, into the page."""
    lines = ["| deck | elements | floe | first frequency [Hz] | CalculiX | difference |", "|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for name, text, path in decks(folder):
            deck = "deck" + pathlib.Path(name).suffix
            (scratch / deck).write_text(text)
            words, own, reference = "read", None, None
            reason = read(floe, scratch, deck, False)
            if reason and "left out" not in reason and "has mass" not in reason:
                others = read(floe, scratch, deck, True)
                words = f"refused: {reason}" if others and "has mass" not in others else "read without solids and springs"
            elif reason:
                words = "read (no density)"
            enough = sum(int(n) for n in re.findall(r"(\d+) (?:S\d|B3)", counts_of(text))) >= 20
            if words.startswith("read") and name.endswith(".inp") and enough:
                own, reference = first_frequency(floe, scratch, text)
            number = lambda x: f"{x:.5g}" if x else "-"
            error = f"{100 * (own / reference - 1):+.2f} %" if own and reference else "-"
            lines.append(f"| {name} | {counts_of(text)} | {words} | {number(own)} | {number(reference)} | {error} |")
            print(lines[-1], flush=True)
    text = pathlib.Path(page).read_text()
    begin, end = "<!-- decks -->\n", "<!-- end of decks -->"
    pathlib.Path(page).write_text(text[:text.index(begin) + len(begin)] + "\n".join(lines) + "\n" + text[text.index(end):])


def main():
    flags = [a for a in sys.argv[1:] if a.startswith("--")]
    floe, folder, *page = [a for a in sys.argv[1:] if not a.startswith("--")]
    floe = str(pathlib.Path(floe).resolve())
    if "--table" in flags:
        return table(floe, folder, page[0])
    read_count, massless, sectionless, refused = 0, 0, 0, collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for name, text, path in decks(folder):
            deck = str(path)  # beside the files that it includes
            if path.suffix == ".gz":
                deck = "deck" + pathlib.Path(name).suffix
                (scratch / deck).write_text(text)
            reason, section = read_anyhow(floe, scratch, deck, "--ignore-others" in flags)
            if reason is None or "has mass; expected a material" in reason:
                read_count += 1
                massless += reason is not None
                sectionless += section
            else:
                refused[reason].append(name)
    total = read_count + sum(map(len, refused.values()))
    print(f"{read_count} of {total} decks are read ({massless} of them without density, {sectionless} with a section of the scene).\n\n| decks | refused because | which |\n|---|---|---|")
    for reason, names in sorted(refused.items(), key=lambda item: -len(item[1])):
        print(f"| {len(names)} | {reason} | {', '.join(names[:6])}{', ...' if len(names) > 6 else ''} |")


main()
