# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The encoder at the output: simulated transmission errors are recovered."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from live import SECOND, START, rotor_bytes

from gear_kinematics.correction.calibration_fit import CalibrationFit
from gear_kinematics.correction.error_window import ErrorStatistics
from gear_kinematics.kinematics import RotorPosition, RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections, DriverFacts
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

MS = SECOND // 1000
SETTINGS = replace(NodeParameters.load(), transmission_error_travel=0.01)
NOW = 50.0


class Bench:
    """A gear with both encoders."""

    def __init__(self, settings=SETTINGS) -> None:
        self.gear = GearState(settings)
        self.encoder = self.gear.output_encoder
        self.connections = Connections(DriverFacts(since=NOW - 1.0))

    def turn(self, stamp, position):
        return self.encoder.follow(
            self.gear.input.accept(rotor_bytes(stamp, position=[position]), int)
        )

    def measure(self, stamp, position, *, joint='shaft'):
        self.gear.encoder_monitor.last_input = NOW
        return self.gear.encoder(rotor_bytes(stamp, [joint], [position]), int)

    def move(self, states, *, start=0, step=1):
        """Send the measured and the ideal angle of the output every so many milliseconds."""
        for k, (measured, angle) in enumerate(states, start):
            self.measure(START + k * step * MS, measured)
            self.turn(START + k * step * MS, -19.0 * angle)

    def report(self, at=NOW):
        return self.gear.report(at, self.connections).get('transmission error')

    def facts(self, at=NOW):
        return self.report(at).facts


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


def test_joint_is_looked_up_by_its_name():
    bench = Bench(replace(SETTINGS, output_encoder_joint='shaft'))
    with pytest.raises(RejectedInputError, match='joint missing'):
        bench.measure(START, 0.0, joint='wheel')
    bench.turn(START, 0.0)
    [sample] = bench.measure(START, 0.25) or bench.turn(START + MS, 0.0)
    assert sample.error == pytest.approx(0.25)
    assert bench.encoder.received == 2
    assert bench.encoder.rejected == {}  # the other joint was that of another driver
    with pytest.raises(RejectedInputError, match='joint missing'):
        bench.measure(START + MS, 0.0, joint='wheel')
    assert (bench.encoder.rejected, bench.encoder.of_others) == ({}, 2)


# Diagnostics.


def swing(bench, amplitude, *, samples=400):
    """Move forward and backward, lagging by half the play in each direction."""
    phases = math.tau * np.arange(samples) / samples
    angles = 0.2 * np.sin(phases)
    behind = np.where(np.cos(phases) > 0.0, -amplitude, amplitude)
    bench.move(zip(angles + behind, angles, strict=True))


UNCHECKED = Condition.DIRECTION_NOT_CHECKED()
NOT_FINITE = Condition.REJECTED(counts={'position not finite': 1})


def test_report_has_the_figures_of_the_window():
    bench = Bench(replace(SETTINGS, transmission_error_limit=0.00201))
    swing(bench, 0.001)
    report = bench.report()
    assert report.facts == []
    values = dict(report.values)
    for name in 'lost motion (rad)', 'delay of output_encoder (s)':
        estimate = values.pop(name)
        assert estimate.value == pytest.approx(0.002 if 'rad' in name else 0.0, abs=1e-6)
        assert 0.0 <= estimate.uncertainty < 1e-6
    assert values == {
        'received': 400,
        'of others': 0,
        'compared': 400,
        'direction checked': True,
        'lost messages': 0,
        'age of last input (s)': 0.0,
        'samples': 400,
        'mean (rad)': pytest.approx(0.0, abs=2e-5),
        'peak to peak (rad)': pytest.approx(0.002, abs=1e-6),
    }
    assert re.fullmatch(r'0\.00[12]\d* ± \S+', report.texts['lost motion (rad)'])
    bench.move([(0.0011, 0.0)], start=400)
    assert bench.facts() == [Condition.TOO_LARGE(angle=pytest.approx(0.0021))]


@pytest.mark.parametrize(
    ('off', 'which'), [(0.0, Condition.TOO_LARGE), (2.9, Condition.BEYOND_ANY_GEAR)]
)
def test_only_an_error_of_a_gear_suggests_another_limit(bench, off, which):
    bench.move([(off, 0.0), (off + 0.01, 0.0)])
    assert bench.facts() == [which(angle=pytest.approx(0.01))]


