# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Mark by which gearkin recognises the files that it wrote, so that it replaces no others."""

from pathlib import Path

MARK = 'made by gearkin'  # mark in comments of text files and in the metadata of images
_JSON = b'{\n  "made_by": "gearkin '
_STARTS = (b'<!DOCTYPE html>', b'<?xml ', b'\x89PNG\r\n', b'GIF8', b'%PDF-')
"""First bytes of files in the other formats."""
_SEARCHED = 2**16  # number of bytes at either end of a file that are searched for the mark


def is_report(path: Path) -> bool:
    """Return whether gearkin wrote a file; raises OSError if it cannot be read."""
    with path.open('rb') as file:
        start = file.read(_SEARCHED)
        file.seek(max(len(start), path.stat().st_size - _SEARCHED))
        ends = start + file.read(_SEARCHED)
    if start.startswith(_JSON):
        return True
    return start.startswith(_STARTS) and MARK.encode() in ends
