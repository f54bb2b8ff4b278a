# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Files that a command writes; a report never replaces a file of the user's."""

import argparse
import errno
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from gear_kinematics.bag.finding import is_recording
from gear_kinematics.commands.arguments import group
from gear_kinematics.commands.output import closed_pipe_ignored
from gear_kinematics.correction.calibration_file import is_calibration
from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.report.mark import is_report

_INPUTS = ('bag', 'bags', 'recordings', 'config', 'calibration', 'check', 'measured')
"""Options and arguments that name files to read."""
_REPLACEABLE = {'-o': ('calibration', is_calibration)}
"""Test of the files other than reports that an option may replace."""


def add_force(parser: argparse.ArgumentParser) -> None:
    """Add the option to replace files other than reports."""
    text = 'replace FILE even if gearkin did not write it, but never a recording'
    group(parser, 'output').add_argument('--force', action='store_true', help=text)


def check_targets(options: argparse.Namespace, targets: Mapping[str, str | None]) -> None:
    """Check before any work that files can be written and replace only files of the same kind.

    The targets are paths by the name of the option or argument; '-' is stdout. Raises ValueError,
    which names the first file that must not or cannot be written.
    """
    inputs = {given.resolve() for given in _inputs(options)}
    files: dict[Path, str] = {}
    for option, name in targets.items():
        if not name or name == '-':
            continue
        given = Path(name)
        if given.exists() and not (given.is_file() or given.is_dir()):
            continue  # a pipe or a device, into which is written
        if given.is_symlink() and not given.exists():
            raise ValueError(f'{option} {name}: it is a link to nothing; name a file to write')
        path = given.resolve()
        if path in files:
            raise ValueError(f'{files[path]} and {option} would both write {name}')
        files[path] = option
        if path in inputs or is_recording(path):
            kind = 'what is read' if path in inputs else 'a recording'
            raise ValueError(f'{option} {name}: {kind} is never replaced; name a file to write')
        _check_folder(name, path)
        if not path.exists() or options.force or not path.stat().st_size:
            continue
        kind, recognised = _REPLACEABLE.get(option, ('report', is_report))
        if not recognised(path):
            raise ValueError(
                f'{option} {name}: exists, and is no {kind} of gearkin; --force replaces it'
            )


def _inputs(options: argparse.Namespace) -> Iterator[Path]:
    for name in _INPUTS:
        given = getattr(options, name, None)
        yield from map(Path, given if isinstance(given, list) else [given] if given else [])


def _check_folder(name: str, path: Path) -> None:
    """Check the folder now, rather than after hours of work."""
    if path.is_dir():
        number = errno.EISDIR
    elif not path.parent.exists():
        number = errno.ENOENT
    elif not path.parent.is_dir():
        number = errno.ENOTDIR
    elif not os.access(path.parent, os.W_OK | os.X_OK):
        number = errno.EACCES
    else:
        return
    raise ValueError(f'{name}: {os.strerror(number)}')


def write_text(target: str, text: str) -> None:
    """Write a text as `write_file` does; '-' is stdout."""
    if target == '-':
        with closed_pipe_ignored():
            print(text, end='' if text.endswith('\n') else '\n')
    else:
        write_file(target, text.encode())


def write_file(target: str, content: bytes) -> None:
    """Write a file completely or not at all; raises ValueError with its name if that fails."""
    path = Path(target)
    try:
        if path.exists() and not path.is_file():  # such as a pipe, which must not be replaced
            path.write_bytes(content)
        else:
            replace_file(path, content)
    except OSError as error:
        raise ValueError(f'{target}: {error.strerror}') from error