@pytest.mark.parametrize('before', [True, False], ids=['after a report', 'at once'])
def test_silence_is_a_warning_and_leaves_no_figures(bench, before):
    assert bench.report() is None
    swing(bench, 0.001)
    if before:
        bench.report()
    report = bench.report(NOW + 2.5)
    assert report.facts == [Condition.NO_ENCODER(age=2.5)]
    names = 'samples', 'mean (rad)', 'lost motion (rad)'
    assert [report.texts[name] for name in names] == ['0', 'none', 'none']


def test_encoder_whose_stamps_are_not_the_rotors_is_a_warning(bench):
    bench.turn(START, 0.0)
    for k in range(3):
        bench.measure(START - 5 * SECOND + k * MS, 0.0)
        bench.turn(START + k * MS, 0.0)
    report = bench.report()
    assert report.facts == [Condition.CLOCKS_APART(apart=4.999), Condition.NOT_COMPARED()]
    assert report.values['not compared: no rotor state of about the same time'] == 3


def test_clocks_are_not_blamed_where_the_turns_are_unknown():
    gear = GearState(replace(SETTINGS, rotor_encoder='single_turn'))
    for k in range(3):
        for accept, joint in (gear.rotor, 'rotor'), (gear.encoder, 'shaft'):
            accept(rotor_bytes(START + k * MS, [joint], [0.0]), int)
    gear.encoder_monitor.last_input = NOW
    facts = gear.report(NOW, Connections(DriverFacts(since=NOW - 1.0)))['transmission error'].facts
    assert facts == [Condition.UNREFERENCED()]


@pytest.mark.parametrize('late', [-0.3, 0.12, 0.3])
def test_clocks_that_are_apart_are_named_before_the_fault_that_they_feign(late):
    """Interrupted turning at 2 rad/s, with stamps of the encoder that are off."""
    bench = Bench(replace(SETTINGS, transmission_error_window=0.5))
    for k in range(1, 3001):
        angle = 0.002 * min(k, max(1000, k - 1000))
        bench.turn(START + k * MS, -19.0 * angle)
        bench.measure(START + k * MS + round(late * SECOND), angle)
        if k == 1900:
            apart, *faults = bench.facts()
            assert apart == Condition.CLOCKS_APART(apart=pytest.approx(abs(late), abs=1e-9))
            assert {each.condition for each in faults} == {Condition.SLIPPED}
    bench.report()
    assert [each.condition for each in bench.facts(NOW + 1.0)][1:] == [Condition.SLIPPED]


@pytest.mark.parametrize('late', [0.0, 0.3])
def test_clocks_that_are_apart_are_named_beside_a_disagreement_that_they_feign(late):
    """Turns found at rest, and then motion with stamps of the encoder, or angles, that are off."""
    settings = replace(SETTINGS, rotor_encoder='single_turn', transmission_error_max_gap=0.01)
    bench = Bench(replace(settings, output_encoder_reference='absolute'))
    for k in range(1, 2001):
        moved = 0.002 * max(0, k - 1000)
        position = math.remainder(-19.0 * moved, 2.0 * math.pi)
        bench.gear.rotor(rotor_bytes(START + k * MS, position=[position]), int)
        off = 0 if k <= 1000 else round(late * SECOND)
        bench.measure(START + k * MS + off, moved + (0.6 if late == 0.0 and k > 1000 else 0.0))
    facts = bench.gear.report(NOW, bench.connections)['rotor input'].facts
    found = [each.condition for each in facts]
    assert found[0] is Condition.DISAGREES
    assert (Condition.CLOCKS_APART in found) == (late > 0.0)


@pytest.mark.parametrize(('late', 'longest', 'found'), [
    (0.3, 0.01, False), (-0.12, 0.01, False), (0.12, 0.15, True), (0.09, 0.01, True),
])  # fmt: skip
def test_no_turns_are_found_by_clocks_that_are_apart(late, longest, found):
    """At rest, where stamps do not matter: a motion would tell other turns."""
    settings = replace(SETTINGS, rotor_encoder='single_turn', transmission_error_max_gap=longest)
    bench = Bench(replace(settings, output_encoder_reference='absolute'))
    for k in range(1, 1001):
        bench.gear.rotor(rotor_bytes(START + k * MS, position=[0.0]), int)
        bench.measure(START + k * MS + round(late * SECOND), 0.0)
    assert bench.gear.referenced is found
    why = Condition.CLOCKS_APART(apart=abs(late))
    facts = bench.gear.report(NOW, bench.connections)['rotor input'].facts
    assert (Condition.NOT_FOUND(why=why) in facts) is not found


