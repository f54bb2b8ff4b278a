# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The options for reports, and their output in every form."""

import argparse
import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from types import MappingProxyType

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.files import add_force, check_targets, write_file, write_text
from gear_kinematics.commands.output import Console, closed_pipe_ignored
from gear_kinematics.report.document import Document, Origin, Verdict, printable
from gear_kinematics.report.html import to_html
from gear_kinematics.report.image import check_image, to_image
from gear_kinematics.report.json import to_json
from gear_kinematics.report.junit import to_junit
from gear_kinematics.report.text import render
from gear_kinematics.share import version

_FORMS: Mapping[str, Callable[[Document], str]] = {
    'json': to_json,
    'junit': to_junit,
    'html': to_html,
}
_EXIT_CODES = {
    None: ExitCode.DONE,
    Verdict.PASS: ExitCode.DONE,
    Verdict.FAIL: ExitCode.FAILED,
    Verdict.UNUSABLE: ExitCode.UNUSABLE,
}


def add_report_forms(parser: argparse.ArgumentParser, *, junit: bool = False) -> None:
    """Add the options for files of the report, which `Reporter` writes."""
    group = arguments.group(parser, 'output')
    for form in _FORMS:
        if junit or form != 'junit':
            name = 'JUnit' if form == 'junit' else form.upper()
            text = f'write the report as {name} (-: stdout)'
            group.add_argument(f'--{form}', metavar='FILE', help=text)
    group.add_argument('--plot', metavar='FILE', help='write a figure: .png, .svg or .pdf')
    add_force(parser)
    arguments.add_quiet(parser)


class Reporter:
    """Writes a document in the forms given by the options of `add_report_forms`."""

    def __init__(
        self,
        options: argparse.Namespace,
        sections: int = 1,
        others: Mapping[str, str | None] = MappingProxyType({}),
        *,
        compared: bool = False,
    ) -> None:
        """Check that everything can be written, before any other work.

        The document will have a number of sections; if `compared`, the last of several compares
        the others, and has the figure for `--plot`. The command itself writes `others`, by option.
        Raises ValueError if options exclude each other, or a file must not or cannot be written,
        and ModuleNotFoundError if a form needs a package that is not installed.
        """
        self._options = options
        # Reports without `--verbose` have nothing to leave out.
        self._brief = not getattr(options, 'verbose', True)
        self._forms = {form: target for form in _FORMS if (target := getattr(options, form, None))}
        given = {f'--{form}': target for form, target in self._forms.items()}
        given |= {'--plot': options.plot, **others}
        to_stdout = [option for option, target in given.items() if target == '-']
        if len(to_stdout) > 1:
            raise ValueError(f'only one report can go to stdout, not {" and ".join(to_stdout)}')
        check_targets(options, given)
        self._silent = bool(to_stdout)
        self._of_comparison = compared and sections > 1
        if options.plot:
            if sections > 1 and not compared:
                raise ValueError('--plot takes one recording')
            check_image(Path(options.plot))
        if 'html' in self._forms:
            import_module('plotly')

    def write(
        self, document: Document, configs: Iterable[Path] = (), *, printed: bool = True
    ) -> ExitCode:
        """Print the document, unless a form of it goes to stdout, and write the files.

        `configs` are the parameter files that were used. It is not `printed` if one line on stderr
        was enough. Returns the exit code for the verdict. Raises ValueError if there is nothing to
        plot; everything else is written by then.
        """
        plot: str | None = self._options.plot
        document = replace(document, origin=self._origin(configs))
        if printed and not self._silent:
            with closed_pipe_ignored():
                shown = document.of_failed() if self._options.quiet else document
                render(shown, Console(), brief=self._brief)
        for form, target in self._forms.items():
            write_text(target, _FORMS[form](document))
        if plot:
            last = document.sections[-1]
            if self._of_comparison and not last.leads:
                raise ValueError('--plot: the recordings have no torque ramps in common')
            if not (figure := last.image):
                raise ValueError(f'{plot}: there is nothing to plot')
            write_file(plot, to_image(figure, Path(plot)))
        return _EXIT_CODES[document.verdict]

    def _origin(self, configs: Iterable[Path]) -> Origin:
        """Record the time, the command, and each of its parameter files once."""
        digests = {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in configs}
        return Origin(
            version(),
            datetime.now(UTC).strftime('%Y-%m-%d %H:%M:%S UTC'),
            printable(self._options.command_line),
            tuple((printable(str(path)), digest) for path, digest in digests.items()),
        )
