#!/usr/bin/env python3
"""`floe report`: one self-contained page on the results of a floe command: no network, no other file."""
import argparse
import base64
import csv
import html
import os
import sys
import tempfile

sys.dont_write_bytecode = True
from plot import kinds_of  # noqa: E402
import style  # noqa: E402
from style import Damaged, Fault, drafted, duration, guarded, read_json, reading  # noqa: E402

THREE = ["/usr/share/javascript/three/three.min.js", "/usr/share/nodejs/three/build/three.min.js"]
HERE = os.path.dirname(os.path.abspath(__file__))
MARK = '<meta name="generator" content="floe">'
CAPTIONS = {"probes": "Probes versus time", "energy": "Energy, its change, and the violation of the constraints",
            "deformed": "The mechanism at selected instants, true to scale", "shapes": "Basis vectors",
            "compare": "The formulations, and their errors relative to the reference",
            "tradeoff": "Error versus computing time: the Pareto front of the models", "sweep": "The members of the sweep",
            "campbell": "Frequencies versus speed of rotation"}
REMARKS = {"mode": "vibration mode", "derivative": "modal derivative", "attachment": "attachment mode of a joint or load"}


def escaped(value):
    return html.escape(str(value))


def shown(value):
    if isinstance(value, float):
        return f"{value:.4g}"
    return "" if value is None else str(value)


def table(head, rows, left=()):
    """Rows of numbers and texts; those whose index is in `left` are grey."""
    cells = lambda row: "".join(  # noqa: E731
        f'<td class="number">{shown(c)}</td>' if isinstance(c, (int, float)) and not isinstance(c, bool)
        else f"<td>{escaped(shown(c))}</td>" for c in row)
    lines = [f'<tr{" class=left" if i in left else ""}>{cells(row)}</tr>' for i, row in enumerate(rows)]
    return ('<div class="wide"><table><thead><tr>' + "".join(f"<th>{escaped(h)}</th>" for h in head)
            + "</tr></thead><tbody>" + "".join(lines) + "</tbody></table></div>")


def section(name, title, body):
    return f'<section id="{name}"><h2>{escaped(title)}</h2>{body}</section>' if body else ""


def number_or_text(cell):
    try:
        return float(cell) if cell else ""
    except ValueError:
        return cell


def table_of_file(path, most=60):
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError:
        return ""
    more = f'<p class="quiet">and {len(rows) - 1 - most} more rows in {escaped(os.path.basename(path))}</p>' if len(rows) > most + 1 else ""
    return table(rows[0], [[number_or_text(c) for c in row] for row in rows[1:most + 1]]) + more if rows else ""


