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
import threading
import xml.etree.ElementTree as ET
import zipfile
from email.message import Message
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SHARE = 'share/gear_kinematics'
DEADLINE = 60.0

# Where rosdep calls a Python package other than Python does.
ROSDEP_KEYS = {
    'PIL': 'python3-pil',
    'backports': 'python3-rosbags-pip',  # rosbags brings it, and lz4
    'lz4': 'python3-rosbags-pip',
    'matplotlib': 'python3-matplotlib',
    'numpy': 'python3-numpy',
    'rich': 'python3-rich',
    'rosbags': 'python3-rosbags-pip',
    'scipy': 'python3-scipy',
    'tornado': 'python3-tornado',
    'yaml': 'python3-yaml',
}
# Extras, which rosdep does not know, and what Python itself has from 3.14 on.
WITHOUT_KEY = {'compression', 'distributed', 'imageio_ffmpeg', 'mapbox_earcut', 'plotly', 'shtab'}
PYPI_NAMES = {'PIL': 'pillow', 'yaml': 'pyyaml', 'backports': 'backports.zstd'}


def program(name: str) -> str:
    beside_python = Path(sysconfig.get_path('scripts'), name)
    found = str(beside_python) if beside_python.exists() else shutil.which(name)
    if found is None:
        pytest.skip(f'{name} is not installed')
    return found


def run(*command, cwd: Path, env=None, stderr: str | None = None) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert stderr is None or done.stderr == stderr
    return done.stdout


def isolated() -> dict[str, str]:
    """Return the environment without the search path that a sourced workspace sets."""
    return {name: value for name, value in os.environ.items() if name != 'PYTHONPATH'}


