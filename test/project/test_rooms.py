# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Rooms of the package: what they may import, what a listing shows, and that each has tests."""

import ast
import importlib.util
import sys
from itertools import chain
from pathlib import Path

import pytest

from gear_kinematics.wire.topics import TOPICS

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / 'gear_kinematics'
ROS = ('ament_index_python', 'builtin_interfaces', 'launch', 'launch_ros', 'rclpy', 'rosidl')


def imported_modules(nodes: list[ast.AST]) -> set[str]:
    """Return the full names of all modules that a source imports anywhere in it.

    `from a import b` gives a and a.b, of which b may be a module.
    """
    names: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, 'imports are absolute'
            names |= {node.module, *(f'{node.module}.{alias.name}' for alias in node.names)}
    return names


def within(name: str, *packages: str) -> bool:
    return any(name == package or name.startswith(f'{package}.') for package in packages)


def is_ros(name: str) -> bool:
    top = name.partition('.')[0]
    return top in ROS or top.endswith(('_msgs', '_srvs', '_interfaces')) or top.startswith('rcl')


@pytest.fixture(scope='module')
def sources() -> dict[str, list[ast.AST]]:
    """Return for each source, by its path in the package, its syntax."""
    return {
        path.relative_to(PACKAGE).as_posix(): [*ast.walk(ast.parse(path.read_text('utf-8')))]
        for path in sorted(PACKAGE.rglob('*.py'))
    }


@pytest.fixture(scope='module')
def imports(sources) -> dict[str, set[str]]:
    return {path: imported_modules(nodes) for path, nodes in sources.items()}


def test_core_imports_numpy_the_standard_library_and_itself(imports):
    """So does the package above it, which is imported before the core."""
    allowed = (*sys.stdlib_module_names, 'numpy', 'gear_kinematics.kinematics')
    for path, names in imports.items():
        if path.startswith('kinematics/') or path == '__init__.py':
            assert not {name for name in names if not within(name, *allowed)}, path


def test_closed_form_and_matrix_method_share_no_formula(imports):
    core = 'gear_kinematics.kinematics'
    of_both = {f'{core}.motion', f'{core}.motion.MotionState', f'{core}.motion.motion_state'}
    for taker, maker in (
        ('matrix_method', 'motion'),
        ('transforms', 'motion'),
        ('motion', 'matrix_method'),
        ('motion', 'transforms'),
        ('rotor_turns', 'matrix_method'),
        ('mechanism', 'matrix_method'),
    ):
        taken = imports[f'kinematics/{taker}.py']
        assert {name for name in taken if within(name, f'{core}.{maker}')} <= of_both, taker


@pytest.mark.parametrize('name', ['independent', 'independent_bodies', 'independent_message'])
def test_independent_comparison_shares_nothing_with_the_node(name, imports):
    """It reads recordings and parameters; what the node computes is done by other code."""
    path, package = f'validation/{name}.py', 'gear_kinematics'
    shared = {name.removeprefix(f'{package}.') for name in imports[path] if within(name, package)}
    others = 'bag', 'parameters', 'validation.independent_bodies', 'validation.independent_message'
    assert not {name for name in shared if not within(name, *others)} - {
        'kinematics',
        'kinematics.Mechanism',
        'kinematics.matrix_method',
        *(f'validation.task{name}' for name in ('', '.Task')),
    }
    assert (PACKAGE / path).read_bytes().count(b'\n') <= 200


