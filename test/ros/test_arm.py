# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""An arm: one node for several gears, in the process of the test and over DDS."""

import math
from types import SimpleNamespace

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from live import LATCHED, PATIENT, SECOND, live_node, parameter, rotor_bytes, rotor_state, stamp_of
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

pytestmark = pytest.mark.live

ARM = {
    'actuators': ['shoulder', 'elbow'],
    'shoulder.rotor_joint': 'm1',
    'elbow.rotor_joint': 'm2',
    'elbow.gear_ratio': '-50',
    'input_timeout': 1000.0,
}
MILLISECOND = SECOND // 1000


@pytest.fixture
def sent(make, monkeypatch):
    """Return a function that creates an arm, and keeps the last message of each topic."""

    def start(**values):
        node, last = make('arm', **ARM | values), {}
        node._arm.choose(node._topics)
        monkeypatch.setattr(node, 'send', last.update)
        return SimpleNamespace(node=node, last=last)

    return start


def home(node, *names):
    return node._homing._answer(names or [*node._actuators], None, Trigger.Response())


def drive(node, stamp, velocity=0.0, **positions):
    velocities = [velocity] * len(positions)
    node._on_rotor_state(rotor_bytes(stamp, [*positions], [*positions.values()], velocities))


def zeros(node):
    return [node.get_parameter(f'{name}.rotor_zero').value for name in ('shoulder', 'elbow')]


def test_all_shafts_are_homed_or_none_and_each_is_told(sent, tmp_path):
    """19.9 rad of the rotor are -60.0° of a shoulder of -19, and -22.8° of an elbow of -50."""
    path = tmp_path / 'home.yaml'
    node = sent(home_file=str(path)).node
    nothing = 'shoulder, elbow: no valid rotor_state has come yet; check the driver'
    assert home(node).message == f'no shaft was homed: {nothing}'
    drive(node, MILLISECOND, m1=19.9, m2=19.9)
    drive(node, 2 * MILLISECOND, m1=19.9, m2=19.9, velocity=5.0)
    answer = home(node)
    assert not answer.success
    assert answer.message == (
        'no shaft was homed: shoulder: the shaft turns at 0.263 rad/s, elbow: the shaft turns at '
        '0.1 rad/s, faster than home_max_speed, 0.05 rad/s; stop it and home it again'
    )
    assert zeros(node) == [0.0, 0.0]
    drive(node, 3 * MILLISECOND, m1=19.9, m2=19.9)
    kept = f'(rotor_zero 19.900 rad, kept in {path})'
    assert home(node, 'elbow').message == (
        f'elbow: the shaft was at -22.8° and is now at 0.0° {kept}'
    )  # fmt: skip
    assert zeros(node) == [0.0, 19.9]
    assert zeros(sent(home_file=str(path)).node) == [0.0, 19.9]
    assert home(node).message == (
        f'shoulder: the shaft was at -60.0° and is now at 0.0° {kept}; '
        f'elbow: the shaft was at 0.0° and is now at 0.0° {kept}'
    )
    assert zeros(node) == zeros(sent(home_file=str(path)).node) == [19.9, 19.9]


def test_parameters_of_each_actuator_are_live_and_checked_together(sent):
    node = sent().node

    def change(**values):
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        result = node.set_parameters_atomically(parameters)
        return result.reason if not result.successful else ''

    joints = {'shoulder.rotor_joint': 'm2', 'elbow.rotor_joint': 'm1'}
    assert "rotor_joint 'm2' belongs to shoulder and elbow" in change(
        **dict([*joints.items()][:1])
    )
    assert change(**joints, **{'elbow.rotor_direction': -1}) == ''
    assert 'must be one of' in change(**{'elbow.rotor_encoder': 'wrong'})
    assert change(rotor_zero=1.0) == (
        'unknown parameter `rotor_zero`; did you mean `elbow.rotor_zero`? '
        'there are: elbow.rotor_zero, shoulder.rotor_zero'
    )
    drive(node, MILLISECOND, m1=50.0, m2=1.9)
    last = {name: each.state.input.last for name, each in node._actuators.items()}
    angles = {name: math.tau * turns + angle for name, (_, (turns, angle), *_) in last.items()}
    assert angles == {'shoulder': pytest.approx(1.9), 'elbow': pytest.approx(-50.0)}


