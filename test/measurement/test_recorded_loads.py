# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin loads`: overloads are found to the sample, and forces, spectrum and life by hand."""

import json
import math
import re
import shlex
from pathlib import Path

import made_bags
import numpy as np
import pytest
from blocked_bags import refusal

from gear_kinematics.commands.cli import main
from gear_kinematics.kinematics import Branch, Mechanism, solve
from gear_kinematics.measurement.loads.recorded import spectrum
from gear_kinematics.wire.batches import encode
from gear_kinematics.wire.cdr import JointStateTemplate

START = 1_700_000_000_000_000_000  # ns
SPEED = 100.0  # rad/s of the rotor
RADIUS = 0.0011 * 76 / 4  # m: rs = e zs/(zk - zs)
OVERLOADS = [(4000, 300, 0.5), (9000, 1, -0.45), (15000, 497, 0.48)]
"""First sample, number of samples and rotor effort, N·m, of which 0.315 is the most."""


TIME = np.arange(20_000) * 1e-3  # s


def record(folder: Path, *, effort: bool = True, overloads=OVERLOADS, period=2.0) -> Path:
    """Record 20 s at 1 kHz, at ±0.1 N·m of the rotor in each period, s, but for the overloads."""
    count = len(TIME)
    torque = 0.1 * np.sin(TIME * math.tau / period)
    for first, samples, value in overloads:
        torque[first : first + samples] = value
    stamps = START + np.arange(count) * 1_000_000
    template = JointStateTemplate(['rotor'], velocity=True, effort=effort)
    numbers = SPEED * TIME, SPEED, torque
    messages = encode(template, stamps, numbers[: 2 + effort])
    rows = zip(stamps.tolist(), messages, strict=True)
    return made_bags.folder(
        folder / 'recorded', [('/rotor_state', stamp, data) for stamp, data in rows], 'mcap'
    )


@pytest.fixture
def config(tmp_path) -> Path:
    """A preload of 3 N·m of equal branches: they stay in mesh below 6 N·m, 0.316 at the rotor."""
    path = tmp_path / 'braced.yaml'
    values = 'preload: 3.0, branch_stiffness: [2000.0]'
    path.write_text(f"'/**': {{ros__parameters: {{{values}}}}}", encoding='utf-8')
    return path


def report(capsys, *arguments) -> tuple[int, dict]:
    code = main(['loads', *map(str, arguments), '--json', '-'])
    return code, json.loads(capsys.readouterr().out)['recordings'][0]


def table(folder: Path) -> Path:
    """Write what `record` does, in other units."""
    bag, torque = record(folder), 100.0 * np.sin(TIME * math.tau / 2.0)  # mN·m
    for first, samples, value in OVERLOADS:
        torque[first : first + samples] = 1e3 * value
    rows = np.column_stack([START / 1e9 * 1e3 + 1e3 * TIME, np.degrees(SPEED * TIME), torque])
    head = 'ms;MotorPosition [deg];MotorTorque [mNm]'
    path = bag.with_name('r.csv')
    np.savetxt(path, rows, '%.6f', ';', header=head, comments='')
    return path


def bench(folder: Path) -> Path:
    """Write what `record` does as a bench measures it, which has a torque sensor at the output."""
    path = table(folder)
    time, degrees, torque = np.loadtxt(path, delimiter=';', skiprows=1).T
    rows = np.column_stack([time, degrees / -19.0, -19.0 * torque])
    np.savetxt(path, rows, '%.9f', ';', header='ms;output_deg;torque [mNm]', comments='')
    return path


@pytest.mark.parametrize('write', [record, table, bench])
def test_overloads_are_found_to_the_sample(tmp_path, config, capsys, write):
    code, found = report(capsys, write(tmp_path), '--config', config)
    assert code == 1
    moments = [
        (moment['stamp'] - START, round(1000 * moment['duration']), moment['branch'])
        for moment in found['moments']
    ]
    # i = -19: a positive effort of the rotor makes the output push backward, which B does.
    assert moments == [(4e9, 300, 'a'), (9e9, 1, 'b'), (15e9, 497, 'a')]
    assert found['needed_preload'] == pytest.approx(19 * 0.5 / 2)
    assert found['answer'].startswith(
        'A branch was out of mesh in 3 intervals, 0.798 s of 20 s, first at 4.000 s; the least '
        'preload that would have held: 4.75 N·m (set: 3); the ratio is -19, by the given '
    )