ROOMS = {
    'kinematics': '',
    'wire': 'kinematics',
    'shape': 'kinematics',
    'parameters': 'kinematics shape wire',
    'bag': 'parameters wire',
    'fleet': '',
    'statistics': '',
    'correction': 'kinematics parameters statistics wire',
    'state': 'correction kinematics parameters shape statistics wire',
    'report': 'kinematics shape statistics',
    'validation': 'bag correction fleet kinematics parameters report state statistics wire',
    'measurement': 'bag correction fleet kinematics parameters report state statistics wire',
    'plotting': 'bag kinematics parameters report shape state wire',
    'twin': 'correction kinematics parameters shape wire',
    'ros': 'bag correction kinematics parameters shape state twin wire',
    'watch': 'bag kinematics measurement parameters report ros shape state wire',
    'commands': 'bag correction fleet kinematics measurement parameters plotting report ros '
    'shape twin validation watch wire',
}  # fmt: skip
ROOMS = {room: below.split() for room, below in ROOMS.items()}
"""Each room of the package and the rooms it imports, all of which stand before it."""
TENANTS = {
    'rosbags': ['bag'],
    'matplotlib': ['plotting', 'report'],
    'plotly': ['report'],
    'mapbox_earcut': ['shape'],
    'tornado': ['watch'],
    'scipy': ['measurement'],
    'rainflow': ['measurement'],
    'mujoco': ['twin'],
    'distributed': ['fleet'],
}
"""Libraries, and the only rooms that import them."""


def test_a_listing_of_the_package_shows_the_rooms():
    names = {path.name for path in PACKAGE.iterdir()} - {'__pycache__'}
    assert names == {*ROOMS, '__init__.py', '__main__.py', 'py.typed', 'share.py'}
    assert len(names) <= 21


def test_no_file_is_longer_than_350_lines():
    files = (p for p in PACKAGE.rglob('*') if p.is_file() and '__pycache__' not in p.parts)
    lines = {p.relative_to(PACKAGE).as_posix(): p.read_bytes().count(b'\n') for p in files}
    assert not {path: count for path, count in lines.items() if count > 350}


def test_no_two_classes_share_a_name(sources):
    nodes = chain.from_iterable(sources.values())
    names = [node.name for node in nodes if isinstance(node, ast.ClassDef)]
    assert not {name for name in names if names.count(name) > 1}


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


@pytest.mark.parametrize('library', TENANTS)
def test_libraries_stay_in_their_rooms(imports, library):
    users = {
        path.split('/')[0]
        for path, names in imports.items()
        if any(within(n, library) for n in names)
    }
    assert sorted(users) == TENANTS[library]


def test_messages_and_ros_are_imported_in_two_rooms(imports):
    users = {path.split('/')[0] for path, names in imports.items() if any(map(is_ros, names))}
    assert users == {'ros', 'watch'}


def test_topics_are_named_in_one_module(sources):
    # Plotly has markers too.
    names = {name for name in TOPICS if '_' in name}
    found = {
        path
        for path, nodes in sources.items()
        for node in nodes
        if isinstance(node, ast.Constant) and str(node.value).removeprefix('/') in names
    }
    assert found == {'wire/topics.py'}


def test_nothing_imports_the_entry_points(imports):
    for path, names in imports.items():
        if path != 'ros/__main__.py':
            assert not {name for name in names if within(name, 'gear_kinematics.__main__')}, path


def test_commands_import_nothing_of_each_other(imports):
    shared = ('arguments', 'bags', 'drawing', 'encoders', 'extras', 'files', 'output', 'pins')
    shared += ('reporter', 'joints')
    commands = {Path(path).stem for path in imports if path.startswith('commands/')}
    commands -= {'__init__', 'cli', *shared}
    assert {'validate', 'compute', 'plot'} < commands
    others = [f'gear_kinematics.commands.{name}' for name in (*commands, 'cli')]
    for name in (*commands, *shared):
        assert not imports[f'commands/{name}.py'].intersection(others), name


@pytest.mark.parametrize('folder', ['launch', 'examples', 'benchmark', 'fuzz', 'docs'])
def test_what_is_imported_from_the_package_is_there(folder):
    """Launch files run on a whole ROS alone, and the others seldom."""
    sources = [path.read_text('utf-8') for path in (ROOT / folder).rglob('*.py')]
    names = {
        (node.module, alias.name)
        for source in sources
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom) and within(str(node.module), 'gear_kinematics')
        for alias in node.names
    }
    assert names
    for module, name in names:
        there = hasattr(importlib.import_module(module), name)
        assert there or importlib.util.find_spec(f'{module}.{name}'), f'{module}.{name}'
