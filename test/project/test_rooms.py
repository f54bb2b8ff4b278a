"""Rooms of the package: what they may import, what a listing shows, and that each has tests."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from gear_kinematics.wire.topics import TOPICS

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


ROOMS = {
    'kinematics': (),
    'wire': ('kinematics',),
    'shape': ('kinematics',),
    'parameters': ('kinematics', 'shape', 'wire'),
    'correction': ('kinematics', 'parameters', 'wire'),
    'state': ('correction', 'kinematics', 'parameters', 'shape', 'wire'),
    'bag': ('correction', 'kinematics', 'parameters', 'state', 'wire'),
    'report': ('kinematics', 'shape'),
    'validation': (
        'bag',
        'correction',
        'kinematics',
        'parameters',
        'report',
        'state',
        'wire',
    ),
    'measurement': ('bag', 'correction', 'kinematics', 'parameters', 'report', 'state', 'wire'),
    'plotting': ('bag', 'correction', 'kinematics', 'report', 'shape'),
    'ros': (
        'bag',
        'correction',
        'kinematics',
        'parameters',
        'shape',
        'state',
        'validation',
        'wire',
    ),
    'watch': (
        'bag',
        'kinematics',
        'parameters',
        'report',
        'ros',
        'shape',
        'state',
        'wire',
    ),
    'commands': (
        'bag',
        'correction',
        'kinematics',
        'measurement',
        'parameters',
        'plotting',
        'report',
        'ros',
        'shape',
        'validation',
        'watch',
        'wire',
    ),
}
"""Each room of the package and the rooms it imports, all of which stand before it."""
MEASUREMENT = {
    'preload': ('comparison', 'encoder_step', 'loops', 'lost_motion', 'wording'),
    'compare': ('comparison', 'figures', 'loops', 'lost_motion', 'recording', 'wording'),
    'calibration': ('curves', 'ratio', 'recording', 'transmission', 'wording'),
}
"""Rooms within `measurement`, and what of its modules they import."""
TENANTS = {
    'rclpy': ['ros', 'watch'],
    'rosbags': ['bag'],
    'matplotlib': ['plotting', 'report'],
    'plotly': ['report'],
    'mapbox_earcut': ['shape'],
    'tornado': ['watch'],
    'scipy': ['measurement'],
}
"""Libraries, and the only rooms that import them."""


def test_a_listing_of_the_package_shows_the_rooms():
    names = {path.name for path in PACKAGE.iterdir()} - {'__pycache__'}
    assert names == {*ROOMS, '__init__.py', '__main__.py', 'py.typed', 'share.py'}
    assert len(names) <= 18


@pytest.mark.parametrize('room', [*ROOMS, *(f'measurement/{room}' for room in MEASUREMENT)])
def test_room_says_in_a_sentence_what_it_is(room):
    document = ast.parse((PACKAGE / room / '__init__.py').read_text('utf-8'))
    first = (ast.get_docstring(document) or '').partition('\n')[0]
    assert re.fullmatch(r'[A-Z].{20,}\.', first)


def test_no_file_is_longer_than_350_lines():
    files = (p for p in PACKAGE.rglob('*') if p.is_file() and '__pycache__' not in p.parts)
    lines = {p.relative_to(PACKAGE).as_posix(): p.read_bytes().count(b'\n') for p in files}
    assert not {path: count for path, count in lines.items() if count > 350}


def quick_tests(path: Path) -> list[str]:
    """Return the tests of a file that carry none of the marks that `make quick` leaves out."""
    document = ast.parse(path.read_text('utf-8'))

    def marked(*nodes: ast.AST) -> bool:
        return any(re.search(r'mark\.(live|slow)\b', ast.unparse(node)) for node in nodes)

    if any(isinstance(node, ast.Assign) and marked(node) for node in document.body):
        return []
    functions = (node for node in document.body if isinstance(node, ast.FunctionDef))
    return [
        function.name
        for function in functions
        if function.name.startswith('test_') and not marked(*function.decorator_list)
    ]


@pytest.mark.parametrize('room', ROOMS)
def test_room_has_quick_tests(room):
    assert any(map(quick_tests, (ROOT / 'test' / room).glob('test_*.py')))


def test_rooms_import_as_the_table_says(imports):
    found = {room: set() for room in ROOMS}
    for path, names in imports.items():
        room, inside, _ = path.partition('/')
        if not inside or path == 'ros/__main__.py':  # the programs' entry points
            continue
        rooms = {
            name.split('.')[1] for name in names if within(name, 'gear_kinematics') and '.' in name
        }
        found[room] |= rooms & ROOMS.keys() - {room}
    assert found == {room: set(below) for room, below in ROOMS.items()}


def test_rooms_import_only_rooms_before_them():
    before = []
    for room, below in ROOMS.items():
        assert set(below) <= set(before), room
        before.append(room)


@pytest.mark.parametrize(
    ('arguments', 'rooms'),
    [
        (['--version'], ['ros']),  # for the shared memory, before anything else
        (
            ['validate', 'none'],
            ['commands', 'ros', 'validation', *ROOMS['validation'], *ROOMS['report']],
        ),
    ],
)
def test_programs_load_no_room_that_they_do_not_use(arguments, rooms):
    code = (
        'import sys; from gear_kinematics.__main__ import gearkin; gearkin(); '
        'print(*{name.split(".")[1] for name in sys.modules if name.startswith("gear_kin")'
        ' and "." in name}, "rclpy" in sys.modules, "scipy" in sys.modules)'
    )
    command = [sys.executable, '-c', code, *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    *loaded, rclpy, scipy = done.stdout.splitlines()[-1].split()
    assert set(loaded) - {'__main__', 'share'} == set(rooms)
    assert (rclpy, scipy) == ('False', 'False')


def test_imports_within_measurement_point_one_way(imports):
    own = 'gear_kinematics.measurement'
    for path, names in imports.items():
        top, _, inside = path.removeprefix('measurement/').partition('/')
        if not path.startswith('measurement/'):
            continue
        taken = {name.split('.')[2] for name in names if within(name, own) and name != own}
        if inside:
            assert taken <= {top, *MEASUREMENT[top]}, path
        else:
            assert not taken & MEASUREMENT.keys(), path


@pytest.mark.parametrize('library', TENANTS)
def test_libraries_stay_in_their_rooms(imports, library):
    users = {
        path.split('/')[0]
        for path, names in imports.items()
        if any(within(n, library) for n in names)
    }
    assert sorted(users) == TENANTS[library]


def test_messages_and_ros_are_imported_in_one_room(imports):
    users = {path.split('/')[0] for path, names in imports.items() if any(map(is_ros, names))}
    assert users == {'ros', 'watch'}


def test_topics_are_named_in_one_module():
    # Plotly has markers too.
    names = {name for name in TOPICS if '_' in name}
    found = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob('*.py')
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8')))
        if isinstance(node, ast.Constant) and str(node.value).removeprefix('/') in names
    }
    assert found == {'wire/topics.py'}


def test_nothing_imports_the_entry_points(imports):
    for path, names in imports.items():
        if path != 'ros/__main__.py':
            assert not {name for name in names if within(name, 'gear_kinematics.__main__')}, path


def test_imports_within_bag_point_one_way(imports):
    layers = (
        ('errors', 'limits', 'ros1_types'),
        ('topics',),
        ('storage',),
        ('contents', 'mcap', 'sqlite', 'ros1'),
        ('reading', 'storage_writers'),
        ('writing',),
        ('__init__',),
        ('schedule', 'finding', 'roles', 'fleet'),
        ('summary', 'compute', 'trajectory'),
    )
    files = {f'bag/{name}.py' for layer in layers for name in layer}
    assert files == {path for path in imports if path.startswith('bag/')}
    below = ['gear_kinematics.wire', 'gear_kinematics.parameters.yaml_file']
    for layer in layers:
        if 'compute' in layer:
            below += [f'gear_kinematics.{room}' for room in ROOMS['bag']]
        for path in (f'bag/{name}.py' for name in layer):
            taken = {name for name in imports[path] if within(name, 'gear_kinematics')}
            assert all(within(name, *below) for name in taken), path
        below += [f'gear_kinematics.bag.{name}'.removesuffix('.__init__') for name in layer]


def test_commands_import_nothing_of_each_other(imports):
    shared = ('arguments', 'bags', 'bracing', 'drawing', 'encoders', 'extras', 'files', 'output')
    shared += ('paper_size', 'reporter')
    commands = {Path(path).stem for path in imports if path.startswith('commands/')}
    commands -= {'__init__', 'cli', *shared}
    assert {'validate', 'compute', 'plot'} < commands
    others = [f'gear_kinematics.commands.{name}' for name in (*commands, 'cli')]
    for name in (*commands, *shared):
        assert not imports[f'commands/{name}.py'].intersection(others), name


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
