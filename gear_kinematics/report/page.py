"""The shell of a page that needs neither network nor server."""

import base64
import hashlib
from collections.abc import Sequence
from html import escape
from importlib.resources import files

from gear_kinematics.report.mark import MARK


def page(title: str, body: str, *, scripts: Sequence[str] = ()) -> str:
    """Write a page that holds all it needs, with plotly.js where there are scripts.

    Args:
        title: as text.
        body: as HTML.
        scripts: their names beside this module, `page.js` where there are figures.

    Raises:
        ModuleNotFoundError: if there are scripts, and plotly is not installed.
    """
    sources = [_plotly_js(), *map(_resource, scripts)] if scripts else []
    return (
        f'<!DOCTYPE html>\n<!-- {MARK} -->\n'
        '<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(sources)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{escape(title)}</title>\n'
        f'<style>\n{_resource("page.css")}</style>\n</head>\n<body>\n{body}'
        + ''.join(f'<script>{script}</script>\n' for script in sources)
        + '</body>\n</html>\n'
    )


def _policy(scripts: Sequence[str]) -> str:
    """Let the browser run these scripts alone, and load nothing from anywhere."""
    none = ["'none'"]
    hashes = [
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    ]
    return (
        f"default-src 'none'; script-src {' '.join(hashes or none)}; "
        "style-src 'unsafe-inline'; img-src data: blob:"
    )


def _plotly_js() -> str:
    # Large, and of use here only.
    from plotly.offline import get_plotlyjs  # noqa: PLC0415, an extra

    return str(get_plotlyjs())


def _resource(name: str) -> str:
    return files('gear_kinematics.report').joinpath(name).read_text('utf-8')
