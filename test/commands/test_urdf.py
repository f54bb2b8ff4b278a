# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin urdf`: the URDF and its meshes."""

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from blocked_bags import refusal

from gear_kinematics.commands.cli import main

ROOT = Path(__file__).resolve().parents[2]
FILES = {'ring_gear.stl', 'satellite.stl', 'cam.stl', 'coupling.stl', 'arm.stl'}


@pytest.fixture(autouse=True)
def _earcut(request):
    if 'without' not in request.node.name:
        pytest.importorskip('mapbox_earcut', reason='mapbox_earcut is not installed')


def mesh_names(text: str) -> set[str]:
    robot = ET.fromstring(text)  # noqa: S314, our own
    return {mesh.get('filename') for mesh in robot.iterfind('link/visual/geometry/mesh')}


def test_meshes_are_written_and_named(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(['urdf', '--meshes', 'my robot/meshes']) == 0
    folder = tmp_path / 'my robot/meshes'
    assert {path.name for path in folder.iterdir()} == FILES
    names = mesh_names(capsys.readouterr().out)
    assert all(name.startswith('file:///') and ' ' not in name for name in names)
    assert {Path(unquote(urlsplit(name).path)) for name in names} == set(folder.iterdir())


def test_meshes_of_an_arm_are_in_a_folder_for_each_actuator(capsys, tmp_path):
    config = ROOT / 'config/simulated_arm.yaml'
    assert main(['urdf', '--config', str(config), '--meshes', str(tmp_path)]) == 0
    written = {(path.parent.name, path.name) for path in tmp_path.rglob('*.stl')}
    assert written == {(name, file) for name in ('shoulder', 'elbow') for file in FILES}
    assert mesh_names(capsys.readouterr().out) == {
        path.as_uri() for path in tmp_path.rglob('*.stl')
    }


def test_meshes_of_the_default_are_the_installed_ones(capsys):
    assert main(['urdf']) == 0
    prefix = 'package://gear_kinematics/meshes/80_76_0_0011_0_0005/'
    assert mesh_names(capsys.readouterr().out) == {prefix + name for name in FILES}


def test_uri_can_be_that_of_another_package(capsys, tmp_path):
    config = tmp_path / 'my.yaml'
    config.write_text(
        '/**:\n  ros__parameters: {ring_teeth: 61, satellite_teeth: 58, eccentricity: 0.001,\n'
        '    meshes: "package://from_file/meshes"}\n'
    )
    words = ['urdf', '--config', str(config)]
    for options in ([], ['--meshes', str(tmp_path / 'm')]):
        assert main([*words, *options]) == 0
        names = mesh_names(capsys.readouterr().out)
        assert names == {f'package://from_file/meshes/{name}' for name in FILES}
    assert {path.name for path in (tmp_path / 'm').iterdir()} == FILES


def test_own_meshes_are_replaced_and_no_others(capsys, tmp_path):
    assert main(['urdf', '--meshes', str(tmp_path)]) == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    (tmp_path / 'cam.stl').write_bytes(before['cam.stl'][:100])
    assert main(['urdf', '--meshes', str(tmp_path)]) == 0
    assert before == {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    capsys.readouterr()
    for path in tmp_path.iterdir():
        path.unlink()
    (tmp_path / 'cam.stl').write_text('solid cam')
    error = f'{tmp_path}/cam.stl was not written by gearkin, and is not replaced'
    assert refusal('urdf', '--meshes', tmp_path) == error
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [
        ('cam.stl', 'solid cam')
    ]


def test_file_in_the_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / 'file').touch()
    for folder in (tmp_path / 'file', tmp_path / 'file/below'):
        error = refusal('urdf', '--meshes', folder)
        assert re.fullmatch(rf'{re.escape(str(tmp_path))}/file.*: .*', error)


def test_teeth_that_cannot_mesh_are_told_beside_the_urdf(capsys, tmp_path):
    config = tmp_path / 'my.yaml'
    config.write_text('/**:\n  ros__parameters: {eccentricity: 0.002}\n')
    assert main(['urdf', '--config', str(config), '--meshes', str(tmp_path / 'm')]) == 0
    captured = capsys.readouterr()
    assert mesh_names(captured.out)
    assert captured.err.startswith('gearkin: the gears are drawn as circles: ')


def test_urdf_without_meshes_needs_no_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'mapbox_earcut', None)
    assert main(['urdf']) == 0
    error = "mapbox_earcut is not installed: pip install 'gear_kinematics[mesh]'"
    assert refusal('urdf', '--meshes', tmp_path / 'm') == error
    assert not (tmp_path / 'm').exists()
