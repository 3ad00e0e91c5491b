#!/usr/bin/env python3
"""`floe report`: one page that holds everything, well formed; with `browser`, in a headless Chromium, the mechanism is played, scrubbed,
turned and enlarged, and its nodes are where the probes are.

report.py FLOE [browser]: in a folder of its own; 0 if all is as it should be, 77 (skipped) without a browser.
"""
import base64
import html.parser
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from small_scenes import BEAM, CRANK, PANEL, floe, probes, write

FLOE = pathlib.Path(sys.argv[1]).resolve()
VOID = {"meta", "input", "img", "br", "hr", "link"}


class Page(html.parser.HTMLParser):
    """Tags in order and balanced, what the page asks for from elsewhere, its texts and tables."""

    def __init__(self, text):
        super().__init__()
        self.open, self.asked, self.ids, self.images, self.text, self.rows = [], [], [], [], "", []
        self.feed(text)
        assert not self.open, f"not closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if tag not in VOID:
            self.open.append(tag)
        if "id" in values:
            self.ids.append(values["id"])
        for key in ("src", "href", "data", "action"):
            value = values.get(key, "")
            if value and not value.startswith(("data:", "#")):
                self.asked.append(value)
        if tag == "img":
            assert values["alt"], "a picture without a text"
            self.images.append(values["src"])
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"{tag} closes what it did not open"

    def handle_data(self, data):
        if "script" in self.open or "style" in self.open:
            return
        self.text += data
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def page_of(folder, name):
    said = floe(FLOE, folder, "report", name)
    assert said == f"Report: {name}/report.html\n", said
    text = (folder / name / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert not page.asked and "@import" not in text and "url(" not in text.partition("<script")[0], page.asked
    assert len(set(page.ids)) == len(page.ids)
    from PIL import Image
    for source in page.images:
        picture = Image.open(io.BytesIO(base64.b64decode(source.partition("base64,")[2])))
        assert len(np.unique(np.asarray(picture.convert("L")))) > 5
    return page, text


def of_a_run(folder):
    page, _ = page_of(folder, "crank")
    summary = json.loads((folder / "crank/summary.json").read_text())
    for word in ("Crank & <rod>", "vm+md", summary["label"], summary["provenance"]["petsc"], "vibration mode",
                 "modal derivative", "title: Crank & <rod>", "estimated error"):
        assert word in page.text, word
    for warning in summary["warnings"]:
        assert warning in page.text
    assert {"overview", "warnings", "motion", "pictures", "probes", "error", "model", "numbers", "timings", "scene",
            "provenance"} <= set(page.ids), page.ids
    assert len(page.images) == 3
    _, places = probes(folder / "crank")
    row = next(row for row in page.rows if row and row[0] == "end.x")
    assert np.isclose(float(row[1]), places["end"][-1, 0], rtol=1e-3) and row[4] == "m"
    columns = [row for row in page.rows if len(row) == 5 and row[1] == "vibration mode"]
    assert len(columns) == 2 and np.isclose(float(columns[0][2]), summary["bodies"][1]["frequencies"][0]["Hz"], rtol=1e-3)


def beyond_estimate(folder):
    """An error that is no estimate any more is null in the summary."""
    shutil.copytree(folder / "crank", folder / "beyond")
    summary = json.loads((folder / "crank/summary.json").read_text())
    summary["estimate"]["deformation"] = None
    summary["estimate"]["probes"] = dict.fromkeys(summary["estimate"]["probes"])
    (folder / "beyond/summary.json").write_text(json.dumps(summary))
    page, _ = page_of(folder, "beyond")
    assert page.text.count("beyond 10000 %") == 2, page.text
    assert any(row[1:] == ["beyond 10000"] for row in page.rows), page.rows


def by_full_order(folder):
    """The reduction error of a motion whose joints change is the difference to another simulation."""
    shutil.copytree(folder / "crank", folder / "switched")
    summary = json.loads((folder / "crank/summary.json").read_text())
    probes = summary["estimate"]["probes"]
    summary["estimate"] = {"probes": probes, "by": "formulation nlffr, same mesh", "total": {"probes": probes}}
    (folder / "switched/summary.json").write_text(json.dumps(summary))
    page, _ = page_of(folder, "switched")
    assert "comparison with formulation nlffr, same mesh" in page.text, page.text
    assert any(row[0] in probes and len(row) == 6 for row in page.rows), page.rows


def of_other_folders(folder):
    floe(FLOE, folder, "compare", "beam.yaml", "--formulations", "nlffr,vm+md", "-o", "compare", "--no-reference-error")
    page, _ = page_of(folder, "compare")
    assert len(page.images) == 1 and "nlffr" in page.text and "mechanism" in page.ids
    floe(FLOE, folder, "sweep", "beam.yaml", "--vary", "loads.tip.force[2]=500,1000", "-o", "sweep")
    page, _ = page_of(folder, "sweep")
    assert len(page.images) == 1 and any("1000" in row for row in page.rows)


def faults(folder):
    (folder / "mine.html").write_text("<html>mine</html>")
    told = floe(FLOE, folder, "report", "crank", "-o", "mine.html", code=2)
    assert told == "floe: report: mine.html: exists and is not a report written by floe; use another name with --out\n", told
    assert (folder / "mine.html").read_text() == "<html>mine</html>"
    told = floe(FLOE, folder, "report", "nothing", code=2)
    assert told == "floe: report: nothing: is not a folder; expected the results of a floe command\n", told


DRIVER = """<script>
(async () => {
  const said = {}, wait = ms => new Promise(done => setTimeout(done, ms)), by = id => document.getElementById(id);
  try {
    const view = window.floeView;
    if (!view) { said.none = by("mechanism-note").textContent; throw new Error(said.none); }
    const last = view.bodies[0].frames.length / 12 - 1, picture = () => view.canvas.toDataURL();
    const event = (name, x, y) => view.canvas.dispatchEvent(new PointerEvent(name, { clientX: x, clientY: y, bubbles: true, pointerId: 1 }));
    said.frames = last + 1;
    const first = picture();
    by("mechanism-time").value = last; by("mechanism-time").dispatchEvent(new Event("input"));
    said.scrubbed = view.state.frame; said.clock = by("mechanism-clock").textContent;
    said.places = Object.fromEntries(view.bodies.map(b => [b.name, Array.from(b.x)]));
    const end = picture(); said.changed = end !== first;
    const azimuth = view.state.azimuth;
    event("pointerdown", 100, 100); event("pointermove", 160, 130); event("pointerup", 160, 130);
    said.turned = view.state.azimuth !== azimuth && picture() !== end;
    const before = picture();
    by("mechanism-amplify").value = 5; by("mechanism-amplify").dispatchEvent(new Event("input"));
    said.amplified = Object.fromEntries(view.bodies.map(b => [b.name, Array.from(b.x)]));
    by("mechanism-amplify").value = 1; by("mechanism-amplify").dispatchEvent(new Event("input"));
    said.unamplified = picture() === before;
    by("mechanism-time").value = 0; by("mechanism-time").dispatchEvent(new Event("input"));
    const later = [], real = performance.now.bind(performance); let now = real();  // a clock of our own: the browser's is not told
    performance.now = () => now; window.requestAnimationFrame = tick => later.push(tick);
    const after = seconds => { now += 1000 * seconds; later.shift()(now); };
    by("mechanism-play").click(); after(4); said.played = view.state.frame;
    by("mechanism-play").click(); after(1); said.paused = !view.state.playing && view.state.frame === said.played;
    by("mechanism-play").click(); after(5); said.ended = !view.state.playing && view.state.frame === last && later.length === 0;
    const scratch = document.createElement("canvas"); scratch.width = view.canvas.width; scratch.height = view.canvas.height;
    const pen = scratch.getContext("2d"); pen.drawImage(view.canvas, 0, 0);
    const data = pen.getImageData(0, 0, scratch.width, scratch.height).data; let other = 0;
    for (let i = 0; i < data.length; i += 4) other += Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) > 30;
    said.drawn = 4 * other / data.length;
  } catch (error) { said.error = String(error); }
  const pre = document.createElement("pre"); pre.id = "driven"; pre.textContent = JSON.stringify(said); document.body.appendChild(pre);
})();
</script>"""


def driven(folder, name, chromium):
    text = (folder / name / "report.html").read_text(encoding="utf-8")
    page = folder / name / "driven.html"
    page.write_text(text.replace("</body>", DRIVER + "</body>"), encoding="utf-8")
    command = [chromium, "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
               "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={folder}/profile",
               "--window-size=1000,900", "--virtual-time-budget=60000", "--dump-dom", page.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    found = re.search(r'<pre id="driven">(.*?)</pre>', done.stdout, re.S)
    assert found, done.stderr[-2000:]
    said = json.loads(html.unescape(found.group(1)))
    assert "error" not in said, said["error"]
    return said


def in_a_browser(folder):
    chromium = shutil.which("chromium")
    for name, body, probe, node in (("crank", "rod", "end", -1), ("panel", "boom", "tip", -1)):
        said = driven(folder, name, chromium)
        _, places = probes(folder / name)
        end = np.zeros(3)
        end[:places[probe].shape[1]] = places[probe][-1]
        x = np.array(said["places"][body]).reshape(-1, 3)
        more = np.array(said["amplified"][body]).reshape(-1, 3)
        size = np.abs(x).max()
        assert np.linalg.norm(x[node] - end) < 2e-6 * size, (x[node], end)  # single precision
        assert said["scrubbed"] == said["frames"] - 1 and said["changed"] and said["turned"] and said["unamplified"], said
        assert np.abs(more - x).max() > 1e-6 * size
        assert abs(said["played"] / (said["frames"] - 1) - 0.5) < 0.02 and said["paused"] and said["ended"], said
        assert 0.001 < said["drawn"] < 0.9, said["drawn"]
        print(f"{name}: {said['frames']} instants, {100 * said['drawn']:.1f} % of the view drawn")


def main():
    if "browser" in sys.argv and not shutil.which("chromium"):
        print("SKIPPED: chromium is not installed (make check-look installs it)")
        return 77
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        for scene, text in (("crank", CRANK), ("panel", PANEL)):
            write(folder, f"{scene}.yaml", text)
            floe(FLOE, folder, "run", f"{scene}.yaml", "-o", scene)
            floe(FLOE, folder, "report", scene)
        write(folder, "beam.yaml", BEAM)
        for case in (in_a_browser,) if "browser" in sys.argv else (of_a_run, beyond_estimate, by_full_order, of_other_folders, faults):
            case(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
