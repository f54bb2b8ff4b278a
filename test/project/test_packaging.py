# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The package as users get it: sdist and wheel, pip, colcon, and what package.xml says."""

import ast
import email
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import tarfile
import xml.etree.ElementTree as ET
import zipfile
from email.message import Message
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml
from blocked_bags import finished, started

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SHARE = 'share/gear_kinematics'

# Where rosdep calls a Python package other than Python does.
ROSDEP_KEYS = {
    'PIL': 'python3-pil',
    'matplotlib': 'python3-matplotlib',
    'numpy': 'python3-numpy',
    'pandas': 'python3-pandas',
    'rich': 'python3-rich',
    'scipy': 'python3-scipy',
    'tornado': 'python3-tornado',
    'yaml': 'python3-yaml',
}
# Extras, libraries of compressed recordings, and what Python itself has from 3.14 on.
WITHOUT_KEY = {'compression', 'distributed', 'mapbox_earcut', 'mujoco', 'plotly', 'rainflow'}
WITHOUT_KEY |= {'asammdf', 'backports', 'h5py', 'lz4', 'nptdms', 'pyarrow', 'rosbags', 'zstandard'}
PYPI_NAMES = {'PIL': 'pillow', 'yaml': 'pyyaml', 'backports': 'backports.zstd'}


def program(name: str) -> str:
    beside_python = Path(sysconfig.get_path('scripts'), name)
    found = str(beside_python) if beside_python.exists() else shutil.which(name)
    if found is None:
        pytest.skip(f'{name} is not installed')
    return found


def run(*command, cwd: Path, env=None, stderr: str | None = None) -> str:
    done = finished(command, cwd=cwd, env=env, timeout=None)
    assert done.returncode == 0, done.stdout + done.stderr
    assert stderr is None or done.stderr == stderr
    return done.stdout


@pytest.fixture(scope='module')
def tree(tmp_path_factory) -> Path:
    """Return a copy of the sources, since building leaves files behind."""
    copy = tmp_path_factory.mktemp('source') / 'gear_kinematics'
    ignored = shutil.ignore_patterns(
        '.*', '__pycache__', '*.egg-info', 'build', 'dist', 'install', 'log'
    )
    return shutil.copytree(ROOT, copy, ignore=ignored)


@pytest.fixture(scope='module')
def archives(tree, tmp_path_factory) -> Path:
    pytest.importorskip('build')
    folder = tmp_path_factory.mktemp('dist')
    run(sys.executable, '-m', 'build', '--no-isolation', '--outdir', folder, tree, cwd=folder)
    return folder


@pytest.fixture(scope='module')
def wheel(archives) -> Path:
    [path] = archives.glob('*.whl')
    return path


@pytest.fixture(scope='module')
def prefix(wheel, tmp_path_factory) -> Path:
    """Return a virtual environment with the wheel, over the packages of the running one."""
    pytest.importorskip('pip')
    path = tmp_path_factory.mktemp('venv')
    run(sys.executable, '-m', 'venv', '--without-pip', path, cwd=path)
    python = path / 'bin/python'
    [packages] = path.glob('lib/python3.*/site-packages')
    outer = [p for p in sys.path if p.endswith(('site-packages', 'dist-packages'))]
    lines = [f'import site; site.addsitedir({folder!r})\n' for folder in outer]
    (packages / 'outer.pth').write_text(''.join(lines))
    install = [sys.executable, '-m', 'pip', '--python', python, 'install']
    install += ['--no-deps', '--no-index', '--force-reinstall', wheel]
    without_workspace = {k: v for k, v in os.environ.items() if k != 'PYTHONPATH'}
    run(*install, cwd=path, env=without_workspace)
    return path


class Installed(NamedTuple):
    """The package as pip or colcon installs it."""

    prefix: Path
    setup: str
    """What a shell has to do first."""
    programs: Path

    def command(self, name: str, *arguments: object) -> list[str]:
        # exec, so that an interrupt reaches the program and not the shell
        words = ['sh', '-c', f'{self.setup} && exec "$@"', 'sh', self.programs / name, *arguments]
        return [*map(str, words)]


@pytest.fixture(scope='module', params=['pip', 'colcon'])
def installed(request, tree, tmp_path_factory) -> Installed:
    if request.param == 'pip':
        prefix = request.getfixturevalue('prefix')
        return Installed(prefix, 'unset PYTHONPATH', prefix / 'bin')
    path = tmp_path_factory.mktemp('workspace')
    build = [program('colcon'), 'build', '--base-paths', tree]
    # Where it is set, setuptools warns of it.
    environment = {k: v for k, v in os.environ.items() if k != 'PYTHONDONTWRITEBYTECODE'}
    run(*build, '--event-handlers', 'console_direct+', cwd=path, env=environment, stderr='')
    prefix = path / 'install/gear_kinematics'
    setup = f'. {path}/install/setup.sh'
    found = run('sh', '-c', f'{setup} && command -v gearkin', cwd=path)
    assert Path(found).is_relative_to(prefix)
    return Installed(prefix, setup, prefix / 'lib/gear_kinematics')


