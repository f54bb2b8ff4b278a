# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The example for ros2_control, held against what its packages do.

Neither runs here. What is written down of them is from joint_state_topic_hardware_interface 1.1.0,
hardware_interface 4.46 (Jazzy) and joint_state_broadcaster.
"""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible, qos_profile_sensor_data
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

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


class Hardware:
    """The state interfaces of the hardware, and how its `read` fills them from a message."""

    def __init__(self, control: ET.Element) -> None:
        self.joints = [joint.get('name') for joint in control.iterfind('joint')]
        self.states = {
            f'{joint.get("name")}/{interface.get("name")}': math.nan
            for joint in control.iterfind('joint')
            for interface in joint.iterfind('state_interface')
        }

    def read(self, message: JointState) -> None:
        for i, name in enumerate(message.name):
            if name not in self.joints:
                continue
            for interface in ('position', 'velocity', 'effort'):
                values = getattr(message, interface)
                if len(values) and math.isfinite(values[i]):  # at(i) throws if it is too short
                    if f'{name}/{interface}' not in self.states:
                        raise RuntimeError('The requested state interface not found')
                    self.states[f'{name}/{interface}'] = values[i]


@pytest.mark.parametrize('velocity', [None, 19.0])
@pytest.mark.parametrize('effort', [None, 0.5])
def test_hardware_takes_every_output(control, actuator, velocity, effort):
    sample = RotorSample(5, split_turns(-38.0), velocity, effort)
    [(_, data)] = StateMessages(actuator, **NAMES).encode(sample, [OUTPUT_STATE])
    hardware = Hardware(control)
    hardware.read(deserialize_message(data, JointState))
    expected = {
        'output_shaft/position': 2.0,
        'output_shaft/velocity': math.nan if velocity is None else -1.0,
        'output_shaft/effort': math.nan if effort is None else -9.5,
    }
    assert hardware.states == pytest.approx(expected, rel=1e-12, nan_ok=True)


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
    assert asked_for == Hardware(control).states.keys()
