# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin urdf --macro`, expanded by xacro, against `gearkin urdf`."""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import yaml
from blocked_bags import refusal
from links import pinocchio_configuration
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gear_kinematics.commands.cli import main
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.wire.cdr import JointStateTemplate

ROOT = Path(__file__).resolve().parents[2]
ARM = 'examples/two_joint_arm.urdf.xacro'


@pytest.fixture
def xacro(tmp_path, monkeypatch):
    """Give xacro, which finds the package as if this folder were installed."""
    module = pytest.importorskip('xacro', reason='xacro is not installed')
    packages = tmp_path / 'share/ament_index/resource_index/packages'
    packages.mkdir(parents=True)
    (packages / 'gear_kinematics').touch()
    (tmp_path / 'share/gear_kinematics').symlink_to(ROOT)
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(tmp_path))
    return module


def printed(capsys, *arguments) -> str:
    assert main(['urdf', *map(str, arguments)]) == 0
    return capsys.readouterr().out


def elements(robot: ET.Element) -> dict[tuple[str, str], str]:
    """Give links and joints, by tag and name, without the white space between their parts."""
    return {
        (each.tag, each.get('name')): ET.canonicalize(ET.tostring(each), strip_text=True)
        for each in robot
    }


def parsed(text: str) -> dict[tuple[str, str], str]:
    return elements(ET.fromstring(text))  # noqa: S314, our own


def write_arm(folder: Path, actuators: dict) -> Path:
    """Write the parameter file of an arm."""
    path = folder / 'arm.yaml'
    parameters = {'actuators': [*actuators], **actuators}
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': parameters}}), 'utf-8')
    return path


def expected(capsys, tmp_path, prefix: str, parameters: str = '', *options) -> dict:
    """Give what `gearkin urdf` prints with a frame_prefix."""
    config = tmp_path / 'prefixed.yaml'
    config.write_text(f'/**: {{ros__parameters: {{frame_prefix: "{prefix}"{parameters}}}}}\n')
    return parsed(printed(capsys, '--config', config, *options))


def test_installed_macro_is_that_of_the_default_actuator(capsys):
    installed = ROOT / 'urdf' / 'actuator.urdf.xacro'
    assert installed.read_text('utf-8') == printed(capsys, '--macro')


def test_arm_has_both_actuators_and_their_mounts(xacro, capsys, tmp_path):
    arm = parsed(xacro.process_file(str(ROOT / ARM)).toxml())
    mounts = {
        'shoulder_stator': ('base', '<origin rpy="0 0 0" xyz="0 0 0.1"></origin>'),
        'elbow_stator': (
            'shoulder_output_shaft',
            '<origin rpy="0 1.5708 0" xyz="0.25 0 0.2"></origin>',
        ),
    }
    for name, (parent, origin) in mounts.items():
        assert arm.pop(('joint', name)) == (
            f'<joint name="{name}" type="fixed"><parent link="{parent}"></parent>'
            f'<child link="{name}"></child>{origin}</joint>'
        )
    assert arm.pop(('link', 'base'))
    config = write_arm(tmp_path, {'shoulder': {}, 'elbow': {}})
    of_node = parsed(printed(capsys, '--config', config))
    assert {*of_node} - {*arm} == {('link', 'base'), *(('joint', name) for name in mounts)}
    assert all(of_node[each] == arm[each] for each in arm)
    for name in ('shoulder', 'elbow'):
        one = parsed(printed(capsys, '--config', config, '--actuator', name))
        assert one.items() < arm.items()


def test_joints_of_an_arm_have_the_names_of_its_messages(capsys, tmp_path):
    """A gear that is known by its ratio alone has no bodies."""
    of_wrist = {'gear_ratio': '-101', 'output_joint': 'hand'}
    of_elbow = {'branches': ['a'], 'output_joint': 'bend', 'ring_teeth': 61, 'satellite_teeth': 58}
    config = write_arm(tmp_path, {'shoulder': {}, 'wrist': of_wrist, 'elbow': of_elbow})
    assert main(['urdf', '--config', str(config)]) == 0
    text, said = capsys.readouterr()
    assert said == 'gearkin: without wrist: only the ratio of such a gear is known\n'
    bodies = 'rotor', 'satellite_a', 'oldham_a', 'satellite_b', 'oldham_b'
    names = {f'shoulder_{body}' for body in bodies} | {f'elbow_{body}' for body in bodies[:3]}
    joints = [name for kind, name in parsed(text) if kind == 'joint']
    assert {*joints} == {*names, 'shoulder', 'bend', 'shoulder_stator', 'elbow_stator'}
    assert len(joints) == text.count('<joint ')
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    model = pin.buildModelFromXML(text)
    assert {*model.names[1:]} == {*names, 'shoulder', 'bend'}
    placed = {f.name: f.placement.translation.tolist() for f in model.frames}
    assert placed['shoulder_stator'] == [0.0, 0.0, 0.0]
    # Beside each other: the ring gears have 80 teeth of 0.5 mm.
    assert placed['elbow_stator'] == pytest.approx([1.5 * 0.04, 0.0, 0.0])
    macro = printed(capsys, '--config', config, '--macro', '--actuator', 'elbow')
    assert '<joint name="${output_joint or \'bend\'}" type="continuous">' in macro
    assert 'choose it with --actuator: elbow, shoulder, wrist' in refusal(
        'urdf', '--config', config, '--macro'
    )
    config = write_arm(tmp_path, {'wrist': of_wrist})
    assert 'gear_ratio is -101: only the ratio' in refusal('urdf', '--config', config)


