# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A run of the tests that hangs comes to an end, and says where it was."""

import os
import re
import shutil
import sys
from pathlib import Path

import pytest
from blocked_bags import finished

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
HANG = """
import ctypes

def hang():
    # A second time the lock is waited for, in a C call that keeps the GIL.
    library, mutex = ctypes.PyDLL(None), ctypes.create_string_buffer(256)
    library.pthread_mutex_init(mutex, None)
    for _ in range(2):
        library.pthread_mutex_lock(mutex)
"""


def test_ci_ends_a_run_that_hangs_and_all_that_it_started(tmp_path):
    if not (ROOT / '.ci').exists():
        pytest.skip('a source distribution has no .ci')
    shutil.copytree(ROOT / '.ci', tmp_path / '.ci')
    # Nothing is installed, and no environment is made for other tests, which takes long.
    for name in ('apt-get', '.ci/newer_python', '.ci/kilted', '.ci/install'):
        (tmp_path / name).write_text('#!/bin/sh\n')
        (tmp_path / name).chmod(0o755)
    (tmp_path / 'test_import.py').write_text(f'{HANG}\nhang()\n')
    (tmp_path / 'Makefile').write_text(
        'test:\n'
        '\t(trap "" ABRT; exec sleep 1000) &\n'
        # Without plugins it starts in a fraction of the limit, on a busy machine as well.
        '\tPYTEST_DISABLE_PLUGIN_AUTOLOAD=1 '
        f'{sys.executable} -m pytest --rootdir . test_import.py\n'
    )
    environment = os.environ | {'LIMIT': '15', 'PATH': f'{tmp_path}:{os.environ["PATH"]}'}
    done = finished([tmp_path / '.ci/run'], env=environment, timeout=240.0)
    output = done.stdout + done.stderr
    assert done.returncode == 124, output
    assert re.search(r'  File ".*/test_import.py", line .* in hang\n', output), output