def test_clocks_are_not_named_where_the_rotor_falls_silent_or_both_send_seldom(bench):
    for k in range(1, 30):
        bench.turn(START + 90 * k * MS, 0.0)
        bench.measure(START + 90 * k * MS + 85 * MS, 0.0)
    assert bench.facts() == [UNCHECKED]
    for k in range(1, 9):
        bench.measure(START + 2700 * MS + 100 * k * MS, 0.0)
    assert bench.facts(NOW + 1.0) == [Condition.NOT_COMPARED()]


@pytest.mark.parametrize(('explained', 'fits'), [(0.4, False), (0.999, True)])
def test_calibration_that_no_longer_fits_is_a_warning(bench, monkeypatch, explained, fits):
    swing(bench, 0.001)
    fit = CalibrationFit(400, explained, 0.25, fits, 40.0)
    statistics = ErrorStatistics(calibration=fit)
    monkeypatch.setattr(bench.encoder.window, 'statistics', lambda: statistics)
    report = bench.report()
    assert report.facts == [Condition.FITS_NO_LONGER()] * (not fits)
    assert report.texts['explained by the calibration (%)'] == f'{100 * explained:.1f}'
    assert report.texts['outside the interval (%)'] == '25.0'


def test_change_of_a_parameter_loses_no_count(bench):
    swing(bench, 0.001)
    with pytest.raises(RejectedInputError):
        bench.measure(START + 399 * MS, math.nan)
    assert bench.facts() == [NOT_FINITE]
    bench.gear.apply(replace(SETTINGS, transmission_error_window=5.0), None)
    with pytest.raises(RejectedInputError):
        bench.measure(START + 399 * MS, math.nan)
    bench.move([(0.0, 0.0)] * 400, start=400)  # as many as before
    report = bench.report()
    assert report.facts == [NOT_FINITE]
    assert report.values['compared'] == 800
    assert report.values['rejected: position not finite'] == 2


# Slips.


def rest(bench, start, count, error, *, speed=0.0):
    """Send both encoders with a constant error at the output, which turns at a speed, rad/s."""
    angles = 1e-3 * speed * np.arange(start, start + count)
    bench.move(zip(angles + error, angles, strict=True), start=start)


@pytest.mark.parametrize('speed', [0.0, 2.0])
@pytest.mark.parametrize('degrees', [20.0, -20.0, 0.5])
def test_slip_stays_a_warning_after_the_window_has_passed(degrees, speed):
    bench = Bench(replace(SETTINGS, transmission_error_window=0.1))
    rest(bench, 0, 500, 0.0, speed=speed)
    assert bench.facts() == [UNCHECKED] * (not speed)
    rest(bench, 500, 2000, math.radians(degrees), speed=speed)
    for more in range(2500, 4500, 500):
        angle, when = pytest.approx(degrees), (START + 500 * MS) / SECOND
        assert bench.facts() == [Condition.SLIPPED(angle_deg=angle, time=when)]
        rest(bench, more, 500, math.radians(degrees), speed=speed)


def test_size_of_a_slip_does_not_change_in_motion_where_the_encoder_is_late(bench):
    k = np.arange(6000)
    moved = np.maximum(0.003 * (k - 4000), 0.0)
    bench.move(zip(moved - 0.06 * (k > 4000) + 0.1 * (k > 2000), moved, strict=True))
    assert bench.encoder.slip_watch.slip.angle == pytest.approx(0.1, abs=1e-9)


def test_slip_is_found_after_the_clock_was_set_back(bench):
    for k in range(3000):
        stamp = START + k * MS - 60 * SECOND * (k > 500)
        bench.measure(stamp, 0.1 * (k > 2000))
        bench.turn(stamp, 0.0)
    assert bench.encoder.slip_watch.slip is not None


