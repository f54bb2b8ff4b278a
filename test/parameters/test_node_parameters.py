# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Parameter tables and files: defaults of the contract, faults that name parameter and bound."""

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
import yaml
from refusals import refused

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.parameters import NODE, ConfigError, NodeParameters, default_config
from gear_kinematics.parameters.files import given_parameters, require_any

load = NodeParameters.load

CONTRACT = {
    'ring_teeth': 80,
    'satellite_teeth': 76,
    'eccentricity': 0.0011,
    'module': 0.0005,
    'branches': ['a', 'b'],
    'a.cam_phase': 0.0,
    'a.axial_position': 0.04,
    'b.cam_phase': math.pi,
    'b.axial_position': -0.04,
    'gear_ratio': '',
    'rotor_joint': 'rotor',
    'output_joint': 'output_shaft',
    'rotor_direction': 1,
    'rotor_zero': 0.0,
    'home_angle': 0.0,
    'home_max_speed': 0.05,
    'home_file': '',
    'rotor_encoder': 'multi_turn',
    'rotor_encoder_range': 0.0,
    'rotor_effort_factor': 1.0,
    'output_range': [],
    'actuators': [],
    'max_rotor_speed': 650.0,
    'input_timeout': 1.0,
    'unreferenced_outputs': 'publish',
    'frame_prefix': '',
    'preload': 0.0,
    'branch_stiffness': [0.0],
    'shaft_stiffness': 0.0,
    'loads.satellite_mass': 0.0,
    'loads.satellite_inertia': 0.0,
    'loads.coupling_mass': 0.0,
    'loads.coupling_inertia': 0.0,
    'loads.rotor_inertia': 0.0,
    'loads.pressure_angle': 0.0,
}
OUR_OWN = {
    'calibration': '',
    'max_rotor_acceleration': 6500.0,
    'markers_rate': 30.0,
    'executor': 'auto',
    'meshes': 'auto',
    'output_encoder_joint': '',
    'output_encoder_direction': 1,
    'output_encoder_zero': 0.0,
    'output_encoder_reference': 'none',
    'transmission_error_window': 10.0,
    'transmission_error_limit': 0.003,
    'transmission_error_max_gap': 0.1,
    'transmission_error_travel': math.radians(1.0),
}


def write(folder: Path, text: str) -> Path:
    path = folder / 'actuator.yaml'
    path.write_text(text, encoding='utf-8')
    return path


def config(folder: Path, **values) -> Path:
    """Write a typical parameter file."""
    return write(folder, yaml.safe_dump({'/**': {'ros__parameters': values}}, allow_unicode=True))


def fault(folder: Path, **values) -> str:
    path = config(folder, **values)
    with refused(ConfigError, path) as caught:
        load(path)
    return str(caught.value)


def test_default_values_are_those_of_the_contract(tmp_path):
    """The parameters are exactly these; a file for another gear changes what is in it."""
    defaults = NodeParameters.load().values()
    assert defaults == CONTRACT | OUR_OWN
    assert {name: type(defaults[name]) for name in CONTRACT} == {
        name: type(value) for name, value in CONTRACT.items()
    }
    assert set(given_parameters(default_config(), NODE)) == set(defaults)
    other = load(config(tmp_path, ring_teeth=61, satellite_teeth=58))
    assert other == replace(NodeParameters.load(), ring_teeth=61, satellite_teeth=58)
    assert other.gear == other.mechanism
    assert other.mechanism.gear_ratio == Fraction(-58, 3)


def test_written_parameters_are_read_again(tmp_path):
    given = {
        'gear_ratio': '-19',
        'frame_prefix': '1e5',
        'branches': ['left'],
        'left.cam_phase': 2.0,
    }
    parameters = NodeParameters.of(given)
    assert load(write(tmp_path, parameters.as_file())) == parameters
    assert parameters.gear == -19
    with pytest.raises(MechanismError, match='gear_ratio is -19: only the ratio of this gear'):
        parameters.mechanism  # noqa: B018, it raises