def assert_starts_and_stops(*command, env=None) -> None:
    """Start a node, wait for its first words, interrupt it, and expect a clean end."""
    process = subprocess.Popen(
        [str(part) for part in command],
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    watchdog = threading.Timer(DEADLINE, process.kill)
    watchdog.start()
    try:
        lines = []
        for line in process.stdout:
            lines.append(line)
            if 'gear ratio' in line:
                process.send_signal(signal.SIGINT)
        output = ''.join(lines)
        assert process.wait() == 0, output
        assert 'gear ratio' in output
    finally:
        watchdog.cancel()
        process.kill()
        process.wait()
        process.stdout.close()


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
    run(*install, cwd=path, env=isolated())
    return path


@pytest.fixture(scope='module')
def workspace(tree, tmp_path_factory) -> Path:
    colcon = program('colcon')
    path = tmp_path_factory.mktemp('workspace')
    command = [colcon, 'build', '--base-paths', tree, '--event-handlers', 'console_direct+']
    # Where it is set, setuptools warns of it.
    environment = {k: v for k, v in os.environ.items() if k != 'PYTHONDONTWRITEBYTECODE'}
    run(*command, cwd=path, env=environment, stderr='')
    return path


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
    folders['meshes'] = '*'
    files = {
        path.relative_to(root).as_posix()
        for folder, pattern in folders.items()
        for path in (root / folder).rglob(pattern)
        if path.is_file()
    }
    return files | {'package.xml'}


def imported_names(*folders: str) -> set[str]:
    """Return the top-level packages that the sources of some folders import, in any place."""
    names: set[str] = set()
    for path in (path for folder in folders for path in (ROOT / folder).rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names.add(node.module.split('.')[0])
    return names - set(sys.stdlib_module_names) - {'gear_kinematics'}


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


def test_pip_installs_programs_and_configuration(prefix):
    assert (prefix / 'bin/gear_state_publisher').is_file()
    assert (prefix / 'bin/gearkin').is_file()
    assert (prefix / SHARE / 'config/actuator.yaml').is_file()
    code = 'import gear_kinematics; print(gear_kinematics.__file__)'
    location = run(prefix / 'bin/python', '-c', code, cwd=prefix, env=isolated())
    assert Path(location.strip()).is_relative_to(prefix)


def test_pip_installed_node_runs(prefix):
    config = prefix / SHARE / 'config/actuator.yaml'
    node = prefix / 'bin/gear_state_publisher'
    assert_starts_and_stops(node, '--ros-args', '--params-file', config, env=isolated())


@pytest.fixture(scope='module')
def environment_of_make(tmp_path_factory) -> Path:
    """Return where `make` builds the virtual environment, so that it has to only once."""
    return tmp_path_factory.mktemp('make') / 'venv'


def words_of_make(tree: Path, *variables: str, **environment: str) -> list[str]:
    """Run `make demo` where it fails, and give its error messages without those of make."""
    program('make')
    inherited = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(('MAKE', 'PIP_')) and name != 'MFLAGS'
    }
    done = subprocess.run(
        ['make', 'demo', *variables],
        cwd=tree,
        env=inherited | {'PIP_CONFIG_FILE': os.devnull} | environment,
        capture_output=True,
        text=True,
        check=False,
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


def test_make_demo_says_that_it_needs_a_network(tree, environment_of_make):
    lines = words_of_make(
        tree,
        f'PYTHON={sys.executable}',
        f'VENV={environment_of_make}',
        PIP_INDEX_URL='http://127.0.0.1:9',  # nobody listens
        PIP_RETRIES='1',
    )
    log = f'{environment_of_make}/pip.log'
    assert lines == [f'pip cannot reach the package index: see {log}; is there a network?']


def test_make_demo_says_which_requirement_cannot_be_installed(tree, environment_of_make):
    lock = tree / 'requirements/demo.txt'
    locked = lock.read_text('utf-8')
    lock.write_text('no-such-package\n')
    try:
        (line,) = words_of_make(
            tree, f'PYTHON={sys.executable}', f'VENV={environment_of_make}', PIP_NO_INDEX='1'
        )
    finally:
        lock.write_text(locked, 'utf-8')
    assert line.startswith(
        'ERROR: Could not find a version that satisfies the requirement no-such'
    )


def test_make_demo_says_where_ros_has_no_wheels(tree, environment_of_make, tmp_path):
    script(tmp_path / 'uname', 'echo Linux aarch64')
    lines = words_of_make(
        tree,
        f'PYTHON={sys.executable}',
        f'VENV={environment_of_make}',
        PIP_NO_INDEX='1',  # no wheel of any kind
        PATH=f'{tmp_path}:{os.environ["PATH"]}',
    )
    assert lines == ['ROS has no wheels for Linux aarch64: install ROS 2 Jazzy, then colcon build']


def test_colcon_installs_share(tree, workspace):
    share = workspace / 'install/gear_kinematics' / SHARE
    assert all((share / name).is_file() for name in shared_files(tree))


def test_colcon_installed_node_runs(workspace):
    install = workspace / 'install'
    node = install / 'gear_kinematics/lib/gear_kinematics/gear_state_publisher'
    config = install / 'gear_kinematics' / SHARE / 'config/actuator.yaml'
    # exec, so that the interrupt reaches the node and not the shell
    source_and_exec = f'. {install}/setup.sh && exec "$@"'
    command = ['sh', '-c', source_and_exec, 'sh', node]
    assert_starts_and_stops(*command, '--ros-args', '--params-file', config)


def test_gearkin_is_on_the_path_of_a_sourced_workspace(workspace, tmp_path):
    source_and_run = f'. {workspace}/install/setup.sh && command -v gearkin && gearkin urdf'
    found, _, urdf = run('sh', '-c', source_and_run, cwd=tmp_path).partition('\n')
    assert Path(found).is_relative_to(workspace)
    assert_meshes_are_installed(urdf, workspace / 'install/gear_kinematics/share')


def test_pip_installs_the_meshes_of_the_urdf(prefix):
    urdf = run(prefix / 'bin/gearkin', 'urdf', cwd=prefix, env=isolated())
    assert_meshes_are_installed(urdf, prefix / 'share')


def assert_meshes_are_installed(urdf: str, share: Path) -> None:
    robot = ET.fromstring(urdf)  # noqa: S314, the project's own words
    assert robot.tag == 'robot'
    names = [mesh.get('filename') for mesh in robot.iter('mesh')]
    assert len(names) == 10
    assert all((share / name.removeprefix('package://')).is_file() for name in names)


def test_every_installation_states_the_version_of_the_manifest(manifest, prefix, workspace):
    version = manifest.findtext('version')
    colcon = workspace / 'install/gear_kinematics/lib/gear_kinematics'
    sourced = ['sh', '-c', f'. {workspace}/install/setup.sh && exec "$@"', 'sh']
    for program in ('gearkin', 'gear_state_publisher'):
        for command in ([prefix / 'bin' / program], [*sourced, colcon / program]):
            output = run(*command, '--version', cwd=prefix, env=isolated())
            assert output == f'{program} {version}\n'
    assert run(sys.executable, '-m', 'gear_kinematics', '--version', cwd=ROOT) == (
        f'gearkin {version}\n'
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


def test_manifest_names_everything_that_is_imported(manifest):
    declared = {element.text for element in manifest.iterfind('exec_depend')}
    imported = imported_names('gear_kinematics', 'launch')
    assert {'launch', 'numpy'} <= imported
    assert {ROSDEP_KEYS.get(name, name) for name in imported - WITHOUT_KEY} <= declared


def test_requirements_name_everything_that_ros_does_not_bring(metadata):
    required = {
        re.split('[^a-z0-9.-]', line.lower())[0] for line in metadata.get_all('Requires-Dist')
    }
    imported = {name for name in imported_names('gear_kinematics') if name in ROSDEP_KEYS}
    assert {PYPI_NAMES.get(name, name) for name in imported} <= required
