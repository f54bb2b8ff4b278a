# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin mjcf: the file, what it refuses, and what it does without optional packages."""

import json
import sys
import xml.etree.ElementTree as ET

import pytest
from blocked_bags import gearkin_here, refusal
from calibrations import calibration

from gear_kinematics.parameters import default_config


def model(text: str) -> ET.Element:
    return ET.fromstring(text)  # noqa: S314, our own


def test_the_model_goes_to_stdout_or_a_file(tmp_path):
    pytest.importorskip('mapbox_earcut')
    done = gearkin_here('mjcf')
    assert (done.returncode, done.stderr) == (0, '')
    assert model(done.stdout).find('asset/mesh') is not None
    path = tmp_path / 'gear.xml'
    for _ in range(2):  # it replaces its own
        assert gearkin_here('mjcf', '-o', path).returncode == 0
    assert path.read_text('utf-8') == done.stdout
    arm = default_config().with_name('simulated_arm.yaml')
    elbow = gearkin_here('mjcf', '--config', arm, '--actuator', 'elbow')  # the same gear
    assert (elbow.stdout, elbow.stderr) == (done.stdout, '')
    assert 'choose one with --actuator' in refusal('mjcf', '--config', arm)


def test_other_files_are_kept(tmp_path):
    path = tmp_path / 'ramps.json'
    path.write_text('{"made_by": "gearkin lost-motion"}', 'utf-8')
    reason = refusal('mjcf', '--measured', path, '--output', path)
    assert reason == f'--output {path}: what is read is never replaced; name a file to write'
    path = tmp_path / 'gear.xml'
    path.write_text('<mujoco/>', 'utf-8')
    assert '--force replaces it' in refusal('mjcf', '--output', path)


def test_figures_are_taken_and_what_is_open_is_said(tmp_path):
    ranges = [{'low': 0.0, 'high': 1.0, 'value': 4000.0}]
    figures = {
        'friction': {'value': 0.2},
        'middle_line': {'angle': [-1e-3, 1e-3], 'load': [-4.0, 4.0], 'friction': [0.2, 0.2]},
        'stiffness': ranges,
    }
    report = tmp_path / 'ramps.json'
    data = {'made_by': 'gearkin lost-motion', 'recordings': [figures]}
    report.write_text(json.dumps(data), 'utf-8')
    calibrated = tmp_path / 'calibration.yaml'
    calibrated.write_text(calibration().text(), 'utf-8')
    done = gearkin_here('mjcf', '--measured', report, '--calibration', calibrated)
    assert done.returncode == 0
    assert done.stderr == (
        'gearkin: not in the reports: play of the flanks: 0.00029 rad, as configured; '
        'stiffness beyond 1 N·m: as below\n'
    )
    assert 'Not measured: play of the flanks: 0.00029 rad, as configured.' in done.stdout
    orders = model(done.stdout).findall('custom/numeric')
    assert [order.get('name') for order in orders][:2] == ['rotor × 1', 'rotor × 2']
    assert orders[1].get('data') == '2.0 0.0 0.0002'


def test_a_rigid_gear_is_refused():
    reason = refusal('mjcf', '--config', default_config())
    assert reason.startswith('branch_stiffness must be greater than 0')


WITHOUT_TEETH = (
    "gearkin: without teeth: mapbox_earcut is not installed: pip install 'gear_kinematics[twin]'\n"
)


@pytest.mark.parametrize(('package', 'says'), [('mujoco', ''), ('mapbox_earcut', WITHOUT_TEETH)])
def test_optional_packages_may_be_missing(package, says, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, 'gear_kinematics.twin.mujoco_model', raising=False)
    done = gearkin_here('mjcf')
    assert (done.returncode, done.stderr) == (0, says)
    assert model(done.stdout).find('worldbody/body/body') is not None


def test_a_model_that_mujoco_refuses_is_not_written(tmp_path, monkeypatch):
    pytest.importorskip('mujoco')
    monkeypatch.setattr(
        'gear_kinematics.commands.mjcf.mjcf', lambda *_, **__: '<mujoco><nonsense/>'
    )
    path = tmp_path / 'gear.xml'
    assert 'XML' in refusal('mjcf', '-o', path)
    assert not path.exists()