REFUSED = [
    ('ring_teeth', 100_001, ('2', '100000')),
    ('ring_teeth', True, ('int',)),
    ('eccentricity', 1.1, ('1e-06', '1.0')),
    ('eccentricity', 1, ('float',)),
    ('branches', 'a', ("list, not 'a'; write ['a']",)),
    ('branches', [1, 2], ('strings',)),
    ('actuators', [True, 'x'], ('; quote it, as YAML takes y, n,',)),
    ('rotor_joint', True, ('; quote it, as YAML takes y, n,',)),
    ('gear_ratio', '19:1', ('an integer, a fraction or a decimal, such as -19',)),
    ('gear_ratio', 50.5, ("'101/2' or '50.5', and twice after -p: \"gear_ratio:='50.5'\"",)),
    ('rotor_joint', 1, ("; quote it: '1'",)),
    ('rotor_direction', 0, ('-1', '1', '2')),
    ('rotor_zero', math.inf, ('1e+15',)),
    ('rotor_encoder', 'absolute', ('multi_turn', 'single_turn')),
    ('rotor_encoder_range', 0.1, ('0.5 rad',)),
    ('rotor_effort_factor', 0.0, ('must not be 0',)),
    ('output_range', [1.0], ('two angles',)),
    ('output_range', [2.0, 1.0], ('ascending',)),
    ('output_range', [0.0, 6.3], ('less than 2π',)),
    ('output_range', [0.0, math.inf], ('less than 2π',)),
    ('output_range', [0, 1], ('decimal point',)),
    ('home_max_speed', -0.01, ('0.0', '1000000.0')),
    ('preload', 5e-324, ('0', '1e-06')),
    ('shaft_stiffness', 1e-300, ('0', '0.001')),
    ('branch_stiffness', [3000.0, 1e-300], ('0', '0.001')),
    ('branch_stiffness', [1.0, 2.0, 3.0], ('one or two values of at least 0',)),
    ('a.cam_phase', 7.0, ('-6.28', '6.28')),
    ('b.axial_position', math.nan, ('-10.0', '10.0')),
]


@pytest.mark.parametrize(('name', 'value', 'bounds'), REFUSED)
def test_fault_names_parameter_value_and_bound(tmp_path, name, value, bounds):
    text = fault(tmp_path, **{name: value})
    assert name in text
    assert repr(value) in text
    for bound in bounds:
        assert bound in text or str(float(bound)) in text


@pytest.mark.parametrize('name', ['branches', 'actuators'])
def test_more_names_than_any_robot_has_are_refused(tmp_path, name):
    """The bodies of 20 000 branches fill 7 GB."""
    names = [f'x{k}' for k in range(257)]
    assert fault(tmp_path, **{name: names}).endswith(f'{name}: at most 256 names, not 257')
    path = tmp_path / 'all.yaml'
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': {name: names[1:]}}}), 'utf-8')
    load(path, actuator='x1' * (name == 'actuators'))


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('ring_teeth', 2),
        ('rotor_direction', -1),
        ('gear_ratio', '-58/3'),
        ('frame_prefix', 'links/φ_'),
        ('a.cam_phase', -2.0 * math.pi),
        ('branches', ['b']),
    ],
)
def test_value_on_the_bound_is_taken(tmp_path, name, value):
    assert load(config(tmp_path, **{name: value})).values()[name] == value


@pytest.mark.parametrize(
    ('name', 'hint'),
    [
        ('rotor_jiont', '; did you mean `rotor_joint`?'),
        ('a.cam_fase', '; did you mean `a.cam_phase`?'),
        ('c.cam_phase', '; `c` is not in `branches`'),
        ('nothing_like_it', ''),
    ],
)
def test_unknown_parameter_is_refused_with_the_nearest_name_or_all(tmp_path, name, hint):
    text = fault(tmp_path, **{name: 1.0})
    _, _, said = text.partition(f': unknown parameter `{name}`')
    every = said.startswith('; there are: ring_teeth, ') and said.endswith(', b.axial_position')
    assert said == hint if hint else every


@pytest.mark.parametrize(
    'block',
    [
        'gear_state_publisher: {}',
        '/**/gear_state_publisher: {}',
        'arm: {{gear_state_publisher: {}}}',
        # One file for all nodes of a robot is how ROS users keep their parameters.
        'gear_state_publisher: {}\nbroadcaster: {{ros__parameters: {{use_local_topics: true}}}}',
    ],
)
def test_every_name_of_the_node_is_known(tmp_path, block):
    text = block.format('{ros__parameters: {ring_teeth: 90}}')
    assert load(write(tmp_path, text)).ring_teeth == 90


LEFT, RIGHT = (f'/{side}/gear_state_publisher' for side in ('left', 'right'))


def blocks(folder: Path, *names: str) -> Path:
    """Write a file with a block for each name: ring_teeth is 81 in the first, 82 in the next."""
    text = ''.join(
        f"'{name}':\n  ros__parameters: {{ring_teeth: {teeth}}}\n"
        for teeth, name in enumerate(names, start=81)
    )
    return write(folder, text)