@pytest.mark.parametrize('drift', [0.0, 2e-4, -2e-4])
def test_slow_drift_in_steady_motion_is_a_slip(drift, bench):
    moving = np.maximum(0.0, 0.01 * np.arange(4000) - 1.0)
    faster = np.minimum(moving, 1.0)
    angle = 5.0 * (0.5 * faster**2 + moving - faster)  # up to 5 rad/s
    late = -0.005 * 5.0 * faster  # rad, of an encoder that is 5 ms late
    bench.move(zip(angle + late + drift * moving, angle, strict=True), step=10)
    slip = bench.encoder.slip_watch.slip
    assert bool(slip) == bool(drift)
    if slip:  # beyond the limit of 0.003 rad, since the speed is steady
        assert 15.0 < (slip.stamp - START) / SECOND - 2.0 < 20.0


@pytest.mark.parametrize('late', [20, -20, 90])
def test_encoder_that_is_late_is_no_slip_where_the_speed_changes(late, bench):
    """Each change of the speed appears in the error before or after the rotor's speed changes."""
    rates = np.repeat([0.0, 4.0, 10.0, -6.0, 0.0, 8.0, 1.0, 0.0], 437)  # rad/s of the output
    ramps = np.convolve(rates, np.full(61, 1.0 / 61), 'same')
    angles = 1e-3 * np.cumsum(ramps)
    bench.move(zip(np.roll(angles, late)[100:-100], angles[100:-100], strict=True))
    assert bench.encoder.slip_watch.slip is None


def test_slip_in_fast_motion_is_found_in_slow_motion(bench):
    """The encoder is 5 ms late; the output slips while it becomes slower for the second time."""
    speed = np.convolve(np.repeat([5.0, 0.0, 5.0, 0.0], 600), np.full(101, 1.0 / 101), 'same')
    angles = 1e-3 * np.cumsum(speed)
    slipped = 0.1 * (np.arange(len(angles)) >= 1800)
    bench.move(zip(angles - 5e-3 * speed + slipped, angles, strict=True))
    assert bench.encoder.slip_watch.slip.angle == pytest.approx(0.1, abs=0.003)


def test_slips_within_the_limit_at_each_stop_add_up(bench):
    """0.002 rad at each of five stops, of which each is compared with the first."""
    stands = np.repeat([True, False] * 5, 600)
    angles = 5e-3 * np.cumsum(~stands)
    crept = 0.002 / 600 * np.cumsum(stands)
    bench.move(zip(angles + crept, angles, strict=True))
    assert bench.encoder.slip_watch.slip


def test_slip_is_found_where_several_angles_have_the_same_stamp(bench):
    """1 kHz with stamps in units of 50 ms."""
    for k in range(3000):
        bench.measure(START + k // 50 * 50 * MS, 0.1 * (k > 1000))
        bench.turn(START + k * MS, 0.0)
    assert bench.encoder.slip_watch.slip.angle == pytest.approx(0.1)


@pytest.mark.parametrize('sense', [1, -1])
def test_direction_is_checked_by_a_motion_alone(sense):
    """The wrong way round, the error grows by twice the travel; 0.005 rad show nothing."""
    bench = Bench(SETTINGS)
    bench.move([(0.0, 0.0)] * 500 + [(0.005, 0.005)] * 500)
    assert bench.report().values['direction checked'] is False
    angles = 5e-5 * np.arange(2000)
    bench.move(zip(sense * angles, angles, strict=True), start=1000)
    assert bench.report().values['direction checked'] is (sense > 0)
    bench.encoder.configure(replace(SETTINGS, output_encoder_direction=-1))
    assert not bench.encoder.direction_checked


def test_single_wrong_readings_and_errors_within_the_limit_are_no_slip(bench):
    k = np.arange(5000)
    error = np.where(k % 50, 0.0015 * np.sin(0.01 * k), 1.0)
    late = 0.5 * np.sin(0.003 * (k - 5.0))  # the encoder is 5 ms late
    bench.move(zip(late + error, 0.5 * np.sin(0.003 * k), strict=True))
    assert bench.encoder.slip_watch.slip is None


def test_report_soon_after_another_keeps_its_rate_and_comparison(bench):
    """As at a change of the reference, between two reports of the timer."""
    rest(bench, 0, 100, 0.0)
    bench.gear.monitor.last_input = NOW
    for late in (0.0, 0.01):
        reports = bench.gear.report(NOW + late, bench.connections)
        assert [report.facts for report in reports.values()] == [[], [UNCHECKED]]
        assert reports['rotor input'].values['rate (Hz)'] == 100.0
