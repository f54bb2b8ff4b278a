# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What `make` shows while it builds its virtual environment."""

import importlib.metadata
import re
import sys
from pathlib import Path

import pytest
from blocked_bags import finished
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from terminals import ENVIRONMENT, Terminal

REQUIREMENTS = Path(__file__).resolve().parents[2] / 'requirements'
PIP = """
import sys
print("Ignoring three: markers 'python_version < \\\\'3\\\\'' don't match your environment")
for name in ('one', 'two', 'four'):
    print(f'Collecting {name}==1')
    print('  Downloading it')
print(*sys.argv[1:], file=sys.stderr)
sys.exit(7)
"""


def test_a_terminal_shows_how_many_packages_there_are_and_the_log_what_pip_said(tmp_path):
    (tmp_path / 'pip').mkdir()
    (tmp_path / 'pip' / '__init__.py').touch()
    (tmp_path / 'pip' / '__main__.py').write_text(PIP)
    pins = '\n'.join(f'{name}==1 \\\n    --hash=sha256:0' for name in ('one', 'two', 'four'))
    lock, log = tmp_path / 'demo.txt', tmp_path / 'pip.log'
    lock.write_text(f"{pins}\nthree==1 ; python_version < '3' \\\n    --hash=sha256:0\n")
    command = [sys.executable, REQUIREMENTS / 'install.py', lock, log]
    environment = ENVIRONMENT | {'PYTHONPATH': str(tmp_path)}
    with Terminal() as terminal:
        assert finished(command, env=environment, stderr=terminal.other).returncode == 7
        shown = terminal.text()
    assert '3 of 3 packages downloaded' in shown
    assert shown.endswith('\r\x1b[2K')

    done = finished(command, env=environment)
    assert (done.returncode, done.stdout, done.stderr) == (7, '', '')
    options = log.read_text().split()
    assert options[0] == 'install'
    assert {'--require-hashes', '--no-compile', '--no-deps', '-r', str(lock)} <= set(options)


def pins(lock: str) -> dict[str, str]:
    """Return the version of each package that a lock file installs on this Python."""
    lines = re.findall(r'^[\w.-]+==[^\\\n]+', (REQUIREMENTS / lock).read_text(), re.MULTILINE)
    pinned = [Requirement(line) for line in lines]
    return {
        canonicalize_name(pin.name): next(iter(pin.specifier)).version
        for pin in pinned
        if pin.marker is None or pin.marker.evaluate()
    }


def wanted(source: str) -> list[Requirement]:
    """Return what a file of direct requirements asks for, and those that it includes."""
    found = []
    for line in (REQUIREMENTS / source).read_text().splitlines():
        if line.startswith('-r '):
            found += wanted(line.removeprefix('-r '))
        elif line and not line.startswith('#'):
            found.append(Requirement(line))
    return found


@pytest.mark.parametrize('name', ['demo', 'test'])
def test_a_lock_meets_every_requirement_of_its_packages_and_extras(name):
    """pip installs the pins without resolving them, so that nothing else may be missing."""
    versions = pins(f'{name}.txt')
    waiting, seen = wanted(f'{name}.in'), set()
    while waiting:
        requirement = waiting.pop()
        package = canonicalize_name(requirement.name)
        assert package in versions, f'{requirement} is not locked'
        assert requirement.specifier.contains(versions[package], prereleases=True), requirement
        for extra in {'', *requirement.extras} - {e for p, e in seen if p == package}:
            seen.add((package, extra))
            for text in importlib.metadata.requires(package) or ():
                needed = Requirement(text)
                if needed.marker is None or needed.marker.evaluate({'extra': extra}):
                    waiting.append(needed)
    assert {package for package, _ in seen} == set(versions)


@pytest.mark.parametrize('extra', ['ros', 'html', 'plot', 'measure'])
def test_the_environment_of_the_demo_runs_the_commands_of_the_readme(extra):
    needed = map(Requirement, importlib.metadata.requires('gear_kinematics'))
    packages = {
        canonicalize_name(requirement.name)
        for requirement in needed
        if requirement.marker and requirement.marker.evaluate({'extra': extra})
    }
    assert packages <= pins('demo.txt').keys()