@pytest.fixture(scope='module')
def manifest() -> ET.Element:
    return ET.parse(ROOT / 'package.xml').getroot()  # noqa: S314, the project's own file


@pytest.fixture(scope='module')
def metadata(wheel) -> Message:
    with zipfile.ZipFile(wheel) as archive:
        [name] = [name for name in archive.namelist() if name.endswith('.dist-info/METADATA')]
        return email.message_from_bytes(archive.read(name))


def shared_files(root: Path) -> set[str]:
    """Return every file that belongs into share/gear_kinematics."""
    folders = {'config': '*', 'launch': '*.launch.py', 'bags': '*', 'policies': '*'}
    folders |= {'meshes': '*', 'urdf': '*'}
    files = {
        path.relative_to(root).as_posix()
        for folder, pattern in folders.items()
        for path in (root / folder).rglob(pattern)
        if path.is_file()
    }
    return files | {'package.xml'}


@cache
def imported_names() -> frozenset[str]:
    """Return the top-level packages that the sources import, in any place."""
    names: set[str] = set()
    folders = ROOT / 'gear_kinematics', ROOT / 'launch'
    for path in (path for folder in folders for path in folder.rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names.add(node.module.split('.')[0])
    return frozenset(names) - set(sys.stdlib_module_names) - {'gear_kinematics'}


def test_wheel_holds_types_and_share(tree, wheel, manifest):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    data = f'gear_kinematics-{manifest.findtext("version")}.data/data'
    assert 'gear_kinematics/py.typed' in names
    assert 'gear_kinematics/kinematics/__init__.py' in names
    pages = [*tree.glob('gear_kinematics/**/*.css'), *tree.glob('gear_kinematics/**/*.js')]
    assert len(pages) >= 5
    assert {path.relative_to(tree).as_posix() for path in pages} <= names
    assert f'{data}/share/ament_index/resource_index/packages/gear_kinematics' in names
    shared = shared_files(tree)
    assert {'config/actuator.yaml', 'launch/gear_state_publisher.launch.py'} <= shared
    assert {'config/view.rviz', 'config/foxglove.json', 'launch/view.launch.py'} <= shared
    assert {'config/simulated_actuator.yaml', 'launch/simulated_actuator.launch.py'} <= shared
    assert {f'{data}/{SHARE}/{name}' for name in shared} <= names
    assert not [name for name in names if name.startswith('test')]
    # pip makes the program there, and would find the one of a ROS workspace in its place.
    assert not [name for name in names if name.startswith(f'{data}/bin/')]


def test_sdist_holds_what_its_tests_need(archives, tree):
    [path] = archives.glob('*.tar.gz')
    with tarfile.open(path) as archive:
        names = {name.partition('/')[2] for name in archive.getnames()}
    assert {'LICENSE', 'Makefile', 'package.xml', 'setup.cfg', 'bin/gearkin'} <= names
    folders = 'benchmark', 'bags', 'config', 'docs', 'examples', 'fuzz', 'requirements', 'test'
    paths = (path for folder in folders for path in (tree / folder).rglob('*') if path.is_file())
    needed = {path.relative_to(tree).as_posix() for path in paths}
    assert not {name for name in needed if '__pycache__' not in name} - names


@pytest.mark.parametrize(
    ('program', 'file'),
    [('gear_state_publisher', 'actuator.yaml'), ('gear_simulator', 'simulated_actuator.yaml')],
)
def test_installed_node_runs(installed, program, file):
    """It is interrupted after its first words, and has a clean end."""
    config = installed.prefix / SHARE / 'config' / file
    command = installed.command(program, '--ros-args', '--params-file', config)
    with started(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        lines = []
        for line in process.stdout:
            lines.append(line)
            if 'ratio -19' in line:
                process.send_signal(signal.SIGINT)
        assert process.wait() == 0, lines
        assert any('ratio -19' in line for line in lines), lines


def test_installed_files_are_there_and_found(installed, tree, tmp_path):
    share = installed.prefix / SHARE
    assert all((share / name).is_file() for name in shared_files(tree))
    robot = ET.fromstring(run(*installed.command('gearkin', 'urdf'), cwd=tmp_path))  # noqa: S314, our own
    names = [mesh.get('filename') for mesh in robot.iter('mesh')]
    assert len(names) == 10
    assert all((share.parent / name.removeprefix('package://')).is_file() for name in names)


@pytest.mark.parametrize('name', ['gearkin', 'gear_state_publisher', 'gear_simulator'])
def test_every_installation_states_the_version_of_the_manifest(installed, manifest, name):
    version = run(*installed.command(name, '--version'), cwd=installed.prefix)
    assert version == f'{name} {manifest.findtext("version")}\n'


def words_of_make(tree: Path, *variables: str, **environment: str) -> list[str]:
    """Run `make demo` where it fails, and give its error messages without those of make."""
    program('make')
    inherited = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(('MAKE', 'PIP_')) and name != 'MFLAGS'
    }
    done = finished(
        ['make', 'demo', *variables],
        cwd=tree,
        env=inherited | {'PIP_CONFIG_FILE': os.devnull} | environment,
    )
    assert done.returncode == 2
    return [line for line in done.stderr.splitlines() if not line.startswith('make')]


def script(path: Path, text: str) -> Path:
    path.write_text(f'#!/bin/sh\n{text}\n')
    path.chmod(0o755)
    return path


def test_make_demo_says_what_to_install_for_a_virtual_environment(tree, tmp_path):
    """Debian and Ubuntu have ensurepip in a package of its own."""
    (tmp_path / 'without').mkdir()
    (tmp_path / 'without/ensurepip.py').write_text('raise ModuleNotFoundError')
    text = f'PYTHONPATH={tmp_path}/without exec {sys.executable} "$@"'
    python = script(tmp_path / 'python3.12', text)
    lines = words_of_make(tree, f'PYTHON={python}', f'VENV={tmp_path}/venv')
    assert lines == ['Python has no ensurepip: apt install python3.12-venv']
    assert not (tmp_path / 'venv').exists()


def test_make_demo_says_why_it_cannot_install(tree, tmp_path):
    pip = pytest.importorskip('pip')
    venv, lock = tmp_path / 'venv', tree / 'requirements/demo.txt'
    # An environment with this pip, as to install another one takes seconds.
    run(sys.executable, '-m', 'venv', '--without-pip', venv, cwd=tmp_path)
    [packages] = venv.glob('lib/python3.*/site-packages')
    (packages / 'pip').symlink_to(Path(pip.__file__).parent)
    script(venv / 'bin/pip', f'exec {venv}/bin/python -m pip "$@"')
    of_make = (tree, f'PYTHON={sys.executable}', f'VENV={venv}')
    nobody = {'PIP_INDEX_URL': 'http://127.0.0.1:9', 'PIP_RETRIES': '1'}
    assert words_of_make(*of_make, **nobody) == [
        f'pip cannot reach the package index: see {venv}/pip.log; is there a network?'
    ]
    script(tmp_path / 'uname', 'echo Linux aarch64')
    path = f'{tmp_path}:{os.environ["PATH"]}'
    assert words_of_make(*of_make, PIP_NO_INDEX='1', PATH=path) == [
        'ROS has no wheels for Linux aarch64: install ROS 2 Jazzy, then colcon build'
    ]
    locked = lock.read_text('utf-8')
    lock.write_text('no-such-package\n')
    try:
        [line] = words_of_make(*of_make, PIP_NO_INDEX='1')
    finally:
        lock.write_text(locked, 'utf-8')
    assert line.startswith(
        'ERROR: Could not find a version that satisfies the requirement no-such'
    )


def test_manifest_agrees_with_metadata(manifest, metadata):
    assert manifest.findtext('name') == metadata['Name']
    assert manifest.findtext('version') == metadata['Version']
    assert manifest.findtext('license') == metadata['License']
    assert manifest.findtext('description') == metadata['Summary']
    assert manifest.findtext('maintainer') == metadata['Maintainer']
    assert manifest.find('maintainer').get('email') == metadata['Maintainer-email']


@pytest.mark.filterwarnings('ignore::DeprecationWarning')  # in those tools
def test_changelog_is_one_to_the_release_tools(manifest):
    """REP 132; they put the next version in the place of Forthcoming."""
    catkin_changelog = pytest.importorskip('catkin_pkg.changelog')
    version, text = manifest.findtext('version'), (ROOT / 'CHANGELOG.rst').read_text('utf-8')
    heading = '999.0.0 (2026-01-01)'
    text = text.replace(f'Forthcoming\n{"-" * 11}\n', f'{heading}\n{"-" * len(heading)}\n')
    found = catkin_changelog.Changelog(manifest.findtext('name'))
    catkin_changelog.populate_changelog_from_rst(found, text)
    versions = [name for name, _, content in found.foreach_version() if content]
    assert version in versions
    assert len(versions) == text.count('\n---'), 'a heading is no version and date'


def test_build_farm_documents_the_package(manifest):
    path = ROOT / manifest.findtext('export/rosdoc2')
    kind, document = yaml.safe_load_all(path.read_text('utf-8'))
    assert kind == {'type': 'rosdoc2 config', 'version': 1}
    assert (ROOT / document['settings']['python_source'] / '__init__.py').is_file()


def test_manifest_names_everything_that_is_imported(manifest):
    declared = {element.text for element in manifest.iterfind('exec_depend')}
    imported = imported_names()
    assert {'launch', 'numpy'} <= imported
    assert {ROSDEP_KEYS.get(name, name) for name in imported - WITHOUT_KEY} <= declared


def test_requirements_name_everything_that_ros_does_not_bring(metadata):
    required = {
        re.split('[^a-z0-9.-]', line.lower())[0] for line in metadata.get_all('Requires-Dist')
    }
    imported = {name for name in imported_names() if name in ROSDEP_KEYS}
    assert {PYPI_NAMES.get(name, name) for name in imported} <= required
