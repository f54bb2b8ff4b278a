# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin loads`: overloads are found to the sample, and forces, spectrum and life by hand."""

import json
import math
from pathlib import Path

import made_bags
import numpy as np
import pytest

from gear_kinematics.commands.cli import main
from gear_kinematics.measurement.loads.analysis import spectrum
from gear_kinematics.wire.batches import encode
from gear_kinematics.wire.cdr import JointStateTemplate

START = 1_700_000_000_000_000_000  # ns
SPEED = 100.0  # rad/s of the rotor
RADIUS = 0.0011 * 76 / 4  # m: rs = e zs/(zk - zs)
OVERLOADS = [(4000, 300, 0.5), (9000, 1, -0.45), (15000, 497, 0.48)]
"""First sample, number of samples and rotor effort, N·m, of which 0.315 is the most."""


def record(folder: Path, *, effort: bool = True, overloads=OVERLOADS) -> Path:
    """Record 20 s at 1 kHz, at ±0.1 N·m of the rotor but for the overloads."""
    count = 20_000
    torque = 0.1 * np.sin(np.arange(count) * math.tau / 2000.0)
    for first, samples, value in overloads:
        torque[first : first + samples] = value
    stamps = START + np.arange(count) * 1_000_000
    template = JointStateTemplate(['rotor'], velocity=True, effort=effort)
    arrays = [SPEED * np.arange(count) * 1e-3], [SPEED], [torque]
    messages = encode(template, stamps, *arrays[: 2 + effort])
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


def test_overloads_are_found_to_the_sample(tmp_path, config, capsys):
    code, found = report(capsys, record(tmp_path), '--config', config)
    assert code == 1
    moments = [
        (moment['sample'], round(1000 * moment['duration']), moment['branch'])
        for moment in found['moments']
    ]
    # i = -19: a positive effort of the rotor makes the output push backward, which B does.
    assert moments == [(4000, 300, 'a'), (9000, 1, 'b'), (15000, 497, 'a')]
    assert [moment['stamp'] for moment in found['moments']] == [
        START + first * 1_000_000 for first, *_ in OVERLOADS
    ]
    assert found['needed_preload'] == pytest.approx(19 * 0.5 / 2)
    assert found['answer'].startswith(
        'In 20 s both branches were in mesh but for 3 moments (0.798 s), the first at 4.000 s; '
        'the least preload that would have held: 4.75 N·m (set: 3)'
    )


def test_forces_of_a_recording_without_overloads_by_hand(tmp_path, config, capsys):
    code, found = report(capsys, record(tmp_path, overloads=()), '--config', config)
    assert code == 0
    assert not found['moments']
    torque = 3.0 + 0.95 * np.sin(np.arange(20_000) * math.tau / 2000.0)
    for branch in 'ab':
        forces = found['forces'][f'mesh_{branch}'], found['forces'][f'cam_{branch}']
        for force in forces:
            assert force['greatest'] == pytest.approx(3.95 / RADIUS, rel=1e-6)
            assert force['mean'] == pytest.approx(3.0 / RADIUS, rel=1e-6)
            cubic = np.mean(torque[1:] ** 3) ** (1 / 3) / RADIUS
            assert force['cubic_mean'] == pytest.approx(cubic, rel=1e-5)
            # Ten periods of one range: nine full cycles, and the rest from the mean and back.
            sizes = [cycle['range'] for cycle in force['cycles']]
            assert sizes[0] == pytest.approx(1.9 / RADIUS, rel=0.02)
            assert found['forces'][f'slot_{branch}']['greatest'] == pytest.approx(3.95, rel=1e-6)
    full = sum(c['count'] for c in forces[0]['cycles'] if c['range'] > 1.8 / RADIUS)
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


def test_slots_lose_what_the_worked_example_says(tmp_path, config, capsys):
    """μ (4/π) zk/zs of the power of the couples, which the preload keeps up without load."""
    bag = record(tmp_path, overloads=())
    _, found = report(capsys, bag, '--config', config, '--slot-friction', '0.1')
    couples, work = 2 * 3.0, np.mean(np.abs(1.9 * np.sin(np.arange(2000) * math.tau / 2000)))
    expected = 0.1 * 4 / math.pi * 80 / 76 * couples / work
    assert found['slot_loss'] == pytest.approx(expected, rel=0.02)


def test_without_a_preload_only_the_forces_are_told(tmp_path, capsys):
    code, found = report(capsys, record(tmp_path))
    assert code == 0
    assert found['needed_preload'] is None
    assert 'nothing is known of the mesh' in found['answer']
    assert found['forces']['mesh_a']['greatest'] == pytest.approx(9.5 / 2 / RADIUS, rel=1e-6)


def test_without_effort_there_is_one_clear_error(tmp_path, config, capsys):
    bag = record(tmp_path, effort=False)
    assert main(['loads', str(bag), '--config', str(config)]) == 2
    captured = capsys.readouterr()
    assert not captured.out
    assert captured.err == (
        f'gearkin: {bag}: the loads need the effort of the rotor, which /rotor_state lacks\n'
    )


def test_several_recordings_are_computed_in_processes(tmp_path, config, capsys):
    folders = tmp_path / 'first', tmp_path / 'second'
    for folder in folders:
        folder.mkdir()
    bags = record(folders[0]), record(folders[1], overloads=())
    code = main(['loads', *map(str, bags), '--config', str(config), '--jobs', '2', '--quiet'])
    assert code == 1
    assert 'but for 3 moments' in capsys.readouterr().out


def test_spectrum_of_the_example_of_astm_e1049():
    """ASTM E1049-85, figure 6: ranges 3 (0.5), 4 (1.5), 6 (0.5), 8 (1.0), 9 (0.5)."""
    values = np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2])
    found = {round(size): count for size, count in spectrum(values)}
    assert found == {9: 0.5, 8: 1.0, 6: 0.5, 4: 1.5, 3: 0.5}
