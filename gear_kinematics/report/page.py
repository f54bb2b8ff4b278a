# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The frame of self-contained pages, which load nothing from anywhere."""

import base64
import hashlib
from collections.abc import Sequence
from html import escape
from importlib.resources import files

from gear_kinematics.report.mark import MARK

_NONE = "'none'"


def page(
    title: str, body: str, scripts: Sequence[str] = (), *, style: str = '', server: str = ''
) -> str:
    """Write a self-contained page with a title as text and a body as HTML.

    The browser runs only the given scripts, and connects only to the `server` of WebSockets,
    `ws://host:port`, if any. `style` adds to the rules of all pages.
    """
    hashes = ' '.join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    policy = (
        f"default-src 'none'; script-src {hashes or _NONE}; "
        "style-src 'unsafe-inline'; img-src data: blob:"
        + (f'; connect-src {server}' if server else '')
    )
    # A browser would ask a server for an icon.
    no_icon = '<link rel="icon" href="data:,">\n' if server else ''
    return (
        f'<!DOCTYPE html>\n<!-- {MARK} -->\n'
        '<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{escape(title)}</title>\n'
        f'<style>\n{resource("page.css")}{style}</style>\n{no_icon}</head>\n<body>\n{body}'
        + ''.join(f'<script>{script}</script>\n' for script in scripts)
        + '</body>\n</html>\n'
    )


def resource(name: str) -> str:
    """Read a file in the folder of this module."""
    return files('gear_kinematics.report').joinpath(name).read_text('utf-8')
