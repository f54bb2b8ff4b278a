"""Which files a command may write: nothing of the user's is replaced by a report."""

import argparse
import errno
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from gear_kinematics.bag.finding import is_recording
from gear_kinematics.correction.calibration_file import is_calibration
from gear_kinematics.report.mark import is_report

_INPUTS = ('bag', 'bags', 'recordings', 'config', 'calibration', 'check', 'measured')
"""Options and arguments that name files to read."""
_REPORT = 'report', is_report
_KINDS: Mapping[str, tuple[str, Callable[[Path], bool]]] = {
    '-o': ('calibration', is_calibration),
}
"""What options replace, if not reports."""


def add_force(parser: argparse.ArgumentParser) -> None:
    """Add the option to replace files that are no reports."""
    parser.add_argument(
        '--force',
        action='store_true',
        help='replace FILE even if it is no report of gearkin, but never a recording',
    )


def check_targets(options: argparse.Namespace, targets: Mapping[str, str | None]) -> None:
    """Check that files can be written and replace nothing else, before any other work.

    Args:
        options: the parsed arguments.
        targets: paths by the name of the option or argument; '-' is stdout.

    Raises:
        ValueError: naming the first file that must not or cannot be written.
    """
    files: dict[Path, str] = {}
    for option, name in targets.items():
        if not name or name == '-':
            continue
        given = Path(name)
        if given.exists() and not (given.is_file() or given.is_dir()):
            continue  # a pipe or a device, into which is written
        path = given.resolve()
        if path in files:
            raise ValueError(f'{files[path]} and {option} are both to write {name}')
        files[path] = option
        fault = _is_input(path, options) or _is_recording(path)
        if fault:
            raise ValueError(f'{option} {name}: {fault} is never replaced; name a file to write')
        _check_folder(name, path)
        if not path.exists() or options.force or not path.stat().st_size:
            continue
        kind, recognised = _KINDS.get(option, _REPORT)
        if not recognised(path):
            raise ValueError(
                f'{option} {name}: there is something else than a {kind} of gearkin; '
                '--force replaces it'
            )


def _is_recording(path: Path) -> str:
    return 'a recording' if is_recording(path) else ''


def _is_input(path: Path, options: argparse.Namespace) -> str:
    return 'what is read' if path in {given.resolve() for given in _inputs(options)} else ''


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
