# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The encoder at the output: simulated transmission errors are recovered."""

import math
from dataclasses import replace

import numpy as np
import pytest
from live import SECOND, START, rotor_bytes

from gear_kinematics.correction.calibration_fit import CalibrationFit
from gear_kinematics.correction.error_window import ErrorStatistics
from gear_kinematics.kinematics import RotorPosition, RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.diagnostics import OK, WARN, EncoderMonitor, InputMonitor
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.joint_reader import RejectedInputError

MS = SECOND // 1000
SETTINGS = replace(NodeParameters.load(), transmission_error_travel=0.01)
NOW = 50.0


class Bench:
    """Both encoders and the monitor."""

    def __init__(self, settings=SETTINGS) -> None:
        self.settings = settings
        self.rotor = RotorInput(settings)
        self.encoder = OutputEncoder(settings)
        self.monitor = EncoderMonitor()

    def turn(self, stamp, position):
        sample = self.rotor.accept(rotor_bytes(stamp, position=[position]), lambda: 0)
        return self.encoder.follow(sample)

    def measure(self, stamp, position, *, joint='shaft', now=0, at=NOW):
        self.monitor.last_input = at
        data = rotor_bytes(stamp, [joint], [position])
        return self.encoder.accept(data, lambda: now)

    def report(self, at=NOW, **changes):
        return self.monitor.report(self.encoder, replace(self.settings, **changes), at)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_error_of_a_gear_with_only_a_ratio_does_not_drift():
    bench = Bench(replace(SETTINGS, gear_ratio='1457/26'))
    whole = 1457 * 10**6  # turns of the rotor, in which the output makes whole turns too
    bench.encoder.follow(RotorSample(START, RotorPosition(whole, 0.0), None, None))
    bench.encoder.follow(RotorSample(START + 2 * MS, RotorPosition(whole, 0.2), None, None))
    [sample] = bench.measure(START + MS, 0.1 * 26 / 1457 + 1e-3)
    assert sample.error == pytest.approx(1e-3, abs=1e-15)


