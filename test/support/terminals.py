# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Pseudo-terminals, on which programs print as to a user."""

import os
import pty
import threading
from contextlib import suppress
from typing import Self

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
        self._thread = threading.Thread(target=self._read)
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
        self._thread.join()
        with suppress(OSError):
            os.close(self._own)
        return self._shown.decode()
