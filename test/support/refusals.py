# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Files that are refused in one line, which begins with the file and says why."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


@contextmanager
def refused(error: type[Exception], path: Path, *causes: str) -> Iterator[pytest.ExceptionInfo]:
    with pytest.raises(error) as caught:
        yield caught
    text = str(caught.value)
    assert text.startswith(f'{path}: ')
    assert '\n' not in text
    assert not [cause for cause in causes if cause not in text], text