def test_turns_are_referenced_when_those_of_all_are(sent):
    arm = sent(**{'elbow.rotor_encoder': 'single_turn'})
    drive(arm.node, MILLISECOND, m1=1.0)
    drive(arm.node, 2 * MILLISECOND, m1=1.0, m2=1.0)
    topics = 'shoulder/referenced', 'elbow/referenced', 'referenced'
    values = [deserialize_message(arm.last[topic], Bool).data for topic in topics]
    assert values == [True, False, False]
    assert home(arm.node, 'elbow').success
    drive(arm.node, 3 * MILLISECOND, m2=1.0)
    values = [deserialize_message(arm.last[topic], Bool).data for topic in topics]
    assert values == [True, True, True]
    arm.node._report()
    statuses = deserialize_message(arm.last['/diagnostics'], DiagnosticArray).status
    assert [each.name for each in statuses] == [
        f'arm/gear_state_publisher: {name}: rotor input' for name in ('shoulder', 'elbow')
    ]
    counts = [{pair.key: pair.value for pair in each.values} for each in statuses]
    assert [[each['published'], each['of others']] for each in counts] == [['2', '1'], ['2', '1']]


def test_node_publishes_one_message_of_all_joints_over_dds(tmp_path):
    arguments = [word for name, value in ARM.items() for word in parameter(name, value)]
    with live_node(tmp_path, *PATIENT, *arguments, body_poses='shoulder/body_poses') as live:
        peer = live.peer
        peer.listen(Bool, 'referenced', LATCHED)
        peer.connect(joint='m1')
        output, poses, joints = peer.answer(
            rotor_state(peer.stamp(), ['m2', 'm1'], [5.0, 1.9], effort=[math.nan, 0.5])
        )
        assert output.name == ['shoulder', 'elbow']
        assert list(output.position) == pytest.approx([-0.1, -0.1], rel=1e-14)
        assert not output.velocity
        assert output.effort[0] == pytest.approx(-9.5)
        assert math.isnan(output.effort[1])
        assert poses.header.frame_id == 'shoulder_stator'
        assert (joints.name[0], joints.name[-1]) == ('shoulder_rotor', 'shoulder')
        assert stamp_of(output) == stamp_of(poses) == stamp_of(joints)
        peer.wait_until(lambda: [m.data for m in peer.received['referenced']][-1:] == [True], 'it')
        assert set(peer.description().split('"')) >= {'shoulder_satellite_a', 'shoulder'}
        assert peer.set(**{'elbow.rotor_zero': 2.5}).successful
        assert peer.get('elbow.rotor_zero', 'shoulder.rotor_zero') == [2.5, 0.0]


def test_joints_that_messages_with_others_lack_are_logged_once(sent, capfd):
    node = sent(**{'elbow.rotor_joint': 'M2', 'input_timeout': 1.0}).node
    both = [{'m1': 0.0, 'm2': 0.0}] * 4
    messages = both + [{'m1': 0.0}] * 4 + both + [{'m3': 0.0}] * 4
    for number, positions in enumerate(messages, 1):
        drive(node, number * MILLISECOND, **positions)
        node._report()
        if number == 3:
            node.set_parameters([Parameter('elbow.rotor_joint', value='m2')])
    others = 'on /arm/rotor_state; other joints are still heard'
    said = [line for line in capfd.readouterr().err.splitlines() if ': no ' in line]
    assert [line.partition(']: ')[2] for line in said] == [
        "elbow: no joint 'M2' on /arm/rotor_state; did you mean `m2`? there are: m1, m2",
        f"elbow: no more messages of 'm2' {others}",
        f"shoulder, elbow: no more messages of 'm1', 'm2' {others}",
    ]
