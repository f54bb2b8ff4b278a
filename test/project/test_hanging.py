"""A run of the tests that hangs comes to an end, and says where it was."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
HANG = """
import ctypes
import pytest

def hang():
    # A second time the lock is waited for, in a C call that keeps the GIL.
    library, mutex = ctypes.PyDLL(None), ctypes.create_string_buffer(256)
    library.pthread_mutex_init(mutex, None)
    for _ in range(2):
        library.pthread_mutex_lock(mutex)
"""
TESTS = {
    'test_call': """
def test_hangs():
    hang()
""",
    'test_teardown': """
@pytest.fixture
def hanging():
    yield
    hang()

def test_fails_and_hangs(hanging):
    assert False
""",
    'test_waiting': """
def test_has_to_wait():
    pass
""",
}


def run(*command, **options) -> tuple[int, str]:
    """Give the exit code, and what it and all that it started have written, to their ends."""
    done = subprocess.run(
        [str(part) for part in command],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
        text=True,
        **options,
    )
    return done.returncode, done.stdout


def test_hung_tests_are_named_with_their_stacks_and_end_the_run(tmp_path):
    shutil.copy(ROOT / 'test/conftest.py', tmp_path)
    for name, text in TESTS.items():
        (tmp_path / f'{name}.py').write_text(HANG + text)
    [options] = re.findall(r'-m pytest (.*)', (ROOT / 'Makefile').read_text('utf-8'))
    limits = ['-o', 'timeout=1', '-o', 'watchdog_timeout=2']
    # Without a cache, as on a disk that is read-only, the run ends in the same way.
    command = [sys.executable, '-m', 'pytest', *options.split(), *limits, '-p', 'no:cacheprovider']
    code, output = run(
        *command, '-c', ROOT / 'pyproject.toml', '--rootdir', tmp_path, '.', cwd=tmp_path
    )
    assert code == 1, output
    for name, test, function in (
        ('test_call', 'test_hangs', 'test_hangs'),
        ('test_teardown', 'test_fails_and_hangs', 'hanging'),
    ):
        assert re.search(f"worker 'gw.' crashed while running '{name}.py::{test}'", output), output
        frame = f'  File "{re.escape(str(tmp_path))}/{name}.py", line .* in '
        assert re.search(f'{frame}hang\n{frame}{function}\n', output), output


def test_ci_ends_a_run_that_hangs_and_all_that_it_started(tmp_path):
    if not (ROOT / '.ci').exists():
        pytest.skip('a source distribution has no .ci')
    shutil.copytree(ROOT / '.ci', tmp_path / '.ci')
    installer = tmp_path / 'apt-get'
    installer.write_text('#!/bin/sh\nexit 1\n')
    installer.chmod(0o755)
    (tmp_path / 'test_import.py').write_text(f'{HANG}\nhang()\n')
    (tmp_path / 'Makefile').write_text(
        'test:\n'
        '\t(trap "" ABRT; exec sleep 1000) &\n'
        f'\t{sys.executable} -m pytest --rootdir . test_import.py\n'
    )
    environment = os.environ | {'LIMIT': '10', 'PATH': f'{tmp_path}:{os.environ["PATH"]}'}
    code, output = run(tmp_path / '.ci/run', env=environment)
    assert code == 124, output
    assert re.search(r'  File ".*/test_import.py", line .* in hang\n', output), output
