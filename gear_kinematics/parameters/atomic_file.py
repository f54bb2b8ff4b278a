# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Writes a file completely or not at all."""

import errno
import os
import secrets
import stat
from contextlib import ExitStack
from pathlib import Path


def replace_file(path: Path, content: bytes, *, new: bool = False) -> None:
    """Write a file and flush it to the disk; a link to a file is kept.

    A process that is killed meanwhile leaves nothing behind, unless the file system has no files
    without a name, or in the moment between the two names. Raises OSError if the file cannot be
    written: it is there although it must be `new`, or a link leads to nothing. The previous
    content then remains, whenever the error occurs.
    """
    if new and os.path.lexists(path):
        raise FileExistsError(errno.EEXIST, 'exists already')
    if path.is_symlink() and not path.exists():
        raise OSError(errno.ELOOP, 'it is a link to nothing')
    path = Path(os.path.realpath(path))
    # This name is never too long, and differs from that of a process that was killed.
    unfinished = path.with_name(f'.gearkin.{os.getpid()}.{secrets.token_hex(4)}.tmp')

    def write(opened: Path, flags: int) -> None:
        file = os.open(opened, os.O_WRONLY | flags, 0o666)
        with os.fdopen(file, 'wb') as stream:
            if named := opened == unfinished:
                leaving.callback(unfinished.unlink, missing_ok=True)
            if path.exists():
                os.fchmod(file, stat.S_IMODE(path.stat().st_mode))
            stream.write(content)
            stream.flush()
            os.fsync(file)
            if not named:  # with a descriptor, link() follows its first path
                os.link(f'/proc/self/fd/{file}', unfinished, src_dir_fd=file)
                leaving.callback(unfinished.unlink, missing_ok=True)

    with ExitStack() as leaving:
        try:
            write(path.parent, getattr(os, 'O_TMPFILE', 0))
        except OSError:  # not every file system has files without a name
            write(unfinished, os.O_CREAT | os.O_EXCL)  # follows no existing link
        unfinished.replace(path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)  # of the new name
    finally:
        os.close(folder)