def transforms(pin, urdf: str, state: JointState) -> dict[str, tuple]:
    """Give parent and transform of each link on /tf and /tf_static.

    By the source of robot_state_publisher 3.3.3: a message of unequal lengths is ignored, a fixed
    joint is always published, and another one if the message names it, with the pose of KDL.
    """
    positions = dict(zip(state.name, state.position, strict=True))
    found = {}
    for joint in ET.fromstring(urdf).iterfind('joint'):  # noqa: S314, our own
        name, kind = joint.get('name'), joint.get('type')
        if kind == 'fixed' or name in positions:
            origin, axis = (
                {} if element is None else element.attrib
                for element in (joint.find('origin'), joint.find('axis'))
            )
            xyz, rpy, along = (
                np.array([float(each) for each in text.split()])
                for text in (
                    *(origin.get(part, '0 0 0') for part in ('xyz', 'rpy')),
                    axis.get('xyz', '1 0 0'),
                )
            )
            position = positions.get(name, 0.0)
            slides = kind == 'prismatic'
            moved = pin.SE3(pin.exp3((not slides) * position * along), slides * position * along)
            child = joint.find('child').get('link')
            pose = pin.SE3(pin.rpy.rpyToMatrix(*rpy), xyz) * moved
            found[child] = joint.find('parent').get('link'), pose
    return found


def test_output_state_of_the_node_moves_the_arm(xacro, tmp_path):
    """By robot_state_publisher from one message, and by Pinocchio from its joints."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    text = xacro.process_file(str(ROOT / ARM)).toxml()
    model = pin.buildModelFromXML(text)
    assert len(model.names) - 1 == 2 * 6  # joints that turn or slide, all of them in one tree
    data = model.createData()
    gears = {name: {'rotor_joint': f'{name}_motor'} for name in ('shoulder', 'elbow')}
    actuators = load_actuators(write_arm(tmp_path, gears))
    arm = ArmState({name: GearState(each) for name, each in actuators.items()})
    arm.choose(['output_state', 'mechanism_joint_states'])
    rotors = JointStateTemplate(['shoulder_motor', 'elbow_motor'], velocity=False, effort=False)
    answered, _ = arm.rotor(rotors.encode(5, [19.0 * 0.3, -19.0 * 1.1]), lambda: 5)
    states = {topic: deserialize_message(m, JointState) for topic, m in arm.encode(answered)}
    state = states['output_state']
    outputs = dict(zip(state.name, state.position, strict=True))
    assert outputs == pytest.approx({'shoulder': -0.3, 'elbow': 1.1}, abs=1e-12)
    still = dict.fromkeys(model.names[1:], 0.0)
    pin.framesForwardKinematics(model, data, pinocchio_configuration(model, still | outputs))
    tip = data.oMf[model.getFrameId('elbow_output_shaft')]
    cosine, sine = math.cos(-0.3), math.sin(-0.3)
    np.testing.assert_allclose(
        tip.translation, [0.25 * cosine, 0.25 * sine, 0.3], rtol=0.0, atol=1e-12
    )
    # The elbow's axis is that of the shoulder's x, within the 1.5708 rad of the example.
    np.testing.assert_allclose(tip.rotation[:, 2], [cosine, sine, 0.0], rtol=0.0, atol=1e-5)
    # Turned by 1.1 rad about it, x of the tip is off the downward direction by as much.
    np.testing.assert_allclose(tip.rotation[2, 0], -math.cos(1.1), rtol=0.0, atol=1e-5)

    moving = transforms(pin, text, state)
    assert {*moving} == {f'{name}_{link}' for name in gears for link in ('stator', 'output_shaft')}
    parent, pose = moving['elbow_output_shaft']
    while parent != 'base':
        parent, before = moving[parent]
        pose = before * pose
    np.testing.assert_allclose(pose.homogeneous, tip.homogeneous, rtol=0.0, atol=1e-12)
    every = {link.get('name') for link in ET.fromstring(text).iterfind('link')}  # noqa: S314
    assert {*transforms(pin, text, states['mechanism_joint_states'])} == every - {'base'}


@pytest.mark.parametrize('prefix', ['', 'left_'])
def test_macro_of_another_gear_with_its_meshes(xacro, capsys, tmp_path, prefix):
    """Three branches, another name of the output's joint, and meshes in a folder with a space."""
    pytest.importorskip('mapbox_earcut', reason='mapbox_earcut is not installed')
    parameters = ', ring_teeth: 61, satellite_teeth: 58, branches: [a, b, c], output_joint: wrist'
    options = '--meshes', tmp_path / 'my meshes'
    wanted = expected(capsys, tmp_path, prefix, parameters, *options)
    macro = printed(capsys, '--config', tmp_path / 'prefixed.yaml', '--macro', *options)
    named = f' prefix="{prefix}"' if prefix else ''
    call = f'<xacro:gear_actuator parent="tool"{named}><origin/></xacro:gear_actuator>'
    (tmp_path / 'arm.xacro').write_text(macro.replace('</robot>', f'{call}</robot>'))
    found = parsed(xacro.process_file(str(tmp_path / 'arm.xacro')).toxml())
    assert found.pop(('joint', f'{prefix}stator'))
    assert found == wanted
    assert ('joint', f'{prefix}wrist') in found
    assert (tmp_path / 'my meshes').as_uri() in found['link', f'{prefix}satellite_c']
