# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What Sphinx makes of these pages and of those above this folder: `make docs`.

The sources are the whole project, so that links lead to the same place here and where the
Markdown is read as it is.
"""

import gc
import logging
import os
import re
import shlex
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any
from unittest.mock import patch

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from numpy.typing import ArrayLike
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.ext.napoleon import Config as NapoleonConfig
from sphinx.ext.napoleon import GoogleDocstring
from sphinx.util.typing import stringify_annotation
from sphinxarg.ext import ArgParseDirective

from gear_kinematics.commands import cli

_ALIASES = {
    r'ndarray\[tuple\[Any, \.\.\.\], dtype\[(\w+)\]\]': r'NDArray[\1]',
    re.escape(re.sub(r'(?:\w+\.)+', '', stringify_annotation(ArrayLike))): 'ArrayLike',
}
"""What numpy's aliases are spelled out as, and what stands in the sources."""

_ROOT = Path(__file__).parents[1]
_STYLES = re.compile(r'\x1b\[[\d;]*m')
_WIDTH = 92  # characters
_UNUSABLE = 2  # exit code
gc.set_threshold(50_000)  # a fifth of the time went into collections of garbage
logging.getLogger('numexpr').setLevel(logging.WARNING)  # it says how many processors there are

_FOLDERS = ('bags', 'benchmark', 'docs', 'docs/reference', 'docs/reference/gearkin', 'findings')

project = 'gear_kinematics'
root_doc = 'docs/index'
include_patterns = ['*.md', '*.rst', *(f'{folder}/*.md' for folder in _FOLDERS)]
exclude_patterns = ['.*', 'build', 'test']  # which are large, and would be searched for pages
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinxarg.ext']
default_role = 'code'
highlight_language = 'none'
smartquotes = False
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


class _Run(Directive):
    """Show a command and what it prints on a terminal: `{run}`, with the command below."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Run it in the folder of the project, in this process, which has imported it all."""
        command = ' '.join(line.rstrip('\\').strip() for line in self.content)
        program, *words = shlex.split(command)
        if program != 'gearkin':
            raise self.error(f'{program} is not gearkin')
        terminal = {'FORCE_COLOR': '1', 'TERM': 'xterm', 'COLUMNS': str(_WIDTH)}
        output, errors = StringIO(), StringIO()
        with (
            chdir(_ROOT),
            patch.dict(os.environ, terminal),
            redirect_stdout(output),
            redirect_stderr(errors),
        ):
            code = cli.main(words)
        if code == _UNUSABLE:
            raise self.error(errors.getvalue())
        lines = (line.rstrip() for line in _STYLES.sub('', output.getvalue()).splitlines())
        text = '\n'.join([f'$ {self.content[0]}', *self.content[1:], *lines])
        return [nodes.literal_block(text, text)]


class _Commands(Directive):
    """List the commands, with their purposes and links to their pages: `{commands}`."""

    def run(self) -> list[nodes.Node]:
        """Take them from the table that the program uses."""
        rows = [
            f'| [{name}](gearkin/{name}.md) | {purpose} |'
            for name, (purpose, _) in cli.COMMANDS.items()
        ]
        found = nodes.container()
        self.state.nested_parse(StringList(['| command | |', '|---|---|', *rows]), 0, found)
        return found.children


class _Arguments(ArgParseDirective):
    """List the arguments of a command: `{arguments} validate`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Take them from the parser that the program uses."""
        self.options |= {'module': cli.__name__, 'func': cli.make_parser.__name__}
        self.options |= {'prog': 'gearkin', 'path': self.arguments[0]}
        self.options |= dict.fromkeys(('nodescription', 'nodefaultconst'), True)
        return super().run()


def setup(app: Sphinx) -> None:
    """Have docstrings read as they are written in this project, and commands run."""
    app.add_directive('run', _Run)
    app.add_directive('commands', _Commands)
    app.add_directive('arguments', _Arguments)
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
