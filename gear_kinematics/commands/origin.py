"""How a report was made, for its page."""

import argparse
import hashlib
import shlex
import sys
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from pathlib import Path

from gear_kinematics.report.document import Origin, printable
from gear_kinematics.share import version


def command_line(arguments: Sequence[str] | None) -> str:
    """Return the command as typed in a shell; by default that of the process."""
    return shlex.join(['gearkin', *(sys.argv[1:] if arguments is None else map(str, arguments))])


def origin(options: argparse.Namespace, configs: Iterable[Path]) -> Origin:
    """Describe this moment, the command and its parameter files, each of them once.

    Raises:
        OSError: if one of the files has become unreadable.
    """
    digests = {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in configs}
    return Origin(
        version(),
        datetime.now(UTC).strftime('%Y-%m-%d %H:%M:%S UTC'),
        printable(options.command_line),
        tuple((printable(str(path)), digest) for path, digest in digests.items()),
    )
