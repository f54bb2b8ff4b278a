# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Pseudo-terminals, on which programs print as to a user."""

import os
import pty
import re
import signal
import subprocess
import sys
import termios
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Self

from blocked_bags import DEADLINE, wait_until

ENVIRONMENT = {
    **{name: value for name, value in os.environ.items() if name not in {'NO_COLOR', 'CI'}},
    'TERM': 'xterm-256color',
    'COLUMNS': '120',
}


class Terminal:
    """A pseudo-terminal that keeps what is shown on it; a context manager."""

    def __enter__(self) -> Self:
        """Open it."""
        self._own, self.other = pty.openpty()
        self._shown = b''
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self.text()

    def _read(self) -> None:
        with suppress(OSError):  # how Linux tells that the other end is closed
            while piece := os.read(self._own, 4096):
                self._shown += piece

    def shown(self) -> str:
        """Give what was shown so far."""
        return self._shown.decode(errors='replace')

    def text(self) -> str:
        """Wait until nobody writes any more, and give what was shown."""
        with suppress(OSError):
            os.close(self.other)
        self._thread.join(DEADLINE)
        assert not self._thread.is_alive(), f'somebody still writes: {self.shown()}'
        with suppress(OSError):
            os.close(self._own)
        return self._shown.decode()


class Person(Terminal):
    """A program in a terminal, and a person in front of it."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        """Prepare gearkin in a folder."""
        command = [sys.executable, '-P', '-m', 'gear_kinematics', *arguments]
        self._command, self._folder, self._seen = command, folder, 0

    def __enter__(self) -> Self:
        """Start it."""
        super().__enter__()
        self._before = termios.tcgetattr(self.other)
        streams = dict.fromkeys(('stdin', 'stdout', 'stderr'), self.other)
        self._process = subprocess.Popen(
            self._command, cwd=self._folder, env=ENVIRONMENT, **streams
        )
        return self

    def __exit__(self, kind, *_) -> None:
        if kind:
            self._process.kill()
            print(self.shown())  # which pytest tells of a test that fails
        try:
            self._process.wait(DEADLINE)
        finally:
            self._process.kill()
        super().__exit__()

    def wait_for(self, pattern: str, keys: str = '') -> str:
        """Wait until something new is shown, and give what matches.

        Keys are pressed until then, every few seconds: what they ask for can be refused.
        """
        due = time.monotonic()

        def found() -> re.Match | None:
            nonlocal due
            if keys and time.monotonic() >= due:
                self.type(keys)
                due += 3.0
            plain = re.sub(r'\x1b\[[\d;?]*[A-Za-z]', '', self.shown())
            return re.compile(pattern).search(plain, self._seen)

        match = wait_until(found, pattern)
        self._seen = match.end()
        return match[0]

    def type(self, keys: str) -> None:
        """Press keys."""
        os.write(self._own, keys.encode())

    def interrupt(self) -> None:
        """Press Ctrl-C."""
        self._process.send_signal(signal.SIGINT)

    def end(self) -> int:
        """Wait for the end, and give the exit code."""
        code = self._process.wait(DEADLINE)
        assert termios.tcgetattr(self.other) == self._before
        return code