def test_loads_of_angles_that_cannot_be_rad_are_refused(tmp_path, config):
    path = table(tmp_path)
    path.write_text(
        path.read_text('utf-8').replace(' [deg]', '').replace('[mNm]', '[Nm]'), 'utf-8'
    )
    said = refusal('loads', path, '--config', config)
    assert 'as in degrees or beside times in another unit: give its unit with --angle-unit' in said


def test_the_command_line_that_is_proposed_for_an_output_works(tmp_path, config):
    path = table(tmp_path)
    head, *rows = path.read_text('utf-8').splitlines()
    counts = np.round(SPEED * TIME / -19.0 * 4096).astype(int)
    rows = [f'{row};{count}' for row, count in zip(rows, counts, strict=True)]
    path.write_text('\n'.join([f'{head};Output position', *rows]), 'utf-8')
    said = refusal('loads', path, '--config', config)
    command = said.split('for example: gearkin ')[1]
    assert '--output-column' in command
    assert main(shlex.split(command)) == 1


def test_moments_are_links_to_the_mechanism_with_its_forces(tmp_path, config):
    pytest.importorskip('plotly')
    page = tmp_path / 'loads.html'
    words = '--config', str(config), '--html', str(page), '--quiet'
    assert main(['loads', str(record(tmp_path)), *words]) == 1
    text = page.read_text('utf-8')
    times = re.findall(r'<a href="#figure-0" data-time="([\d.]+)">branch', text)
    assert [float(time) for time in times] == [4.0, 9.0, 15.0]
    assert len(re.findall('<use class="force"', text)) == 2
    (moving,) = re.findall(r'data-figure="figure-0">(\{.*?\})</script>', text)
    drawn = json.loads(moving)
    forces = np.array(drawn['forces'])
    # 0.5 N·m at the rotor: one branch gives all of 9.5 N·m, and the other nothing.
    at = drawn['time'].index(4.0)
    assert forces[:, at] == pytest.approx([0.0, -1.0])


def test_forces_of_a_recording_without_overloads_by_hand(tmp_path, config, capsys):
    code, found = report(capsys, record(tmp_path, overloads=()), '--config', config)
    assert code == 0
    assert not found['moments']
    torque = 3.0 + 0.95 * np.sin(TIME * math.tau / 2.0)
    for branch in 'ab':
        forces = found['forces'][f'mesh_{branch}'], found['forces'][f'cam_{branch}']
        for force in forces:
            assert force['greatest'] == pytest.approx(3.95 / RADIUS, rel=1e-6)
            assert force['mean'] == pytest.approx(3.0 / RADIUS, rel=1e-6)
            cubic = np.mean(torque[1:] ** 3) ** (1 / 3) / RADIUS
            assert force['cubic_mean'] == pytest.approx(cubic, rel=1e-5)
            # Ten periods of one range: nine full cycles, and the rest from the mean and back.
            assert force['cycles'][0][0] == pytest.approx(1.9 / RADIUS, rel=0.02)
            assert found['forces'][f'slot_{branch}']['greatest'] == pytest.approx(3.95, rel=1e-6)
    full = sum(count for size, count in forces[0]['cycles'] if size > 1.8 / RADIUS)
    assert full == pytest.approx(9.5)


def test_bearing_lives_as_iso_281_says(tmp_path, config, capsys):
    bag = record(tmp_path)
    _, found = report(capsys, bag, '--config', config, '--cam-rating', '3000')
    cam = found['forces']['cam_a']
    # The satellite turns on its cam at (1 + 1/19) of the rotor's speed.
    turns_per_hour = SPEED / math.tau * 20 / 19 * 3600
    hours = (3000 / cam['cubic_mean']) ** 3 * 1e6 / turns_per_hour
    assert cam['l10_hours'] == pytest.approx(hours, rel=1e-6)
    assert found['forces']['mesh_a']['l10_hours'] is None


def test_effort_that_is_0_throughout_the_motion_tells_no_loads(tmp_path, config, capsys):
    bag = record(tmp_path, overloads=(), period=math.inf)
    assert main(['loads', str(bag), '--config', str(config)]) == 2
    told = capsys.readouterr()
    assert told.out == ''
    assert 'the effort on /rotor_state is 0 throughout the motion' in told.err


@pytest.mark.parametrize(
    ('first', 'count', 'code'), [(8000, 4000, 1), (0, 4000, 1), (16_000, 4000, 1), (8000, 99, 0)]
)
def test_no_recording_passes_whose_loads_are_unknown_for_a_time(
    tmp_path, config, capsys, first, count, code
):
    bag = record(tmp_path, overloads=[(first, count, math.nan)])
    failed, found = report(capsys, bag, '--config', config)
    assert (failed, found['verdict']) == (code, 'fail' if code else 'pass')
    assert ('the loads are unknown for 4 s' in found['answer']) == bool(code)
    assert ('first before the first known load' in found['answer']) == (first == 0)
    assert found['left_out'] == {'effort missing': count}


