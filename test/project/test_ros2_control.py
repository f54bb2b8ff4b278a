# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The example for ros2_control, held against what its packages do.

Neither runs here. What is written down of them is from joint_state_topic_hardware_interface 1.1.0,
hardware_interface 4.46 (Jazzy) and joint_state_broadcaster.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible, qos_profile_sensor_data
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from wire import encoded

from gear_kinematics.kinematics import RotorSample, split_turns
from gear_kinematics.parameters import default_value
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.shape.urdf import urdf
from gear_kinematics.state.state_messages import StateMessages
from gear_kinematics.wire.topics import OUTPUT_STATE, TOPICS

pytestmark = pytest.mark.live  # imports ROS

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / 'config/ros2_control'
NAMES = {name: default_value(name) for name in ('output_joint', 'frame_prefix')}
PLUGIN = 'joint_state_topic_hardware_interface/JointStateTopicSystem'


@pytest.fixture(scope='module')
def control() -> ET.Element:
    return ET.parse(FOLDER / 'output_shaft.xml').getroot()  # noqa: S314, the project's own file


def states_of(control: ET.Element) -> set[str]:
    """The state interfaces of the hardware; it throws on a finite value of any other."""
    return {
        f'{joint.get("name")}/{interface.get("name")}'
        for joint in control.iterfind('joint')
        for interface in joint.iterfind('state_interface')
    }


def test_hardware_has_a_place_for_every_field_of_the_output(control, actuator):
    sample = RotorSample(5, split_turns(-38.0), 19.0, 0.5)
    [data] = encoded(StateMessages(actuator, **NAMES), sample, [OUTPUT_STATE]).values()
    message = deserialize_message(data, JointState)
    fields = [
        field for field in ('position', 'velocity', 'effort') if len(getattr(message, field))
    ]
    assert {f'{name}/{field}' for name in message.name for field in fields} == states_of(control)


def test_hardware_is_described_by_its_own_names(control):
    assert control.findtext('hardware/plugin') == PLUGIN
    parameters = {p.get('name'): p.text for p in control.iterfind('hardware/param')}
    # Without a threshold and without a command interface, no command is sent.
    assert parameters.keys() == {'joint_commands_topic', 'joint_states_topic'}
    assert parameters['joint_states_topic'].removeprefix('/') == OUTPUT_STATE
    assert parameters['joint_commands_topic'].removeprefix('/') not in TOPICS
    assert [*control.iter('command_interface')] == []


def test_joint_is_in_the_urdf_and_the_parsers_accept_the_element(control, actuator):
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    robot = ET.fromstring(urdf(actuator, module=0.0005, **NAMES))  # noqa: S314, our own
    assert {joint.get('name') for joint in control.iterfind('joint')} <= {
        joint.get('name') for joint in robot.iterfind('joint')
    }
    robot.append(control)
    model = pin.buildModelFromXML(ET.tostring(robot, encoding='unicode'))
    assert model.existJointName('output_shaft')


def test_outputs_satisfy_the_quality_of_service_of_the_hardware():
    compatibility, reason = qos_check_compatible(QoSProfile(depth=DEPTH), qos_profile_sensor_data)
    assert compatibility != QoSCompatibility.ERROR, reason


def test_controllers_broadcast_what_the_hardware_has(control):
    controllers = yaml.safe_load((FOLDER / 'controllers.yaml').read_text('utf-8'))
    name = 'joint_state_broadcaster'
    assert controllers['controller_manager']['ros__parameters'][name] == {
        'type': f'{name}/JointStateBroadcaster'
    }
    broadcaster = controllers[name]['ros__parameters']
    asked_for = {
        f'{joint}/{interface}'
        for joint in broadcaster['joints']
        for interface in broadcaster['interfaces']
    }
    assert asked_for == states_of(control)
