# Settings of Sphinx for the manual (make manual). The sources are the repository itself, so that links between pages,
# examples and files are the same in the repository and in the manual.
import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

project = "floe"
author = "the floe developers"
version = re.search(r"project\(floe VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "sphinx.ext.mathjax"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
include_patterns = ["docs/**", "examples/**"]
exclude_patterns = ["build*", "results", "docs/conf.py", "docs/api.md"]  # api.md: of make api
nitpicky = True

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3

html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 3, "titles_only": False}
html_title = f"floe {version}"
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False

# Formulas are set by KaTeX from Debian's package, in the page: the manual needs no network.
katex = Path("/usr/share/javascript/katex")
html_static_path = [str(katex), str(ROOT / "docs" / "static")]
mathjax_path = "katex.min.js"
mathjax_options = {"defer": "defer"}
html_css_files = ["katex.min.css", "manual.css"]
html_js_files = [("contrib/auto-render.js", {"defer": "defer"}), ("formulas.js", {"defer": "defer"})]


def schema():
    """All keys of scenes, from the program."""
    done = subprocess.run([os.environ["FLOE"], "schema", "--markdown"], capture_output=True, text=True, check=True)
    return done.stdout


# Index pages, and the pages that belong under them.
INDEXED = {"docs/index": "docs/*.md", "docs/benchmarks/index": "docs/benchmarks/*.md", "examples/index": "examples/*/README.md"}


def not_named(index, text):
    """Pages that an index does not list."""
    folder = (ROOT / index).parent
    pages = (page.relative_to(folder).with_suffix("").as_posix() for page in ROOT.glob(INDEXED[index]))
    named = set(re.findall(r"^[\w./]+$", text, re.M)) | {"index", "api"}
    return sorted(page for page in pages if page not in named)


def complete(app, docname, source):
    """Fills the page of keys; appends pages that an index does not list."""
    if docname == "docs/scene_reference":
        source[0] = ("# All keys of a scene\n\nFrom `floe schema`: every key with its meaning, permitted values, unit and "
                     "default. [Writing scenes](scenes.md) describes the structure of a scene.\n\n" + schema())
    if docname in INDEXED:
        more = not_named(docname, source[0])
        if more:
            source[0] += "\n```{toctree}\n" + "\n".join(more) + "\n```\n"


def setup(app):
    app.connect("source-read", complete)