@pytest.mark.parametrize(
    ('names', 'node', 'expected'),
    [
        ([LEFT, RIGHT], LEFT, 81),
        ([LEFT, RIGHT], RIGHT, 82),
        ([LEFT, RIGHT], RIGHT[1:], 82),  # as in `ros2 param`
        (['/**', '/left/gear'], 'gear', 82),
        (['/**', '/left/gear'], 'gear_state_publisher', 81),
    ],
)
def test_name_without_namespace_is_that_of_the_only_node_in_the_file(
    tmp_path, names, node, expected
):
    assert load(blocks(tmp_path, *names), node).ring_teeth == expected


@pytest.mark.parametrize('names', [[LEFT, RIGHT], ['gear_state_publisher', LEFT]])
def test_file_that_leaves_open_which_node_is_meant_is_refused(tmp_path, names):
    path = blocks(tmp_path, '/other_node', *names)
    with pytest.raises(ConfigError) as caught:
        load(path)
    there = ', '.join(name if name.startswith('/') else f'/{name}' for name in names)
    assert str(caught.value) == (
        f'{path}: parameters of more than one node: {there}; choose one with --node'
    )


def test_one_of_several_files_has_something_for_the_node(tmp_path):
    files = []
    for k, names in enumerate([['/other'], [LEFT], ['/**/x', '/y']]):
        (tmp_path / f'{k}').mkdir()
        files.append(blocks(tmp_path / f'{k}', *names))
    require_any((), LEFT)
    require_any(files, LEFT)
    with pytest.raises(ConfigError) as caught:
        require_any(files, RIGHT)
    assert str(caught.value) == (
        f'{files[0]}: no parameters of {RIGHT} in it, only of /other; '
        f'{files[1]}: no parameters of {RIGHT} in it, only of {LEFT}; '
        f'did you mean `{LEFT}`?; '
        f'{files[2]}: no parameters of {RIGHT} in it, only of /**/x, /y'
    )
    (tmp_path / 'empty.yaml').write_text('')
    with pytest.raises(ConfigError, match=r'empty\.yaml: no ros__parameters in it'):
        require_any([*files, tmp_path / 'empty.yaml'], LEFT)


# As rcl 9.2 and 10.1 hand them to a node; PyYAML alone reads most of them in another way.
READ_BY_RCL = {
    'y N yes off TRUE': [True, False, True, False, True],
    '15 017 0x1F +5 -0': [15, 15, 31, 5, 0],
    '1.5e-3 15e-4 .0015 +.5 08 1.e+3 inf -.INF NaN': [
        0.0015, 0.0015, 0.0015, 0.5, 8.0, 1e3, math.inf, -math.inf, math.nan],
    "1:20 8_0 0b11 0x_50 0o17 TrUe 1e 2001-01-01 = '5' 'y'": [
        '1:20', '8_0', '0b11', '0x_50', '0o17', 'TrUe', '1e', '2001-01-01', '=', '5', 'y'],
}  # fmt: skip


@pytest.mark.parametrize(('scalars', 'values'), READ_BY_RCL.items())
def test_values_of_a_node_file_are_what_rcl_reads(tmp_path, scalars, values):
    text = f'/**: {{ros__parameters: {{k: [{", ".join(scalars.split())}]}}}}'
    found = given_parameters(write(tmp_path, text), NODE)['k']
    assert [*map(repr, found)] == [*map(repr, values)]


@pytest.mark.parametrize('begin', ['', '.', '1.', '0x', '1e'])
def test_a_long_text_that_begins_as_a_number_is_read_at_once(tmp_path, begin):
    """In a time that rises with its square, it would take hours."""
    text = f'{begin}{500_000 * "1"}x'
    path = write(tmp_path, f'/**: {{ros__parameters: {{k: {text}}}}}')
    assert given_parameters(path, NODE) == {'k': text}


