# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The program gearkin as a user runs it: output, exit codes, one clear line on bad input."""

import json
import math
import re
import shlex
from pathlib import Path

import pytest
from blocked_bags import BAGS, gearkin, gearkin_here, refusal
from terminals import ENVIRONMENT, Terminal

from gear_kinematics.commands.cli import COMMANDS, main, make_parser

SINGLE_TURN = str(BAGS / 'single_turn_encoder')


# The demonstration.


@pytest.mark.live
@pytest.mark.slow
def test_demo_plays_the_shipped_bag_through_the_live_node_and_agrees():
    """In a pipe, as plain lines, and as it turns, on a terminal."""
    with Terminal() as screen:
        done = gearkin('demo', stderr=screen.other, env=ENVIRONMENT)
        shown = screen.text()
    assert done.returncode == 0, shown
    assert len(set(re.findall(r'output +(-?[\d.]+)°', shown))) > 10
    first, verdict, learned, following = done.stdout.splitlines()
    assert first.startswith('Playing servo_point_to_point, 3000 recorded rotor states, into ')
    assert re.fullmatch(
        r'servo_point_to_point: verdict: passed; 3000 inputs, 6000 outputs compared, '
        r'largest error 0 \(tolerance (1e-12|1.1e-15)\); 6000 outputs agree with the '
        r'matrix method; largest errors: .*',
        verdict,
    )
    # The shipped trajectory has its peak at 130 rad of the rotor.
    [angle] = re.findall(r'The output turned by up to (\S+)°, .* right within \S+′\.', learned)
    assert float(angle) == pytest.approx(math.degrees(130.0 / 19.0), abs=0.05)
    assert following.startswith('Next: make simulator')


# What a mechanism is.


def test_describe_tells_the_numbers_of_the_specification(capsys):
    assert main(['describe', '--json', '-']) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts == {
        'made_by': 'gearkin describe',
        'ring_teeth': 80,
        'satellite_teeth': 76,
        'eccentricity': 0.0011,
        'branches': ['a', 'b'],
        'gear_ratio': '-19',
        'mobility_by_counting': 0,
        'mobility_by_rank': 1,
        'ring_rolling_radius': pytest.approx(0.022),
        'satellite_rolling_radius': pytest.approx(0.0209),
        'oldham_petals': 40,
        'vernier_distinct_positions': 265_680,
        'vernier_step': pytest.approx(2.36494e-5, rel=1e-5),
        'module': 0.0005,
        'working_pressure_angle': pytest.approx(math.acos(math.cos(math.radians(20.0)) / 1.1)),
        'ring_profile_shift': pytest.approx(0.258, abs=1e-3),
        'addendum': 1.0,
        'satellite_tip_radius': pytest.approx(0.0195),
        'ring_tip_radius': pytest.approx(0.019629, abs=1e-6),
        'tip_interference_margin': pytest.approx(0.0003, abs=1e-4),
        'contact_ratio': pytest.approx(1.86, abs=0.01),
        'interference': None,
    }


def test_describe_prints_numbers_for_people(capsys):
    assert main(['describe', '--eccentricity', '0.00110013']) == 0
    lines = dict(line.split(': ', 1) for line in capsys.readouterr().out.splitlines())
    shown = {
        'eccentricity': '0.00110013 m',
        'ring rolling radius': '0.0220026 m',
        'working pressure angle': '31° 19′ 56.577″',
        'vernier step': '4.878″',
        'contact ratio': '1.86138',
    }
    assert {name: lines[name] for name in shown} == shown
    assert lines['tip interference margin'].endswith('″')
    assert main(['describe', '--ring-teeth', '61', '--satellite-teeth', '58']) == 0
    assert 'gear ratio: -58/3\n' in capsys.readouterr().out


def test_describe_says_where_teeth_cannot_avoid_interference(capsys):
    arguments = ['describe', '--eccentricity', '0.001', '--module', '0.00051']
    assert main([*arguments, '--json', '-']) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts['contact_ratio'] is None
    assert 'tip interference margin of -' in facts['interference']
    assert main(arguments) == 0
    text = ' '.join(capsys.readouterr().out.split())
    assert 'do not mesh at an eccentricity of 0.001 m' in text
    assert 'None' not in text


# A parameter file for two nodes.


@pytest.fixture
def two_nodes(tmp_path) -> str:
    path = tmp_path / 'two.yaml'
    path.write_text(
        '/left/gear_state_publisher:\n'
        "  ros__parameters: {frame_prefix: 'left_', rotor_encoder: 'multi_turn'}\n"
        '/right/gear_state_publisher:\n'
        "  ros__parameters: {frame_prefix: 'right_', rotor_encoder: 'single_turn'}\n"
    )
    return str(path)


def test_outputs_are_those_of_the_node_that_was_asked_for(capsys, two_nodes, tmp_path):
    """Its encoder has a single turn, as that of the bag."""
    node = ['--config', two_nodes, '--node', 'right/gear_state_publisher']
    out = str(tmp_path / 'computed')
    assert main(['compute', SINGLE_TURN, out, *node]) == 0
    assert main(['validate', out, *node]) == 0
    assert main(['validate', out, *node[:-1], '/left/gear_state_publisher']) == 1
    capsys.readouterr()


