# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Location of the files that are installed with the package: config, launch files, bags."""

import re
from pathlib import Path

PACKAGE = 'gear_kinematics'


def share_directory() -> Path:
    """Find the share directory of this installation, or the source tree it runs from.

    pip, colcon and Debian put the Python package at <prefix>/lib/python3.x/... and the files at
    <prefix>/share; searching upwards from here finds those of the same installation, also if
    there is no ament index or it names another installation.

    Raises:
        FileNotFoundError: if the package was moved out of its installation.
    """
    for ancestor in Path(__file__).resolve().parents:
        for candidate in (ancestor / 'share' / PACKAGE, ancestor):
            if (candidate / 'package.xml').is_file() and (candidate / 'config').is_dir():
                return candidate
    raise FileNotFoundError(f'the files installed with {PACKAGE} are missing')


def version() -> str:
    """Read the version of the package, which package.xml alone states."""
    manifest = (share_directory() / 'package.xml').read_text('utf-8')
    return str(re.findall(r'<version>(.+)</version>', manifest)[0])
