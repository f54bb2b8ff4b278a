# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The examples do what they say."""

import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from blocked_bags import finished
from gear_recordings import record_both_encoders

EXAMPLES = Path(__file__).parents[2] / 'examples'
VALIDATING = EXAMPLES.parent / 'docs' / 'validating.md'
TOLD = {
    # 2.5 rad divided by -19; satellites on circles of the eccentricity, 1.1 mm.
    'output_and_poses': ['output: -7.5389°, by the ratio -19', 'satellite a: at ['],
    # A slide moves by the diameter of the circle of its satellite.
    'batch': ['slide of satellite a: 2.20 mm, up to '],
    # At 30°, by hand: 0.25 + 19 π/6 rad, 19 π²/6 rad/s, 38/19 N·m.
    'rotor_from_output': ['0.50 s: 10.1984 rad, 31.2537 rad/s, 2.00 N·m', 'e-16 rad'],
    'validate_recording': ['servo_point_to_point: what was published is right'],
    # Lines between the readings cross zero torque 1.557′ apart; one through them has 3778 N·m/rad.
    'torque_ramps': ['hysteresis 1.56′ ± ', 'backlash 1.', 'stiffness from 0.75 to 2.5 N·m: 37'],
    'calibration': ['mrad after; interval ± ', 'it holds'],
}


def run(name, *arguments, cwd):
    command = [sys.executable, EXAMPLES / f'{name}.py', *arguments]
    return finished(command, cwd=cwd, timeout=300.0)


def test_every_example_is_short_and_tested():
    files = {path.stem: path.read_text('utf-8') for path in EXAMPLES.glob('*.py')}
    assert files.keys() == {*TOLD, 'bench'}  # which test_first_hour.py runs
    assert all(len(text.splitlines()) <= 40 for text in files.values())


@pytest.mark.parametrize('name', TOLD)
def test_example_says_what_it_should(name, tmp_path):
    arguments = []
    if name == 'calibration':
        record_both_encoders(tmp_path, 'monday', 'tuesday')
        arguments = ['monday', 'tuesday', '-19']
    done = run(name, *arguments, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, '')
    for part in TOLD[name]:
        assert part in done.stdout


@pytest.mark.parametrize('name', ['bench', '../bags/record', *TOLD])
def test_an_example_answers_help(name, monkeypatch, capsys):
    program = str(EXAMPLES / f'{name}.py')
    monkeypatch.setattr('sys.argv', [program, '--help'])
    with pytest.raises(SystemExit) as left:
        runpy.run_path(program, run_name='__main__')
    said = capsys.readouterr()
    assert (left.value.code, said.err) == (0, '')
    assert said.out.startswith(f'usage: {Path(name).name}.py')


def test_a_mistyped_word_is_not_taken_as_the_name_of_a_file(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr('sys.argv', ['bench.py', 'weer'])
    service = SimpleNamespace(wait_for_service=lambda _: False)
    node = SimpleNamespace(create_client=lambda *_: service)
    monkeypatch.setattr('rclpy.init', lambda: None)
    monkeypatch.setattr('rclpy.create_node', lambda _: node)
    with pytest.raises(SystemExit, match='no gear_simulator that answers ~/weer is running'):
        runpy.run_path(str(EXAMPLES / 'bench.py'), run_name='__main__')
    assert not list(tmp_path.iterdir())


def test_the_documented_test_of_a_package_holds_its_recording_to_its_parameters(tmp_path):
    [source] = re.findall(
        r'```python\n(from gear_kinematics\.validation .*?)```',
        VALIDATING.read_text('utf-8'),
        re.DOTALL,
    )
    (tmp_path / 'test_recording.py').write_text(source, 'utf-8')
    shutil.copytree(EXAMPLES.parent / 'bags/servo_point_to_point', tmp_path / 'logs/monday')
    parameters = '/**: {ros__parameters: {ring_teeth: 84, satellite_teeth: 80}}'
    (tmp_path / 'actuator.yaml').write_text(parameters, 'utf-8')
    command = [sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', tmp_path]
    done = finished(command, cwd=tmp_path, timeout=300.0)
    assert done.returncode == 1, done.stdout
    assert 'it is that of ring_teeth 80, satellite_teeth 76' in done.stdout


def test_the_examples_of_the_library_run_and_one_of_them_plots(tmp_path):
    pytest.importorskip('matplotlib', reason='matplotlib is not installed')
    page = (EXAMPLES.parent / 'docs/api.md').read_text('utf-8')
    source = '\n'.join(re.findall(r'```python\n(.*?)```', page, re.DOTALL))
    check = (
        'assert s.poses.shape == (3, 4, 3) and r.velocity == -19.0 and f.rotor_torque.size == 3'
    )
    command = [sys.executable, '-c', f'{source}\n{check}']
    environment = {**os.environ, 'MPLBACKEND': 'agg'}
    subprocess.run(command, cwd=tmp_path, env=environment, check=True)
    assert (tmp_path / 'couplings.png').stat().st_size > 10_000


def test_a_wrong_recording_fails_the_example(tmp_path):
    other = tmp_path / 'other.yaml'
    other.write_text('/**: {ros__parameters: {ring_teeth: 84, satellite_teeth: 80}}', 'utf-8')
    bag = EXAMPLES.parent / 'bags' / 'servo_point_to_point'
    done = run('validate_recording', bag, other, cwd=tmp_path)
    assert done.returncode == 1
    assert 'AssertionError: ' in done.stderr
    assert 'ratio' in done.stderr