def test_current_in_place_of_a_torque_is_questioned(shared_path, tmp_path, capsys):
    """±1000 mA; a factor of 0.05 N·m/A makes ±0.05 N·m of it, 0.95 at the output."""
    bag, config = shared_path('data/faults/effort_is_current_in_mA.mcap'), tmp_path / 'factor.yaml'
    assert main(['loads', str(bag)]) == 0
    assert 'efforts of up to 1000 N·m at the rotor are more' in capsys.readouterr().out
    config.write_text('/**: {ros__parameters: {rotor_effort_factor: 5e-5}}')
    _, found = report(capsys, bag, '--config', config)
    assert 'The output torque was at most 0.95 N·m in ' in found['answer']
    assert 'rotor_effort_factor' not in found['answer']


def test_bearing_without_load_has_no_life(tmp_path, capsys):
    bag = record(tmp_path, overloads=[(0, 1, 5e-324)], period=math.inf)
    code, found = report(capsys, bag, '--cam-rating', '3000')
    assert code == 0
    assert found['forces']['cam_a']['greatest'] < 1e-300
    assert found['forces']['cam_a']['l10_hours'] is None


def test_forces_over_the_angle_of_the_rotor(tmp_path, config, capsys):
    """With the torque a function of that angle: 277 samples in each of 72 bins."""
    bag = record(tmp_path, overloads=(), period=math.tau / SPEED)
    _, found = report(capsys, bag, '--config', config)
    edges = np.linspace(0.0, math.tau, 73)
    # i = -19: branch A, which pushes forward, is relieved by a positive effort of the rotor.
    at_edges = (3.0 - 0.95 * np.sin(edges)) / RADIUS
    low, high = np.sort([at_edges[:-1], at_edges[1:]], axis=0)
    greatest, most, mean = np.transpose(found['forces']['cam_a']['by_rotor_angle'])
    assert np.all((0.999 * low < mean) & (mean < greatest) & (most <= greatest))
    crest = np.abs(np.sin(edges[:-1])) < 0.95  # elsewhere the greatest is inside of the bin
    assert greatest[crest] == pytest.approx(high[crest], rel=1e-3)
    assert mean == pytest.approx((low + high) / 2, rel=2e-3)


def test_slots_lose_force_times_speed(tmp_path, config, capsys):
    """As the speeds of both slides say, from the motion of the mechanism."""
    bag = record(tmp_path, overloads=())
    _, found = report(capsys, bag, '--config', config, '--slot-friction', '0.1')
    state = solve(
        Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', math.pi))), SPEED * TIME, SPEED
    )
    speeds = np.abs(state.satellite_slide_velocity) + np.abs(state.arm_slide_velocity)
    load = 0.95 * np.sin(TIME * math.tau / 2.0)
    couples = np.stack([3.0 - load, 3.0 + load], axis=-1)
    lost = 0.1 * np.sum(couples / RADIUS * speeds)  # two forces 2 rs apart, at both slots
    work = np.sum(np.abs(2.0 * load * state.output_velocity))
    assert found['slot_loss'] == pytest.approx(lost / work, rel=1e-3)


def test_without_a_preload_only_the_forces_are_told(tmp_path, capsys):
    code, found = report(capsys, record(tmp_path))
    assert code == 0
    assert found['needed_preload'] is None
    assert 'nothing is known of the mesh' in found['answer']
    assert found['answer'].endswith('; the ratio is -19, by the default parameters.')
    assert found['forces']['mesh_a']['greatest'] == pytest.approx(9.5 / 2 / RADIUS, rel=1e-6)


def test_several_recordings_are_computed_in_processes(tmp_path, config, capsys):
    folders = tmp_path / 'first', tmp_path / 'second'
    for folder in folders:
        folder.mkdir()
    bags = record(folders[0]), record(folders[1], overloads=())
    code = main(['loads', *map(str, bags), '--config', str(config), '--jobs', '2', '--quiet'])
    assert code == 1
    assert 'out of mesh in 3 intervals' in capsys.readouterr().out


def test_spectrum_of_the_example_of_astm_e1049():
    """ASTM E1049-85, figure 6: ranges 3 (0.5), 4 (1.5), 6 (0.5), 8 (1.0), 9 (0.5)."""
    values = np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2])
    found = {round(size): count for size, count in spectrum(values)}
    assert found == {9: 0.5, 8: 1.0, 6: 0.5, 4: 1.5, 3: 0.5}
