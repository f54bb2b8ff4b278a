# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin calibrate as a user runs it."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from blocked_bags import refusal
from gear_recordings import Samples, write_csv, write_recording
from lxml import html
from simulated_gear import GearSet, gears, simulate, strokes

from gear_kinematics.commands.cli import main
from gear_kinematics.correction.calibration_file import Calibration


@pytest.fixture(scope='module')
def simulated_pair():
    """Give two recordings of a gear."""
    random = np.random.default_rng(2)
    setting = GearSet(1)
    gear = gears(setting, random)
    return [simulate(setting, gear, strokes(25.0, random), random) for _ in range(2)]


@pytest.fixture(scope='module')
def simulated(simulated_pair):
    return simulated_pair[0]


def csv_of(path, simulated, output=None):
    return write_csv(
        path,
        time_ms=1e3 * simulated.time,
        rotor_deg=np.degrees(simulated.rotor[:, 0]),
        output_deg=np.degrees(simulated.measured[:, 0] if output is None else output),
        torque=-19.0 * simulated.effort[:, 0],
    )


@pytest.fixture(scope='module')
def recording(simulated, tmp_path_factory):
    return csv_of(tmp_path_factory.mktemp('csv') / 'gear.csv', simulated)


@pytest.fixture(scope='module')
def calibrated(recording, tmp_path_factory):
    """The calibration by that recording."""
    target = tmp_path_factory.mktemp('calibrated') / 'calibration.yaml'
    assert main(['calibrate', str(recording), '-o', str(target)]) == 0
    return target


@pytest.fixture(scope='module')
def noise(tmp_path_factory):
    random = np.random.default_rng(4)
    ideal = strokes(20.0, random)
    measured = ideal + 1e-3 * random.standard_normal(len(ideal))
    path = tmp_path_factory.mktemp('csv') / 'noise.csv'
    return write_csv(path, rotor=-19.0 * ideal, output=measured)


def test_file_and_reports_are_written_in_the_place_of_a_calibration(recording, tmp_path, capsys):
    target, page = tmp_path / 'calibration.yaml', tmp_path / 'report.html'
    target.write_text('schema: gear_kinematics/calibration/0\nbroken')
    report = tmp_path / 'report.json'
    forms = ['--json', str(report), '--html', str(page)]
    assert main(['calibrate', '-v', str(recording), '-o', str(target), *forms]) == 0
    calibration = Calibration.load(target)
    (source,) = calibration.recordings
    assert (source.name, source.samples) == ('gear.csv', 25_000)
    assert source.duration == pytest.approx(24.999)
    assert calibration.ring_teeth == 80
    assert calibration.spans.speed[0] < -1.0 < 1.0 < calibration.spans.speed[1]
    assert {'rotor × 1', 'teeth × 1'} <= {order.name for order in calibration.orders}
    assert calibration.validation.rms_after < 0.2 * calibration.validation.rms_before
    document = json.loads(report.read_text())
    assert document['schema'] == 'gear_kinematics/calibration_report'
    assert document['left_out']['rms_after'] == calibration.validation.rms_after
    assert {term['name'] for term in document['terms']} >= {'rotor × 1', 'teeth × 1'}
    told = capsys.readouterr().out
    assert 'likely cause: runout or out-of-roundness of the cams' in told
    assert 'verdict: passed' in told
    assert html.parse(page).xpath('//h1')


def test_nothing_is_written_that_does_not_help(noise, tmp_path, capsys):
    target = tmp_path / 'calibration.yaml'
    assert main(['calibrate', '-v', str(noise), '-o', str(target)]) == 1
    assert not target.exists()
    assert 'Nothing is written' in capsys.readouterr().out


