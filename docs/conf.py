"""What Sphinx makes of these pages and of those above this folder: `make docs`.

The sources are the whole project, so that links lead to the same place here and where the
Markdown is read as it is.
"""

import re
from typing import Any

from docutils import nodes
from numpy.typing import ArrayLike
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config as NapoleonConfig
from sphinx.ext.napoleon import GoogleDocstring
from sphinx.util.typing import stringify_annotation

_ALIASES = {
    r'ndarray\[tuple\[Any, \.\.\.\], dtype\[(\w+)\]\]': r'NDArray[\1]',
    re.escape(re.sub(r'(?:\w+\.)+', '', stringify_annotation(ArrayLike))): 'ArrayLike',
}
"""What numpy's aliases are spelled out as, and what stands in the sources."""

project = 'gear_kinematics'
root_doc = 'docs/index'
include_patterns = ['*.md', '*.rst', 'bags/*.md', 'benchmark/*.md', 'docs/*.md']
extensions = ['myst_parser', 'sphinx.ext.autodoc']
default_role = 'code'
highlight_language = 'none'
smartquotes_action = 'D'
autodoc_member_order = 'bysource'
autodoc_preserve_defaults = True
autodoc_default_options = {'members': True}
add_module_names = False
maximum_signature_line_length = 90
python_use_unqualified_type_names = True
myst_heading_anchors = 3
html_theme = 'furo'
html_title = project
html_static_path = ['style.css']
html_css_files = ['style.css']
html_copy_source = False
html_show_copyright = False


def setup(app: Sphinx) -> None:
    """Have docstrings read as they are written in this project."""
    app.connect('autodoc-process-docstring', _read_sections)
    app.connect('doctree-resolved', _name_arrays)


def _read_sections(
    app: Sphinx, what: str, name: str, obj: object, options: Any, lines: list[str]
) -> None:
    """Read Google's sections, but not attributes, whose words before a colon are no type here."""
    if what not in {'attribute', 'property'}:
        docstring = GoogleDocstring(lines, NapoleonConfig(), app, what, name, obj, options)
        lines[:] = docstring.lines()


def _name_arrays(app: Sphinx, document: nodes.document, name: str) -> None:
    """Write numpy's aliases as they stand in the sources."""
    del app, name
    for kind in (addnodes.desc_parameter, addnodes.desc_annotation, addnodes.desc_returns):
        for node in list(document.findall(kind)):
            spelled = text = ''.join(child.astext() for child in node)  # no arrow before returns
            for pattern, alias in _ALIASES.items():
                text = re.sub(pattern, alias, text)
            if text != spelled:
                node.children = [nodes.Text(text)]
