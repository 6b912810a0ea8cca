"""Sphinx's settings: `sphinx-build -W docs docs/_build` makes the manual, without a network."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from docs._generate.docstrings import as_rst  # noqa: E402
from docs._generate.links import within_manual  # noqa: E402
from docs._generate.parts import filled  # noqa: E402
from docs._generate.parts.results_json import write as write_schema  # noqa: E402
from docs._generate.toctrees import with_toctrees  # noqa: E402

project = "areaproof"
copyright = "the authors; MIT"  # noqa: A001 - Sphinx's name
version = release = version_of("areaproof")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]
root_doc = "index"
exclude_patterns = ["_build", "_generate", "README.md"]
smartquotes = False  # quotation marks in sentences are code, too
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types in signatures are not ours alone

myst_heading_anchors = 3  # as a forge names headings
myst_links_external_new_tab = False

autodoc_typehints = "none"
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
python_maximum_signature_line_length = 80
add_module_names = False

html_theme = "furo"
html_title = f"{project} {release}"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_js_files = ["manual.js"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "a11y-high-contrast-light"  # of what furo brings along
pygments_dark_style = "a11y-high-contrast-dark"
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True
copybutton_line_continuation_character = "\\"


def read(_app: Any, page: str, source: list[str]) -> None:
    """The index as a forge shows it, with toctrees; every page with the parts of the code."""
    if page == root_doc:
        source[0] = with_toctrees((HERE / "README.md").read_text(encoding="utf-8"))
    source[0] = filled(within_manual(source[0], (HERE / page).parent, HERE))


def document(
    _app: Any, _what: str, _name: str, _object: Any, _options: Any, lines: list[str]
) -> None:
    """A docstring as reStructuredText."""
    lines[:] = as_rst(lines)


def setup(app: Any) -> None:
    """Sphinx calls it."""
    write_schema()
    app.connect("source-read", read)
    app.connect("autodoc-process-docstring", document)
