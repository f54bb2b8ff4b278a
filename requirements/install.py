# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Install pinned requirements with pip, showing how far it is where stderr is a terminal.

    python requirements/install.py requirements/demo.txt pip.log

pip shows a bar for each file, but not how many packages are left. Its exit code is that of this
program, and what it prints on stderr goes to the log.
"""

import re
import subprocess
import sys
import sysconfig
import threading
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

_PERIOD = 0.2  # s
_WIDTH = 30  # characters


def main(requirements: str, log: str) -> int:
    """Install them; returns the exit code of pip."""
    total = len(re.findall(r'^[\w.-]+==', Path(requirements).read_text('utf-8'), re.MULTILINE))
    before = _installed()
    seen: Counter[str] = Counter()
    pip = ('-m', 'pip', 'install', '--disable-pip-version-check', '--progress-bar', 'off')
    # The pins are complete. Resolved anew, `name[extra]` would be the newest, which has no hash.
    options = ('--no-compile', '--no-deps', '--require-hashes', '-r', requirements)
    with (
        Path(log).open('wb') as errors,
        subprocess.Popen(  # noqa: S603, pip
            [sys.executable, *pip, *options], stdout=subprocess.PIPE, stderr=errors, text=True
        ) as process,
    ):
        reader = threading.Thread(target=_count, args=(process.stdout, seen), daemon=True)
        reader.start()
        while reader.is_alive():
            reader.join(_PERIOD)
            # Markers exclude some packages on this platform.
            _show(seen['Collecting'], _installed() - before, max(1, total - seen['Ignoring']))
    if sys.stderr.isatty():
        print('\r\x1b[2K', end='', file=sys.stderr)
    return process.returncode


def _count(lines: Iterable[str], seen: Counter[str]) -> None:
    """Count the lines of pip by their first words."""
    for line in lines:
        seen[line.partition(' ')[0]] += 1


def _installed() -> int:
    return sum(1 for _ in Path(sysconfig.get_path('purelib')).glob('*.dist-info'))


def _show(collected: int, installed: int, total: int) -> None:
    if not sys.stderr.isatty():
        return
    done = min(collected, total) + min(installed, total)
    bar = '━' * round(_WIDTH * done / (2 * total))
    text = f'{installed} of {total} packages installed'
    if not installed:
        text = f'{collected} of {total} packages downloaded'
    print(f'\r\x1b[2K{bar:─<{_WIDTH}} {text}', end='', file=sys.stderr, flush=True)


if __name__ == '__main__':
    try:
        sys.exit(main(*sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
