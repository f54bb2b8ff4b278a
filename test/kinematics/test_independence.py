"""What may import what: the core stands alone, and imports in the package point one way."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / 'gear_kinematics'
ROS = ('ament_index_python', 'builtin_interfaces', 'launch', 'launch_ros', 'rclpy', 'rosidl')

CORE_ALONE = """
import sys

ALLOWED = {*sys.stdlib_module_names, 'numpy', 'gear_kinematics', 'coverage'}


class Nothing_else:
    def find_spec(self, name, path=None, target=None):
        if name.partition('.')[0] not in ALLOWED:
            raise ImportError(f'{name} is blocked')


sys.meta_path.insert(0, Nothing_else())
for name in ('rclpy', 'sensor_msgs', 'std_msgs.msg', 'rosbags', 'rich', 'yaml'):
    try:
        __import__(name)
    except ImportError as error:
        assert 'is blocked' in str(error)
    else:
        raise SystemExit(f'{name} was not blocked')

import importlib
import pkgutil

from gear_kinematics import kinematics

names = [module.name for module in pkgutil.iter_modules(kinematics.__path__)]
for name in names:
    importlib.import_module(f'gear_kinematics.kinematics.{name}')
mechanism = kinematics.Mechanism(80, 76, 0.0011, (kinematics.Branch('a'),))
print(*names, kinematics.solve(mechanism, 1.9).output_angle)
"""


def imported_modules(source: str, package: str) -> set[str]:
    """Return the full names of all modules that a source imports anywhere in it.

    `package` is what its relative imports start from; `from a import b` gives a and a.b, of
    which b may be a module.
    """
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ''
            if node.level:
                above = package.split('.')[: 1 - node.level or None]
                base = '.'.join([*above, *filter(None, [node.module])])
            names |= {base, *(f'{base}.{alias.name}' for alias in node.names)}
    return names


def within(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f'{package}.') for package in packages)


def is_ros(name: str) -> bool:
    top = name.partition('.')[0]
    return top in ROS or top.endswith(('_msgs', '_srvs', '_interfaces')) or top.startswith('rcl')


def imports_of_package() -> dict[str, set[str]]:
    """Return for each source, by its path in the package, what it imports."""
    imports = {}
    for path in sorted(PACKAGE.rglob('*.py')):
        package = '.'.join(path.parent.relative_to(ROOT).parts)
        source = path.read_text(encoding='utf-8')
        imports[path.relative_to(PACKAGE).as_posix()] = imported_modules(source, package)
    return imports


@pytest.fixture(scope='module')
def imports() -> dict[str, set[str]]:
    return imports_of_package()


def test_core_runs_where_nothing_but_numpy_is_installed():
    done = subprocess.run(
        [sys.executable, '-c', CORE_ALONE], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    *names, output_angle = done.stdout.split()
    assert set(names) >= {'mechanism', 'motion', 'matrix_method', 'loop_closure', 'vernier'}
    assert float(output_angle) == pytest.approx(-0.1, rel=1e-15)


def test_core_imports_numpy_the_standard_library_and_itself(imports):
    core = {path: names for path, names in imports.items() if path.startswith('kinematics/')}
    assert len(core) >= 8
    allowed = (*sys.stdlib_module_names, 'numpy', 'gear_kinematics.kinematics')
    for path, names in core.items():
        assert not {name for name in names if not within(name, *allowed)}, path


def test_matrix_method_takes_no_formula_from_the_closed_form(imports):
    taken = {
        name
        for name in imports['kinematics/matrix_method.py'] | imports['kinematics/transforms.py']
        if within(name, 'gear_kinematics.kinematics.motion')
    }
    motion = 'gear_kinematics.kinematics.motion'
    assert taken <= {motion, f'{motion}.MotionState', f'{motion}.motion_state'}


def test_closed_form_takes_nothing_from_the_matrix_method(imports):
    modules = [f'gear_kinematics.kinematics.{name}' for name in ('matrix_method', 'transforms')]
    for path in ('motion', 'rotor_turns', 'mechanism'):
        taken = imports[f'kinematics/{path}.py']
        assert not {name for name in taken if within(name, *modules)}


def test_rclpy_is_imported_where_something_runs_in_ros(imports):
    users = {path for path, names in imports.items() if any(within(n, 'rclpy') for n in names)}
    ros = {'node.py', 'graph.py', 'leaving.py', 'markers.py', 'live_node.py', 'replay.py'}
    assert users <= ros


def test_rosbags_is_imported_where_bags_are_read(imports):
    users = {path for path, names in imports.items() if any(within(n, 'rosbags') for n in names)}
    assert users
    assert all(path.startswith('bag/') for path in users)


def test_matplotlib_is_imported_where_plots_are_made(imports):
    users = {
        path for path, names in imports.items() if any(within(n, 'matplotlib') for n in names)
    }
    assert users
    assert all(path.startswith('plotting/') for path in users)


def test_imports_within_bag_point_one_way(imports):
    layers = (
        ('errors', 'limits', 'ros1_types'),
        ('compression', 'topics'),
        ('storage', 'contents'),
        ('mcap', 'sqlite', 'ros1'),
        ('opening', 'storage_writers'),
        ('reading',),
        ('writing',),
        ('__init__',),
    )
    files = {f'bag/{name}.py' for layer in layers for name in layer}
    assert files == {path for path in imports if path.startswith('bag/')}
    below = []
    for layer in layers:
        for path in (f'bag/{name}.py' for name in layer):
            taken = {name for name in imports[path] if within(name, 'gear_kinematics')}
            assert all(within(name, *below) for name in taken), path
        below += [f'gear_kinematics.bag.{name}' for name in layer]


@pytest.mark.parametrize('path', ['messages.py', 'parameters.py', '__init__.py'])
def test_wire_format_and_parameters_are_free_of_ros(imports, path):
    assert not {name for name in imports[path] if is_ros(name)}


def test_nothing_below_imports_the_programs(imports):
    programs = [f'gear_kinematics.{name}' for name in ('programs', 'node', 'cli', 'commands')]
    tops = ('programs.py', 'node.py', 'cli.py', 'live_node.py')
    for path, names in imports.items():
        if path not in tops and not path.startswith('commands/'):
            assert not {name for name in names if within(name, *programs)}, path


def test_commands_import_nothing_of_each_other(imports):
    commands = {path: names for path, names in imports.items() if path.startswith('commands/')}
    modules = {f'gear_kinematics.commands.{Path(path).stem}' for path in commands}
    shared = {f'gear_kinematics.commands.{name}' for name in ('arguments', 'output')}
    assert modules > shared
    for path, names in commands.items():
        assert not names & (modules - shared), path
        assert not {name for name in names if within(name, 'gear_kinematics.cli')}, path


def test_imports_are_found_wherever_they_are():
    source = """
import a.b as c
from d import e
def f():
    from . import g
    from ..h import i
    if True:
        import j, k
"""
    expected = {'a.b', 'd', 'd.e', 'p.q', 'p.q.g', 'p.h', 'p.h.i', 'j', 'k'}
    assert imported_modules(source, 'p.q') == expected
    assert is_ros('sensor_msgs.msg')
    assert is_ros('rclpy.node')
    assert not is_ros('numpy')
    assert not within('rclpython', 'rclpy')
