# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin urdf --macro`, expanded by xacro, against `gearkin urdf`."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from gear_kinematics.commands.cli import main

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
    assert arm == (expected(capsys, tmp_path, 'shoulder_') | expected(capsys, tmp_path, 'elbow_'))


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


def test_arm_is_a_urdf_of_one_tree(xacro):
    """As Pinocchio reads it: eight joints turn or slide, all of them below the base."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    model = pin.buildModelFromXML(xacro.process_file(str(ROOT / ARM)).toxml())
    assert model.njoints - 1 == 2 * 6
    assert {str(model.names[j]).split('_')[0] for j in range(1, model.njoints)} == {
        'shoulder',
        'elbow',
    }