def test_many_wildcards_are_compared_at_once(tmp_path):
    """Trying one after the other would take years."""
    name = f'{60 * "/x"}/gear_state_publisher'
    for pattern in (f'{60 * "/**"}/y', f'{30 * "/**/*"}/y'):
        path = write(tmp_path, f'"{pattern}": {{ros__parameters: {{ring_teeth: 80}}}}')
        with refused(ConfigError, path, f'no parameters of {name} in it'):
            given_parameters(path, name)
    path = write(tmp_path, f'"{80 * "/**/x"}": {{ros__parameters: {{ring_teeth: 80}}}}')
    with refused(ConfigError, path, '/x is not a valid node name'):
        given_parameters(path, name)
    path = write(tmp_path, f'"{20 * "/**/x/*"}/**": {{ros__parameters: {{ring_teeth: 80}}}}')
    assert given_parameters(path, name) == {'ring_teeth': 80}


def test_names_in_a_node_file_are_texts_as_for_rcl(tmp_path):
    names = 'on', 'y', '017', '1.50', 'null', '='
    blocks = ''.join(f'    {name}:\n      k: 1\n' for name in names)
    path = write(tmp_path, f'/**:\n  ros__parameters:\n{blocks}')
    assert [*given_parameters(path, NODE)] == [f'{name}.k' for name in names]


@pytest.mark.parametrize(
    ('content', 'cause'),
    [
        (None, 'No such file or directory'),
        (b'\xff\xfe\x00', "can't decode byte 0xff"),
        (b'a: [1', "expected ',' or ']'"),
        (b'a: b: c', 'mapping values are not allowed'),
        (b'a: &x 1\nb: *x', 'aliases are not supported in line 2'),
        (b'a: !!float 10', "'tag:yaml.org,2002:float' has no effect before ROS Lyrical"),
        (b'a: !!set {}', "'tag:yaml.org,2002:set' has no effect before ROS Lyrical"),
        (b'? [a]\n: 1', 'expected a scalar node, but found sequence in line 1'),
        (b'%TAG ! tag:x,2000:\n---\na: 1', '%TAG is not supported'),
        (b'[1, 2]', 'no ros__parameters in it'),
        (b'/**: {ros__parameters: 5}', 'no ros__parameters in it'),
        (b'/**: {ros__parameters: {rotor_joint: }}', 'rotor_joint must be of type str, not None'),
        (b'a b: {ros__parameters: {ring_teeth: 80}}', '/a b is not a valid node name'),
        (2**20 * b'#' + b'\n', 'longer than 1048576 bytes'),
    ],
)
def test_what_is_no_parameter_file_is_refused_in_one_line(tmp_path, content, cause):
    path = tmp_path / 'actuator.yaml'
    if content is not None:
        path.write_bytes(content)
    with refused(ConfigError, path, cause):
        load(path)


@pytest.mark.parametrize('path', ['mine.yaml', '/there/mine.yaml'])
def test_path_of_a_calibration_is_relative_to_the_file_that_names_it(tmp_path, path):
    file = config(tmp_path, calibration=path)
    assert load(file).calibration == str(tmp_path / path)
    assert require_any([file], '/gear_state_publisher') == {path: tmp_path / path}


@pytest.mark.parametrize(
    ('names', 'refused'),
    [
        (['/**', 'gear_state_publsher'], '/gear_state_publsher'),
        (['/**', '/left/gear_state_publisherr'], '/left/gear_state_publisherr'),
        (['/**', 'gear_state_publisher_2'], ''),  # another gear with the same common part
        (['/**', LEFT, RIGHT], ''),
        (['/**', 'gear_state_publsher', '/gear_state_publisher'], ''),
    ],
)
def test_block_of_a_mistyped_node_beside_a_wildcard_is_refused(tmp_path, names, refused):
    path = blocks(tmp_path, *names)
    if not refused:
        assert load(path, '/gear_state_publisher').ring_teeth in {81, 83}
        return
    message = f'a wildcard apply to /gear_state_publisher, not those of {refused}: correct'
    with pytest.raises(ConfigError, match=message):
        load(path, '/gear_state_publisher')


@pytest.mark.parametrize('common', ['use_sim_time: false', 'rotor_joint: m1'])
@pytest.mark.parametrize('node', ['motor', '/left/gear_state_publisher'])
def test_gear_of_another_node_beside_a_wildcard_without_one_is_refused(tmp_path, node, common):
    text = f"'/**': {{ros__parameters: {{{common}}}}}\n{node}: "
    gear = write(tmp_path, text + "{ros__parameters: {gear_ratio: '-30'}}")
    with pytest.raises(ConfigError, match=f'to /gear_state_publisher, not those of /?{node}:'):
        load(gear, '/gear_state_publisher')
    other = write(tmp_path, text + '{ros__parameters: {update_rate: 100}}')
    assert load(other, '/gear_state_publisher').ring_teeth == 80