@pytest.mark.parametrize(
    'arguments',
    [['urdf'], ['validate', SINGLE_TURN], ['compute', SINGLE_TURN, 'computed'],
     ['lost-motion', SINGLE_TURN], ['plot', 'scheme', 'scheme.png']],
    ids=lambda arguments: arguments[0],
)  # fmt: skip
def test_file_for_two_nodes_is_refused_naming_them(two_nodes, tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    assert refusal(*arguments, '--config', two_nodes).endswith(
        f'{two_nodes}: parameters of more than one node: '
        '/left/gear_state_publisher, /right/gear_state_publisher; choose one with --node'
    )
    assert [*tmp_path.iterdir()] == [Path(two_nodes)]


# What cannot be used.


@pytest.mark.parametrize(('arguments', 'cause'), [
    ('', 'arguments are required: COMMAND; see gearkin --help'), ('unknown', "'unknown'"),
    ('plot output --bag a', 'required: FILE, as in gearkin plot output'),
    ('describe --ring-teeth many', "--ring-teeth: must be a whole number, not 'many'; see"),
    ('validate bag --jobs 1.5', "--jobs: must be a whole number, not '1.5'; see"),
    ('lost-motion a.csv --max-backlash 3′', "must be a number, not '3′'; see"),
    ('describe --satellite-teeth 80', 'satellite_teeth (80) must be less than'),
    ('describe --module 0', 'module must be'),
    ('describe --eccentricity nan', '--eccentricity must be between 1e-06 and 1.0'),
    ('describe --config missing.yaml', 'missing.yaml: No such file or directory'),
    ('preload --setting 1 2', 'expected 3 arguments; see gearkin preload --help'),
    ('validate bag --junit', '--junit: expected one argument'),
    ('watch --node /left/1', "--node: ROS has no nodes of the name '/left/1'; see gearkin watch"),
])  # fmt: skip
def test_unusable_arguments_get_one_clear_line_and_code_2(arguments, cause):
    assert cause in refusal(*arguments.split())


IMPOSSIBLE = {
    'preload': 'wanted-preload 1e7, wanted-threshold -1e7, margin 200, branch-stiffness 1e-300',
    'plot': 'torque -1e7, speed 1e18, degrees 1e7, duration -1e-3, start-offset -inf',
    'animate': 'rate 1e-300, rate 1e300',
    'replay': 'rate nan, rate -1e-3',
    'loads': 'cam-rating 0.3, slot-friction 15',
    'lost-motion': 'rated-torque 1e-300, max-backlash 1e300, min-stiffness 1e-300',
    'validate': 'tolerance-angle -1e-9, tolerance-effort inf',
}
"""Options that cannot be true, some of which are in mm or percent."""


@pytest.mark.parametrize('command', IMPOSSIBLE)
def test_an_impossible_number_is_refused_and_named(command):
    for given in IMPOSSIBLE[command].split(', '):
        option, value = given.split()
        said = refusal(command, f'--{option}', value)
        assert re.match(rf'argument --{option}: must be .*, not {value}; see gearkin', said), said


@pytest.mark.parametrize('command', ['', *COMMANDS])
def test_help_is_everywhere(command):
    done = gearkin_here(*command.split(), '--help')
    assert done.returncode == 0
    assert done.stdout.startswith(f'usage: gearkin {command}')
    if command:
        purpose, example = COMMANDS[command]
        assert purpose in done.stdout
        assert done.stdout.endswith(f'\n\nexample:\n  gearkin {example}\n')
        make_parser().parse_args(shlex.split(example.partition(' > ')[0]))
        headings = re.findall(r'^(\w.*):$', done.stdout, re.MULTILINE)
        assert headings == [heading for heading in HEADINGS if heading in headings]
    else:
        assert 'the output angle of any geared joint' in done.stdout.splitlines()[2]
        listed = re.findall(r'^  ([a-z][a-z-]+) {2,}\w', done.stdout, re.MULTILINE)
        assert sorted(listed) == sorted(COMMANDS)
        assert listed.index('record') < listed.index('calibrate') < listed.index('describe')


HEADINGS = (
    *('positional arguments', 'options', 'recording', 'motion', 'turn of a ring gear'),
    *('stiffness', 'gear', 'columns of a table', 'limits', 'several recordings'),
    *('output', 'example'),
)
"""Headings in the help of all commands, in this order."""


def test_init_replaces_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'actuator.yaml').write_text('mine')
    assert refusal('init') == 'actuator.yaml: exists already; give another name with -o'
    Path('link').symlink_to('nothing')
    told = refusal('init', '-o', 'link', '--actuator', 'elbow')
    assert told == 'link: exists already; give another name with -o'
    assert (tmp_path / 'actuator.yaml').read_text() == 'mine'