@pytest.mark.parametrize(('direction', 'zero'), [(1, 0.0), (-1, 0.0), (1, 2.5), (-1, -40.0)])
def test_error_is_the_measured_minus_the_ideal_angle(direction, zero):
    settings = replace(SETTINGS, output_encoder_direction=direction, output_encoder_zero=zero)
    bench = Bench(settings)
    found, put_in = [], []
    bench.measure(START - MS, 0.0)  # an encoder, but no rotor yet
    for k in range(2000):
        rotor = 0.3 * k
        found += bench.turn(START + k * MS, rotor)
        # A third of the way to the next rotor state, which is yet to come.
        error = 1e-3 * math.sin(0.01 * k)
        angle = -(rotor + 0.1) / 19.0 + error
        found += bench.measure(START + k * MS + MS // 3, zero + direction * angle)
        put_in.append(error)
    # A third of a millisecond is rounded by a third of a nanosecond: 0.3 rad / 19 / 3e6.
    assert [sample.stamp for sample in found] == [START + k * MS + MS // 3 for k in range(1999)]
    np.testing.assert_allclose([s.error for s in found], put_in[:-1], rtol=0, atol=1e-8)
    assert bench.encoder.comparison.matched == 1999
    assert bench.encoder.comparison.unmatched == {'no ideal angle before': 1}


def test_nothing_is_compared_across_a_gap(bench):
    bench.measure(START, 0.0)
    bench.turn(START, 0.0)
    assert len(bench.turn(START + 100 * MS, 0.0)) == 1
    assert len(bench.measure(START + 50 * MS, 0.0)) == 1
    assert len(bench.measure(START + 150 * MS, 0.0)) == 0
    assert len(bench.turn(START + 201 * MS, 0.0)) == 0
    assert bench.encoder.comparison.unmatched['gap of the ideal angle'] == 1


def test_joint_is_looked_up_by_its_name():
    bench = Bench(replace(SETTINGS, output_encoder_joint='shaft'))
    with pytest.raises(RejectedInputError, match='joint missing'):
        bench.measure(START, 0.0, joint='wheel')
    bench.turn(START, 0.0)
    [sample] = bench.measure(START, 0.25) or bench.turn(START + MS, 0.0)
    assert sample.error == pytest.approx(0.25)
    assert bench.encoder.received == 2
    assert bench.encoder.rejected == {'joint missing': 1}


# Diagnostics.


def swing(bench, amplitude, *, samples=400):
    """Move forward and backward, lagging by half the play in each direction."""
    for k in range(samples):
        angle = 0.2 * math.sin(k * math.tau / samples)
        behind = -amplitude if math.cos(k * math.tau / samples) > 0.0 else amplitude
        bench.measure(START + k * MS, angle + behind)
        bench.turn(START + k * MS, -19.0 * angle)


def test_report_has_the_figures_of_the_window(bench):
    swing(bench, 0.001)
    report = bench.report()
    assert (report.level, report.message) == (OK, 'ok')
    values = report.values
    assert float(values['peak to peak (rad)']) == pytest.approx(0.002, abs=1e-6)
    assert float(values['mean (rad)']) == pytest.approx(0.0, abs=2e-5)
    value, spread = map(float, values['lost motion (rad)'].split(' ± '))
    assert value == pytest.approx(0.002, abs=1e-6)
    assert 0.0 <= spread < 1e-6
    assert float(values['delay of output_encoder (s)'].split(' ± ')[0]) == pytest.approx(
        0, abs=1e-6
    )
    assert values['received'] == '400'
    assert values['samples'] == values['compared'] == '400'
    assert not any(key.startswith(('rejected', 'not compared')) for key in values)
    bench.measure(START + 400 * MS, 0.001)
    bench.turn(START + 400 * MS, 0.0)
    report = bench.report(transmission_error_limit=0.0019)
    assert (report.level, report.message) == (WARN, 'peak to peak 0.002 rad')


@pytest.mark.parametrize(('off', 'advised'), [(0.0, 'raise transmis'), (2.9, 'call ~/home')])
def test_only_an_error_of_a_gear_suggests_another_limit(bench, off, advised):
    for k in range(2):
        bench.measure(START + k * MS, off + 0.01 * k)
        bench.turn(START + k * MS, 0.0)
    report = bench.report()
    assert (report.level, report.message) == (WARN, 'peak to peak 0.01 rad')
    assert advised in report.values['advice']
    assert ('raise' in report.values['advice']) == (off == 0.0)


@pytest.mark.parametrize('before', [True, False], ids=['after a report', 'at once'])
def test_silence_is_a_warning_and_leaves_no_figures(bench, before):
    assert bench.report() is None
    swing(bench, 0.001)
    if before:
        bench.report()
    report = bench.report(NOW + 2.5)
    assert (report.level, report.message) == (WARN, 'no output_encoder for 2.5 s')
    assert report.values['samples'] == '0'
    assert report.values['mean (rad)'] == report.values['lost motion (rad)'] == 'none'


def test_encoder_whose_stamps_are_not_the_rotors_is_a_warning(bench):
    bench.turn(START, 0.0)
    for k in range(3):
        bench.measure(START - 5 * SECOND + k * MS, 0.0)
        bench.turn(START + k * MS, 0.0)
    report = bench.report()
    assert (report.level, report.message) == (WARN, 'no rotor angle of the same time')
    assert report.values['not compared: no ideal angle before'] == '3'


@pytest.mark.parametrize(('explained', 'fits'), [(0.4, False), (0.999, True)])
def test_calibration_that_no_longer_fits_is_a_warning(bench, monkeypatch, explained, fits):
    swing(bench, 0.001)
    fit = CalibrationFit(400, explained, 0.25, fits, 40.0)
    statistics = ErrorStatistics(calibration=fit)
    monkeypatch.setattr(bench.encoder.window, 'statistics', lambda: statistics)
    report = bench.report()
    expected = (OK, 'ok') if fits else (WARN, 'calibration no longer fits')
    assert (report.level, report.message) == expected
    assert report.values['explained by the calibration (%)'] == f'{100 * explained:.1f}'
    assert report.values['outside the interval (%)'] == '25.0'


def test_change_of_a_parameter_loses_no_count(bench):
    swing(bench, 0.001)
    with pytest.raises(RejectedInputError):
        bench.measure(START + 399 * MS, math.nan)
    assert bench.report().message == 'rejected: position not finite 1'
    bench.settings = replace(SETTINGS, transmission_error_window=5.0)
    bench.encoder.configure(bench.settings)
    with pytest.raises(RejectedInputError):
        bench.measure(START + 399 * MS, math.nan)
    for k in range(400, 800):  # as many as before
        bench.measure(START + k * MS, 0.0)
        bench.turn(START + k * MS, 0.0)
    report = bench.report()
    assert report.message == 'rejected: position not finite 1'
    assert report.values['compared'] == '800'
    assert report.values['rejected: position not finite'] == '2'


# Slips.


def rest(bench, start, count, error, *, speed=0.0):
    """Send both encoders with a constant error at the output, which turns at a speed, rad/s."""
    for k in range(start, start + count):
        angle = 1e-3 * speed * k
        bench.measure(START + k * MS, angle + error)
        bench.turn(START + k * MS, -19.0 * angle)


@pytest.mark.parametrize('speed', [0.0, 2.0])
@pytest.mark.parametrize('degrees', [20.0, -20.0, 0.5])
def test_slip_stays_a_warning_after_the_window_has_passed(degrees, speed):
    bench = Bench(replace(SETTINGS, transmission_error_window=0.1))
    rest(bench, 0, 500, 0.0, speed=speed)
    assert bench.report().message == ('ok' if speed else 'direction not checked')
    rest(bench, 500, 5000, math.radians(degrees), speed=speed)
    for more in range(5500, 7500, 500):
        report = bench.report()
        when = (START + 500 * MS) / SECOND
        assert report.level == WARN
        assert report.message == (
            f'the output has slipped by {degrees:.2f}° against the rotor, at {when:.3f} s'
        )
        rest(bench, more, 500, math.radians(degrees), speed=speed)


@pytest.mark.parametrize('sense', [1, -1])
def test_direction_is_checked_by_a_motion_alone(sense):
    """The wrong way round, the error grows by twice the travel."""
    bench = Bench(SETTINGS)
    for k in range(3000):
        angle = 0.05 * max(0.0, k - 1000) / 1000
        bench.measure(START + k * MS, sense * angle)
        bench.turn(START + k * MS, -19.0 * angle)
        if k in {999, 2999}:
            values = bench.report().values
            assert values['direction checked'] == ('yes' if sense > 0 and k > 1000 else 'no')
    bench.encoder.configure(replace(SETTINGS, output_encoder_direction=-1))
    assert not bench.encoder.direction_checked


def test_single_wrong_readings_and_errors_within_the_limit_are_no_slip(bench):
    for k in range(5000):
        error = 0.0015 * math.sin(0.01 * k) if k % 50 else 1.0
        angle = 0.5 * math.sin(0.003 * k)
        late = 0.5 * math.sin(0.003 * (k - 5.0))  # the encoder is 5 ms late
        bench.measure(START + k * MS, late + error)
        bench.turn(START + k * MS, -19.0 * angle)
    assert bench.encoder.slip_watch.slip is None


def test_report_soon_after_another_keeps_its_rate_and_comparison(bench):
    """As at a change of the reference, between two reports of the timer."""
    rest(bench, 0, 100, 0.0)
    monitor = InputMonitor(started=NOW - 1.0, last_input=NOW)
    reports = [
        (monitor.report(bench.rotor, NOW + late), bench.report(NOW + late)) for late in (0.0, 0.01)
    ]
    before, soon = ([each.message for each in both] for both in reports)
    assert before == soon == ['ok', 'direction not checked']
    assert [rotor.values['rate (Hz)'] for rotor, _ in reports] == ['100.0', '100.0']