def leaves(value, name=""):
    """Names and values in nested objects."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, f"{name} {key}".strip())
    else:
        yield name.replace("_", " "), ", ".join(map(str, value)) if isinstance(value, list) else value


def facts(pairs):
    return '<ul class="facts">' + "".join(f"<li>{escaped(name)}<b>{escaped(shown(value))}</b></li>"
                                         for name, value in pairs if value not in (None, "")) + "</ul>"


# --- parts of the page, from a summary

BEYOND = "beyond 10000"  # no estimate any more: null in summaries


def per_cent(share):
    return style.per_cent(share) if share is not None else BEYOND + " %"


def overview(summary):
    status, seconds = summary.get("status", ""), summary.get("seconds", {})
    estimate = summary.get("estimate", {})
    pairs = [("formulation", summary.get("formulation")), ("model", summary.get("label")),
             ("unknowns", summary.get("unknowns", {}).get("coordinates")),
             ("steps", summary.get("integration", {}).get("steps")),
             ("reached", f"{summary['integration']['reached']:g} s" if "integration" in summary else None),
             ("offline", duration(seconds["offline"]) if "offline" in seconds else None),
             ("simulation", duration(seconds["motion"]) if "motion" in seconds else None),
             ("per step", duration(seconds["per_step"]) if "per_step" in seconds else None),
             ("estimated error", per_cent(estimate["deformation"]) if "deformation" in estimate else None)]
    good = status == "finished"
    reason = f": {escaped(summary['reason'])}" if summary.get("reason") else ""
    words = "finished" if good else "still running, or killed" if status == "running" else status
    return f'<p class="{"good" if good else "bad"}">{escaped(words)}{reason}</p>' + facts(pairs)


def warnings(summary):
    lines = list(summary.get("warnings") or [])
    notes = summary.get("estimate", {}).get("notes") or []
    lines += [f"estimate: {note}" for note in notes]
    if not lines:
        return "<p>None.</p>"
    return '<ul class="warnings">' + "".join(f"<li>{escaped(line)}</li>" for line in lines) + "</ul>"


def why(column, formulation):
    weight = f"modal interaction {column['interaction']:.2g} of the maximum" if "interaction" in column else ""
    if column["kept"]:
        return "kept" + (f"; {weight}" if weight else "")
    if formulation == "vm" and column["kind"] == "derivative":
        return "dropped: formulation vm has none"
    return f"dropped: all but {column['new_part']:.1g} of it is contained in the span of the previous ones"


def choice(summary):
    """Of a model that floe selected for an accuracy."""
    chosen = summary.get("accuracy")
    if not chosen:
        return ""
    words = (f"Selected for {'a total error' if chosen.get('of') == 'total' else 'an error of the reduction'} of at most "
             f"{100 * chosen['asked']:.3g} %: estimated error {per_cent(chosen['supported'])}, "
             f"{'within' if chosen['within'] else 'above'} the limit; {chosen['trials']} simulations of reduced models, "
             f"{duration(chosen['seconds'])}.")
    words += "".join(f" The {part} error is not bounded: {why}." for part, why in (chosen.get("unbounded") or {}).items())
    return (f"<p>{escaped(words)}</p>"
            + table(["decision", "selected", "measured reason"],
                    [[one["what"], one["choice"], one["reason"]] for one in chosen.get("decisions") or []]))


def model(summary):
    text = choice(summary)
    for body in summary.get("bodies") or []:
        words = [f"{body['nodes']} nodes, {body['elements']} elements, {body['dofs']} dofs"]
        if body.get("rigid"):
            words.append("rigid")
        if "reduced_file" in body:
            words.append(f"reduced body from {body['reduced_file']}")
        columns = body.get("basis") or []
        kept = sum(column["kept"] for column in columns)
        if columns:
            words.append(f"{body['reduced_coordinates']} coordinates: {kept} of {len(columns)} candidate vectors")
        elif not body.get("rigid"):
            words.append("full-order model")
        text += f"<h3>{escaped(body['name'])}</h3><p>{escaped('; '.join(words))}.</p>"
        if columns:
            hertz = iter(f["Hz"] for f in body.get("frequencies") or [])
            rows = [[c["column"], REMARKS.get(c["kind"], c["kind"]), next(hertz, "") if c["kind"] == "mode" else "",
                     float(c["new_part"]), why(c, summary.get("formulation"))] for c in columns]
            text += "<details open>" if len(rows) <= 30 else "<details>"
            text += "<summary>candidate vectors of the basis, and why they are kept or dropped</summary>" + table(
                ["candidate vector", "kind", "frequency [Hz]", "new part", "decision"], rows,
                {i for i, c in enumerate(columns) if not c["kept"]}) + "</details>"
    return text


def budget(estimate):
    """The parts of the error of the answer, and the total."""
    total = estimate.get("total", {}).get("probes")
    if not total:
        return ""
    parts = {"reduction": estimate, **{name: estimate.get(name) or {} for name in ("model", "mesh", "step")}}

    def cell(part, probe):
        if probe not in (part.get("probes") or {}):
            return "-"
        value = part["probes"][probe]
        return 100 * value if value is not None else BEYOND
    rows = [[probe, *(cell(part, probe) for part in parts.values()), cell(estimate["total"], probe)] for probe in total]
    missing = "".join(f"<p>No estimate of the {name} error: {escaped(part['none'])}.</p>"
                      for name, part in parts.items() if "none" in part)
    return ("<p>Error of the answer: reduction, model (strains and frames), mesh, step, and their total [%].</p>"
            + table(["probe", *parts, "total"], rows) + missing)


def errors(summary, run):
    estimate = summary.get("estimate")
    if not estimate:
        return ""
    if "none" in estimate:
        return f"<p>No estimate of the error: {escaped(estimate['none'])}.</p>" + budget(estimate)
    rows = [[name, 100 * value if value is not None else BEYOND] for name, value in (estimate.get("probes") or {}).items()]
    if "by" in estimate:
        return f"<p>Reduction error by comparison with {escaped(estimate['by'])}.</p>" + budget(estimate)
    return ("<p>Estimated without integrating the full-order model: error of this model relative to the full-order model of the same mesh, root "
            f"mean square over the simulated time. Deformations: {per_cent(estimate['deformation'])}; "
            f"{estimate['full_order_residuals']} full-order residuals, {estimate['columns']} further basis vectors.</p>"
            + (table(["probe", "estimated error [%]"], rows) if rows else "") + budget(estimate))


def probes(run):
    try:
        series, units = run.probes()
    except Fault:
        return ""
    rows = [[name, values[-1], min(values), max(values), units.get(name, "")]
            for name, values in series.items() if name != "t"]
    return table(["probe", "at the end", "least", "greatest", "unit"], rows) if rows else ""


def events(summary):
    rows = [[event["name"], event["what"], float(event["t"]), shown(event.get("kinetic_energy_lost"))]
            for event in summary.get("events") or []]
    return table(["event", "what", "time [s]", "kinetic energy lost [J]"], rows) if rows else ""


def numbers(summary):
    rows = [[name, value] for key in ("integration", "energy", "constraints", "unknowns")
            for name, value in leaves(summary.get(key) or {}, "energy" if key == "energy" else "")]
    return table(["what", "value"], rows) if rows else ""


def timings(summary):
    rows = [[name, value] for name, value in leaves(summary.get("seconds") or {})]
    for body in summary.get("bodies") or []:
        rows += [[f"{body['name']}: {name}", value] for name, value in leaves(body.get("seconds") or {})]
    return table(["stage", "seconds"], rows) if rows else ""


def provenance(description):
    rows = [[name, str(value)] for name, value in leaves(description.get("provenance") or {})]
    return table(["what", "value"], rows) if rows else ""


# --- pictures and the mechanism

def image(path, caption):
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    return (f'<figure><img alt="{escaped(caption)}" src="data:image/png;base64,{data}">'
            f'<figcaption class="quiet">{escaped(caption)}</figcaption></figure>')


def pictures(folder, kinds, run):
    import plot

    options = argparse.Namespace(dpi=110, probes=[], times=[], amplify=1.0, view=(-60.0, 25.0), shapes=6, body="", components=False)
    text = ""
    with tempfile.TemporaryDirectory() as scratch:
        for kind in kinds:
            path = os.path.join(scratch, kind + ".png")
            try:
                with reading(folder):
                    plot.draw(kind, folder, path, options, lambda _: run)
                text += image(path, CAPTIONS[kind])
            except Damaged:  # a report would hide it among its parts
                raise
            except Fault as fault:
                text += f'<p class="quiet">No picture of {escaped(kind)}: {escaped(fault)}</p>'
    return text


CONTROLS = """<div id="mechanism"></div><p id="mechanism-note" class="quiet">Drag to rotate, shift and drag to pan, wheel to zoom.
Colour: deformation, <span class="scale"></span> 0 to {greatest:.3g} m.</p>
<div id="mechanism-controls"><button id="mechanism-play" type="button">Play</button>
<input id="mechanism-time" type="range" min="0" value="0" step="1" aria-label="time"><span id="mechanism-clock"></span>
<label>speed <select id="mechanism-speed"><option value="0.25">¼</option><option value="0.5">½</option><option value="1" selected>1</option>
<option value="2">2</option><option value="4">4</option></select></label>
<label>deformations <input id="mechanism-amplify" type="range" min="1" max="20" step="1" value="1"><span id="mechanism-factor">× 1</span></label>
<button id="mechanism-home" type="button">Reset view</button></div>"""


def script(path):
    with open(path, encoding="utf-8") as file:
        return "<script>" + file.read().replace("</script", "<\\/script") + "</script>"


def mechanism(run):
    """The view, and the scripts that come last in the page."""
    from mechanism import script_data

    three = next((path for path in THREE if os.path.exists(path)), None)
    if three is None:
        return '<p class="quiet">No animation: three.js is missing (package libjs-three).</p>', ""
    try:
        data, none = script_data(run)
    except Damaged:
        raise
    except Fault as fault:
        data, none = None, str(fault)
    if data is None:
        return f'<p class="quiet">No animation: {escaped(none)}.</p>', ""
    greatest = float(data.partition('"greatest": ')[2].partition(",")[0])
    return (CONTROLS.format(greatest=greatest),
            script(three) + "<script>" + data + "</script>" + script(os.path.join(HERE, "viewer.js")))


def page(title, parts, scripts):
    with open(os.path.join(HERE, "report.css"), encoding="utf-8") as file:
        style = file.read()
    links = "".join(f'<a href="#{name}">{escaped(heading)}</a>' for name, heading, body in parts if body)
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">{MARK}'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><title>{escaped(title)}</title>'
            f"<style>{style}</style></head><body><h1>{escaped(title)}</h1><nav>{links}</nav>"
            + "".join(section(*part) for part in parts) + scripts + "</body></html>\n")


def of_run(folder, run):
    summary = run.summary
    view, scripts = mechanism(run) if os.path.exists(os.path.join(folder, "result.h5")) else ("", "")
    try:
        run.load()
        scene = (f"<p>{escaped(summary.get('scene', {}).get('file', ''))}, as it was read:</p>"
                 f"<pre>{escaped(run.scene_text)}</pre>")
    except Damaged:
        raise
    except Fault:
        scene = ""
    return [("overview", "Overview", overview(summary)), ("warnings", "Warnings", warnings(summary)),
            ("motion", "The mechanism in motion", view), ("pictures", "Pictures", pictures(folder, ["probes", "energy", "deformed"], run)),
            ("probes", "Probes", probes(run)), ("error", "Error of the model", errors(summary, run)),
            ("model", "Model selection", model(summary)), ("events", "Events", events(summary)),
            ("numbers", "The integration", numbers(summary)), ("timings", "Timings", timings(summary)),
            ("scene", "The scene", scene),
            ("provenance", "Provenance", provenance(summary))], scripts


def of_compare(folder, description):
    from results import Run

    parts, view, scripts = [], "", ""
    for one in description["runs"]:
        sub = os.path.join(folder, one["name"])
        if not view and os.path.exists(os.path.join(sub, "result.h5")):
            view, scripts = mechanism(Run(sub))
            view = f"<p>As {escaped(one['name'])}, {escaped(one.get('label', ''))}.</p>" + view
    stopped = [f"{one['name']}: {one['reason']}" for one in description.get("stopped") or []]
    warned = []
    for one in description["runs"]:
        path = os.path.join(folder, one["name"], "summary.json")
        if os.path.exists(path):
            warned += [f"{one['name']}: {line}" for line in read_json(path).get("warnings") or []]
    reference = f"<p>Errors are relative, root mean square over the simulated time; the reference is {escaped(description['reference'])}.</p>"
    parts += [("table", "Formulations", reference + table_of_file(os.path.join(folder, "compare.csv"))),
              ("warnings", "Warnings", warnings({"warnings": stopped + warned})),
              ("pictures", "Pictures", pictures(folder, ["compare"], None)), ("motion", "The mechanism in motion", view)]
    return parts, scripts


def of_tradeoff(folder, description):
    reference = description["reference"]
    words = f"<p>Total errors are relative to {escaped(reference['words'])}.</p>"
    if "choice" in description:
        variant = description["variants"][description["choice"]]
        words += (f"<p><b>{escaped(variant['name'])}</b> ({escaped(variant['formulation'])}) is the fastest model with a total error of at most "
                  f"{100 * description['accuracy']:g} % in every probe.</p>")
    else:
        words += f"<p>No model has a total error of at most {100 * description['accuracy']:g} %.</p>"
    return [("choice", "Model selection", words),
            ("pictures", "Pictures", pictures(folder, ["tradeoff"], None)),
            ("table", "Models", table_of_file(os.path.join(folder, "tradeoff.csv")))], ""


def of_others(folder, kind, summary):
    return [("overview", "Overview", overview(summary)), ("warnings", "Warnings", warnings(summary)),
            ("pictures", "Pictures", pictures(folder, [kind], None)),
            ("table", "Numbers", table_of_file(os.path.join(folder, kind + ".csv"))),
            ("timings", "Timings", timings(summary))], ""


def check_target(path):
    if not os.path.exists(path):
        return
    if not os.path.isfile(path):
        raise Fault(f"{path}: exists and is not a file")
    with open(path, encoding="utf-8", errors="replace") as file:
        if MARK not in file.read(400):
            raise Fault(f"{path}: exists and is not a report written by floe; use another name with --out")


def work():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--out")
    options = parser.parse_args()
    folder = options.folder
    if not os.path.isdir(folder):
        raise Fault(f"{folder}: is not a folder; expected the results of a floe command")
    kinds, _, folder = kinds_of(folder)
    out = options.out or os.path.join(folder, "report.html")
    check_target(out)
    with reading(folder):
        text = page_of(folder, kinds)
    with drafted(out) as draft, open(draft, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"Report: {out}")


def page_of(folder, kinds):
    from results import Run
    if kinds[0] in ("compare", "tradeoff"):
        description = read_json(os.path.join(folder, kinds[0] + ".json"))
        title = description.get("title", folder)
        parts, scripts = (of_compare if kinds[0] == "compare" else of_tradeoff)(folder, description)
        parts.append(("provenance", "Provenance", provenance(description)))
    else:
        run = Run(folder)
        title = run.title
        parts, scripts = of_run(folder, run) if kinds[0] == "probes" else of_others(folder, kinds[0], run.summary)
        if kinds[0] != "probes":
            parts.append(("provenance", "Provenance", provenance(run.summary)))
    return page(title, parts, scripts)


if __name__ == "__main__":
    sys.exit(guarded("report", work))