@pytest.mark.slow
def test_calibration_is_judged_by_another_recording(calibrated, simulated_pair, tmp_path, capsys):
    second = csv_of(tmp_path / 'second.csv', simulated_pair[1])
    noise = float(simulated_pair[1].noise[0])  # what no calibration can predict
    report, page, made = tmp_path / 'report.json', tmp_path / 'page.html', calibrated.read_bytes()
    forms = ['--json', str(report), '--html', str(page), '--check', str(calibrated)]
    assert main(['calibrate', str(second), *forms]) == 0
    (judged,) = json.loads(report.read_text())['recordings']
    assert judged['holds']
    assert judged['rms_after'] < 1.1 * noise < 0.3 * judged['rms_before']
    assert 0.9 < judged['within_interval'] < 0.98
    assert judged['uncalibrated'] < 0.5
    told = capsys.readouterr().out
    assert re.search(r'The calibration holds: .* of the measured angles are within the 95 %', told)
    assert html.parse(page).xpath('//h1')
    assert calibrated.read_bytes() == made
    # The same gear, whose output shaft has become eccentric by 12 arcmin.
    other = tmp_path / 'other.yaml'
    calibration = Calibration.load(calibrated)
    lost = math.radians(12.0 / 60.0)
    orders = tuple(
        replace(o, cos=o.cos + lost) if o.name == 'output × 1' else o for o in calibration.orders
    )
    other.write_text(replace(calibration, orders=orders).text(), 'utf-8')
    assert main(['calibrate', str(second), '--check', str(other)]) == 1
    told = capsys.readouterr().out
    assert re.search(
        r'The calibration no longer holds: \d+\.\d % instead of 95 % lie within the interval; '
        r'what is left: 1[12]\.?\d*′ once per output turn\.',
        told,
    )


def test_bag_without_an_output_encoder_is_refused_in_one_line(tmp_path):
    stamps = 10**18 + np.arange(200) * 1_000_000
    path = write_recording(tmp_path / 'bag', Samples(stamps, np.linspace(0.0, 9.0, 200)))
    assert refusal('calibrate', path, '-o', tmp_path / 'c.yaml').endswith(
        'no output_encoder; name its topic with --encoder-topic; there are: /rotor_state'
    )


def test_a_table_without_an_output_gets_one_line(tmp_path):
    path = tmp_path / 'bad.csv'
    # Two times beside one encoder, as where each topic is in a table of its own, are no matter.
    path.write_text('log_time_ns,header.stamp,rotor,torque\n1,2e9,1,2\n2e9,4e9,1,2\n')
    line = refusal('calibrate', path, '-o', tmp_path / 'c.yaml')
    assert 'not both a rotor and an output, but rotor alone: give --rotor-column' in line


def test_recordings_that_cannot_be_read_are_all_told_and_do_not_stop_the_check(
    recording, calibrated, tmp_path, capsys
):
    target = tmp_path / 'calibration.yaml'
    bad = [tmp_path / 'a.csv', tmp_path / 'b.csv']
    for path in bad:
        path.write_text('rotor,output\n1,nan\n')
    words = ['calibrate', str(bad[0]), str(recording), str(bad[1])]
    error = 'no usable rows: none has numbers such as -12.5 in all of rotor, output'
    errors = ''.join(f'gearkin: {path}: {error}\n' for path in bad)
    assert main([*words, '-o', str(target)]) == 2
    assert capsys.readouterr() == ('', errors)
    assert not target.exists()
    assert main([*words, '--check', str(calibrated)]) == 2
    told = capsys.readouterr()
    assert ''.join(re.findall('gearkin: .*\n', told.err)) == errors
    assert 'of the measured angles are within the 95 % interval' in told.out


@pytest.mark.parametrize(
    ('name', 'said'),
    [
        ('one_corrupt_rotor_reading_calibrate', '1 reading that contradicts both neighbours'),
        ('output_slips_by_20_degrees', 'the output jumps by 20° against the rotor at 27.04 s'),
    ],
)
def test_readings_that_cannot_be_true_are_not_calibrated(
    shared_path, tmp_path, capsys, name, said
):
    target = tmp_path / 'calibration.yaml'
    path = shared_path(f'data/faults/{name}.csv')
    for command in ('commission', 'calibrate'):  # what is written last is the calibration
        target.unlink(missing_ok=True)
        assert main([command, str(path), '-o', str(target)]) == 0
        assert said in capsys.readouterr().err
    # By the same gear without a fault: ± 0.68 arcmin.
    assert 60.0 * math.degrees(Calibration.load(target).half_width) == pytest.approx(
        0.68, abs=0.02
    )
