# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Replaces a file completely or not at all."""

import os
import secrets
import stat
from pathlib import Path


def replace_file(path: Path, content: bytes) -> None:
    """Write a file and flush it to the disk; a link to the file is kept.

    Raises:
        OSError: if the file cannot be written. The previous content then remains, whenever the
            error occurs.
    """
    path = Path(os.path.realpath(path))
    # Never too long a name, and another one than of a process that was killed.
    unfinished = path.with_name(f'.gearkin.{os.getpid()}.{secrets.token_hex(4)}.tmp')
    file = unfinished.open('xb')  # follows no existing link
    try:
        with file:
            if path.exists():
                os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode))
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)  # of the new name
    finally:
        os.close(folder)
