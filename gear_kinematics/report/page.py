"""The shell of pages, which load nothing from anywhere."""

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
    return _shell(title, body, sources, _policy(sources))


def live_page(title: str, body: str, *, style: str, script: str, server: str) -> str:
    """Write a page that talks to the server it comes from, and to nothing else.

    Args:
        title: as text.
        body: as HTML.
        style: rules beside those of all pages.
        script: source of the only script.
        server: its address for WebSockets: `ws://host:port`.
    """
    policy = _policy([script], server)
    no_icon = '<link rel="icon" href="data:,">\n'  # or the browser would ask for one
    return _shell(title, body, [script], policy, style, no_icon)


def _shell(
    title: str, body: str, scripts: Sequence[str], policy: str, style: str = '', head: str = ''
) -> str:
    return (
        f'<!DOCTYPE html>\n<!-- {MARK} -->\n'
        '<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{escape(title)}</title>\n'
        f'<style>\n{_resource("page.css")}{style}</style>\n{head}</head>\n<body>\n{body}'
        + ''.join(f'<script>{script}</script>\n' for script in scripts)
        + '</body>\n</html>\n'
    )


def _policy(scripts: Sequence[str], server: str = '') -> str:
    """Let the browser run these scripts alone, and load nothing from anywhere else.

    Args:
        scripts: their sources.
        server: what they may connect to.
    """
    none = ["'none'"]
    hashes = [
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    ]
    return (
        f"default-src 'none'; script-src {' '.join(hashes or none)}; "
        "style-src 'unsafe-inline'; img-src data: blob:"
        + (f'; connect-src {server}' if server else '')
    )


def _plotly_js() -> str:
    # Large, and of use here only.
    from plotly.offline import get_plotlyjs  # noqa: PLC0415, an extra

    return str(get_plotlyjs())


def _resource(name: str) -> str:
    return files('gear_kinematics.report').joinpath(name).read_text('utf-8')
