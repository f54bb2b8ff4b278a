# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Turns of the rotor from the encoder at the output, beside a simulated gear and real ones."""

import math
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from live import SECOND, START, rotor_bytes

from gear_kinematics.correction.corrector import Correction
from gear_kinematics.correction.transmission_error import SAMPLES
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

MS = SECOND // 1000
MULTI = replace(
    NodeParameters.load(), output_encoder_reference='absolute', transmission_error_max_gap=0.001
)
SINGLE = replace(MULTI, rotor_encoder='single_turn')
NO_SAMPLES = [Condition.NOT_FOUND(why=Condition.NO_SAMPLES(count=SAMPLES))]
NOT_CHECKED = [Condition.NOT_CHECKED()]
ENOUGH = SAMPLES + 2  # with the next rotor state, and one of the new count
GAP = {'transmission_error_max_gap': 0.015}  # s: the longest in the recordings
LARA = {'gear_ratio': '121'} | GAP
PRINTED = {'gear_ratio': '-36/5', 'transmission_error_limit': 0.011} | GAP  # its ratio is 1 % off


def near(degrees):
    return pytest.approx(degrees, rel=5e-3, abs=5e-3)


class Bench:
    """A gear whose output is where the test says, and the state that follows its encoders."""

    def __init__(self, settings=SINGLE, *, switched_on_at=0.0) -> None:
        self.settings, self.switched_on_at = settings, switched_on_at
        self.zero = settings.rotor_zero
        self.gear = GearState(settings)
        self.rotor, self.encoder = self.gear.input, self.gear.output_encoder
        self.gear.monitor.last_input = 0.0
        self.stamp, self.errors = START, []

    def set(self, **changes) -> None:
        """Change parameters as the node does."""
        self.settings = replace(self.settings, **changes)
        self.gear.apply(self.settings, None)

    def turn(self, *outputs, error=0.0, step=MS, correction=None, measured=True):
        """Send the messages at output angles, rad, and return the last one of the node."""
        settings, ratio = self.settings, self.settings.gear.gear_ratio
        for output in outputs:
            self.stamp += step
            position = settings.rotor_direction * float(output * ratio) + self.zero
            period = settings.rotor_period
            position = position % period if period else position - self.switched_on_at
            data = rotor_bytes(self.stamp, position=[position])
            sample = self.rotor.accept(data, lambda: 0)
            self.errors += self.encoder.follow(sample, correction)
            angle = settings.output_encoder_direction * (output + error)
            position = (angle + settings.output_encoder_zero) % math.tau
            data = rotor_bytes(self.stamp, ['shaft'], [position])
            self.errors += self.encoder.accept(data, lambda: 0) if measured else []
        turns, angle = self.rotor.last.position
        return float((math.tau * turns + angle) / ratio)

    def rest(self, output, count=ENOUGH, **how):
        return self.turn(*[output] * count, **how)

    @property
    def report(self):
        return self.gear.report(0.0, Connections())['rotor input']

    @property
    def facts(self):
        return self.report.facts


@pytest.mark.parametrize('ratio', ['-19', '36/5', '1457/26', '101', '1/3'])
@pytest.mark.parametrize(('way', 'zero'), [(1, 0.0), (-1, 28.969), (1, -400.0)])
@pytest.mark.parametrize('turns', [0.4, -0.3, 12.4])
def test_a_single_turn_rotor_is_found_exactly(ratio, way, zero, turns):
    settings = {'rotor_direction': way, 'output_encoder_direction': -way, 'rotor_zero': zero}
    settings |= {'output_encoder_zero': zero, 'transmission_error_limit': 1e-3}
    bench, output = Bench(replace(SINGLE, gear_ratio=ratio, **settings)), math.tau * turns
    bench.rest(output, SAMPLES - 1)
    assert bench.facts == NO_SAMPLES
    segment = bench.rotor.segment
    bench.rest(output, 1)
    assert (bench.facts, bench.rotor.segment) == ([], segment + 1)
    found = bench.rest(output, 1)
    assert bench.facts == []
    assert bench.report.values['reference'] == Condition.EXACT_TURNS()
    period = math.tau * Fraction(ratio).denominator
    assert math.remainder(found - output, period) == pytest.approx(0.0, abs=1e-9)
    assert abs(found) <= period / 2


@pytest.mark.parametrize('position', [0.0, 1234.5, -1e9])
def test_a_rotor_that_counts_from_its_start_is_set_to_the_measured_angle(position):
    bench = Bench(replace(MULTI, rotor_zero=77.0), switched_on_at=position)
    for error in 1e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, ENOUGH):
        bench.turn(2.5, error=error)
    assert bench.rest(2.5, 1) == pytest.approx(2.5, abs=5e-4)
    report = bench.report
    # By hand: φ5 = -(reading - zero)/19, where the reading is -19 · 2.5 + 77 - `position`.
    zero = 77.0 - position
    assert report.values['rotor zero (rad)'] == pytest.approx(zero, abs=0.02, rel=1e-8)
    limit_and_noise = pytest.approx(0.21, abs=0.04)
    assert report.facts == []
    assert report.values['reference'] == Condition.MEASURED(uncertainty_deg=limit_and_noise)
    first = bench.turn(3.0, step=SECOND)
    # An encoder that is silent for a while keeps its zero; one that was switched off gets another.
    assert bench.turn(3.0, step=2 * SECOND) == first
    assert bench.facts == NO_SAMPLES
    assert bench.rest(3.0) == first
    bench.switched_on_at += 40.0
    bench.turn(3.0, step=2 * SECOND)
    assert bench.rest(3.0) == pytest.approx(3.0, abs=1e-9)
    assert bench.facts == []


@pytest.mark.parametrize(
    ('changes', 'error', 'speed', 'used', 'margin'),
    [
        ({}, math.radians(8.1), 0.0, 8.1, 9.47),
        ({'transmission_error_limit': 0.2}, 0.0, 0.0, 11.5, 9.47),
        ({'gear_ratio': '1457/26'}, 0.0, 0.0, 0.172, 0.124),
        ({'rotor_encoder': 'multi_turn'}, 0.0, 30.0, 1.89, 0.344),
        ({'transmission_error_max_gap': 0.006}, 0.0, 30.0, 10.5, 9.47),
    ],
)
def test_what_is_ambiguous_is_refused(changes, error, speed, used, margin):
    bench = Bench(replace(SINGLE, **changes))
    bench.turn(*(1e-3 * speed * k for k in range(3 * SAMPLES)), error=error)
    which = Condition.UNEXPLAINED if error else Condition.AMBIGUOUS
    why = which(used_deg=near(used), margin_deg=near(margin))
    assert bench.facts == [Condition.NOT_FOUND(why=why)]
    assert (bench.report.values['reference'], bench.errors) == (None, [])


def test_a_calibration_is_subtracted_and_noise_is_added():
    bench, correction = Bench(), Correction(0.15, 0.0, 0.01, 0.0)
    assert bench.rest(1.0, error=0.15, correction=correction) == pytest.approx(1.0)
    bench = Bench(replace(SINGLE, transmission_error_limit=0.05))
    for k in range(2 * SAMPLES):
        bench.turn(1.0, error=0.12 * (-1) ** k)
    why = Condition.AMBIGUOUS(used_deg=near(9.74), margin_deg=near(9.47))
    assert bench.facts == [Condition.NOT_FOUND(why=why)]


def outside(degrees):
    return Condition.OUTSIDE(angle_deg=near(degrees), low_deg=0.0, high_deg=near(270.0))


def disagrees(encoder, rotor):
    return Condition.DISAGREES(encoder_deg=near(encoder), rotor_deg=near(rotor))


QUARTERS = {'output_range': (0.0, 1.5 * math.pi)}  # a joint of 0 to 270°


@pytest.mark.parametrize(('settings', 'without'), [
    (MULTI, -110.0), (SINGLE, -110.0), (replace(SINGLE, gear_ratio='36/5'), 250.0),
    (replace(MULTI, rotor_encoder_range=25.0), None),
])  # fmt: skip
def test_range_of_the_output_tells_its_turn_or_excludes_it(settings, without):
    for degrees, found in ((250.0, 250.0), (-1e-3, -1e-3), (100.0, 100.0), (270.0, 270.0)):
        bench = Bench(replace(settings, **QUARTERS))
        for _ in range(ENOUGH):
            bench.rest(math.radians(degrees), 1)
            assert not bench.rotor.referenced or bench.facts == []
        assert math.degrees(bench.rest(math.radians(degrees))) == pytest.approx(found, abs=0.01)
        assert bench.facts == []
    unlimited = Bench(settings)
    found = math.degrees(unlimited.rest(math.radians(250.0)))
    assert unlimited.rotor.referenced is (without is not None)
    assert found == pytest.approx(without or found, abs=0.01)
    bench.turn(*np.radians(np.linspace(270.0, 300.0, 200)))
    bench.rest(math.radians(300.0), 2 * SAMPLES)
    assert bench.facts == [outside(300.0)]
    bench = Bench(replace(settings, **QUARTERS))
    bench.rest(math.radians(300.0))
    found = [Condition.NOT_FOUND(why=outside(degrees)) for degrees in (300.0, -60.0)]
    assert bench.facts in ([each] for each in found)


def test_range_of_nearly_a_turn_does_not_tell_its_ends_apart():
    bench = Bench(replace(MULTI, output_range=(0.0, math.radians(359.9))))
    bench.rest(0.0)
    why = Condition.AT_EITHER_END(angle_deg=near(0.0), low_deg=0.0, high_deg=near(359.9))
    assert bench.facts == [Condition.NOT_FOUND(why=why)]
    bench.turn(*np.radians(np.linspace(0.0, 20.0, 200)))
    assert bench.rest(math.radians(20.0)) == pytest.approx(math.radians(20.0), abs=2e-3)


def test_turns_that_may_be_at_either_end_are_found_as_soon_as_the_output_leaves_it():
    bench = Bench(replace(SINGLE, output_range=(0.0, math.radians(359.9)), **GAP))
    bench.rest(0.0)
    assert not bench.rotor.referenced
    found = bench.turn(*np.arange(300) * 5e-4)  # at 0.5 rad/s, where a delay could explain 0.4°
    assert bench.rotor.referenced
    assert found == pytest.approx(0.1495, abs=1e-9)


def test_range_is_checked_without_an_encoder_at_the_output():
    bench = Bench(replace(MULTI, output_encoder_reference='none', **QUARTERS))
    for degrees, facts in ((269.0, []), (-90.0, [outside(-90.0)])):
        bench = Bench(bench.settings)
        bench.rest(math.radians(degrees), measured=False)
        assert bench.facts == facts


def test_when_turns_are_searched():
    bench = Bench()
    for samples, missing in ((40, 5), *[(1, 1)] * 2 * SAMPLES, (40, 5)):  # not in a row
        bench.rest(1.0, samples)
        assert bench.facts == NO_SAMPLES
        bench.rest(1.0, missing, measured=False)
    assert bench.rest(1.0) == pytest.approx(1.0)
    assert bench.turn(*np.linspace(1.0, 20.0, 4000)) == pytest.approx(20.0)  # beyond a turn
    # In a gap the rotor turns thrice unseen; errors are those of known turns.
    assert bench.turn(21.0, step=80 * MS) != pytest.approx(21.0)
    facts = [Condition.GAP(gap=0.08), *NO_SAMPLES]
    assert (bench.facts, bench.report.values['reference']) == (facts, None)
    assert bench.rest(21.0) == pytest.approx(21.0, abs=1e-9)
    assert max(abs(sample.error) for sample in bench.errors) < 1e-9
    # In a longer one, the output could have turned as well: as after the start.
    bench.turn(21.0, step=SECOND // 2)
    assert bench.rest(21.0) == pytest.approx(21.0 - 3 * math.tau)
    bench.stamp = START  # the clock is set back
    bench.rest(2.0, 2)
    assert bench.report.values['reference'] is None
    assert bench.rest(2.0) == pytest.approx(2.0)
    # Parameters of the encoders begin a search, others do not.
    bench.set(transmission_error_window=5.0, transmission_error_limit=0.004)
    assert bench.rotor.referenced
    bench.set(output_encoder_zero=0.5)
    assert not bench.rotor.referenced
    assert bench.rest(1.0) == pytest.approx(1.0)


@pytest.mark.parametrize('settings', [SINGLE, MULTI])
@pytest.mark.parametrize('searched', [3, ENOUGH])
def test_homing_ends_the_search_and_a_disagreement_moves_nothing(settings, searched):
    bench = Bench(settings)
    bench.rest(1.0, searched)
    bench.rest(1.0, searched, error=-0.33)
    bench.set(rotor_zero=bench.rotor.zero_for(-19.0))  # as ~/home does
    bench.rotor.home(-19.0)
    assert (bench.facts, bench.report.values['reference']) == ([], Condition.HOMED())
    segment = bench.rotor.segment
    apart = [disagrees(38.39, 57.30)]
    for samples, error, found in (
        (SAMPLES, 0.0, []),
        (SAMPLES - 1, -0.33, NOT_CHECKED),
        (1, 0.0, NOT_CHECKED),
        (2 * SAMPLES, -0.33, apart),
        (SAMPLES // 2, 0.0, apart),  # which samples of both kinds do not take back
        (2 * SAMPLES, 0.0, []),
    ):
        assert bench.rest(1.0, samples, error=error) == pytest.approx(1.0)
        assert bench.facts == found
    assert bench.rotor.segment == segment


def test_disagreement_at_rest_is_not_taken_back_in_motion():
    bench = Bench(replace(SINGLE, transmission_error_max_gap=0.1))
    bench.rest(0.0, 400)
    assert bench.facts == []
    bench.rest(0.0, 1000, error=math.radians(12.0))
    assert bench.facts == [disagrees(12.0, 0.0)]
    speed = math.radians(200.0)  # rad/s, at which a delay of 0.1 s would be 20°
    angles = [1e-3 * speed * k for k in range(2000)]
    bench.turn(*angles, error=math.radians(12.0))
    assert bench.facts == [disagrees(12.0, 0.0)]
    bench.rest(angles[-1], 1000)
    assert bench.facts == []
    bench.turn(*(angles[-1] + angle for angle in angles))
    assert bench.facts == NOT_CHECKED  # nor is the agreement


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'unit', 'settings'),
    [
        ('neura_jogging_final_joint1', math.tau / 2**24, LARA),
        ('neura_jogging_joint_mass_joint2', math.tau / 2**24, LARA),
        ('sspg_backlash_sine_vel_2.500tps_2.00s', 1.0, PRINTED),
    ],
)
def test_a_real_gear_has_the_same_angle_from_wherever_it_is_started(
    shared_path, name, unit, settings
):
    path = shared_path(f'data/dual_encoders/{name}.csv')
    time, *angles = np.loadtxt(path, delimiter=',', skiprows=1, usecols=(0, 1, 2), unpack=True)
    rotor, measured = np.multiply(angles, unit)
    ideal = rotor / float(Fraction(settings['gear_ratio']))
    zero = float(np.median(measured - ideal))
    settings = replace(SINGLE, output_encoder_zero=zero, max_rotor_speed=200.0, **settings)
    ratio = settings.gear.gear_ratio
    stamps = (START + np.round(time * SECOND)).astype(int).tolist()
    messages = [
        tuple(rotor_bytes(stamp, position=[angle % math.tau]) for angle in both)
        for stamp, *both in zip(stamps, rotor, measured, strict=True)
    ]
    for start in range(0, len(stamps) - 3 * SAMPLES, 13):
        bench, k = Bench(settings), start
        while not bench.rotor.referenced:
            assert k < start + 3 * SAMPLES
            bench.encoder.follow(bench.rotor.accept(messages[k][0], lambda: 0))
            bench.encoder.accept(messages[k][1], lambda: 0)
            k += 1
        turns, angle = bench.rotor.accept(messages[k][0], lambda: 0).position
        error = float((math.tau * turns + angle) / ratio) - ideal[k]
        assert abs(math.remainder(error, math.tau * ratio.denominator)) < 1e-9


@pytest.mark.parametrize(('delay', 'start'), [(-95, 180), (60, 0), (95, 0)])  # ms
def test_a_delay_about_the_start_and_stop_of_the_shaft_gives_no_wrong_turn(delay, start):
    for speed in np.linspace(1.0, 15.0, 8):  # rad/s
        bench = Bench(replace(SINGLE, transmission_error_max_gap=0.1))
        time = np.arange(900)  # ms
        outputs, delayed = (
            speed / 1000 * np.clip(ms - start, 0, 200) - 1.0 for ms in (time, time - delay)
        )
        for output, late in zip(outputs, delayed, strict=True):
            known = bench.rotor.referenced
            angle = bench.turn(output, error=late - output)
            assert not known or angle == pytest.approx(output, abs=1e-9)
        assert bench.rotor.referenced


@pytest.mark.parametrize('ahead', [0, 2, -3, 37])
@pytest.mark.parametrize('changes', [{}, {'rotor_encoder': 'single_turn'}])
def test_encoder_of_another_clock_finds_no_turns(changes, ahead):
    """Where it has stood before a motion, as the rotor stands after that."""
    gear = GearState(
        replace(MULTI, max_rotor_speed=250.0, transmission_error_max_gap=0.1, **changes)
    )
    for k in range(1200):
        turned = 90.0 * min(max(k - 100, 0), 60) / 60  # in 0.6 s, after a second
        stamp = START + k * SECOND // 100
        position = math.remainder(turned, math.tau) if changes else turned
        gear.rotor(rotor_bytes(stamp, position=[position]), int)
        of_output = rotor_bytes(stamp + ahead * SECOND, ['shaft'], [turned / -19.0])
        gear.encoder(of_output, int)
    gear.rotor(rotor_bytes(START + 12 * SECOND, position=[position]), int)
    assert gear.referenced is not bool(ahead)
    if gear.referenced:
        turns, angle = gear.sample.position
        assert math.tau * turns + angle == pytest.approx(90.0)


@pytest.mark.parametrize('apart', [0.0, 0.8])
def test_motion_does_not_find_turns_that_the_rest_before_it_refutes(apart):
    """By a zero that is off by 0.8 of the angle between two turns; a delay could explain 0.2."""
    gear = GearState(replace(SINGLE, max_rotor_speed=250.0, transmission_error_max_gap=0.1))
    for k in range(1200):
        turned = 13.0 * max(k - 200, 0) / 100
        stamp = START + k * SECOND // 100
        gear.rotor(rotor_bytes(stamp, position=[math.remainder(turned, math.tau)]), int)
        measured = (turned + apart * math.tau) / -19.0
        gear.encoder(rotor_bytes(stamp, ['shaft'], [measured]), int)
    assert gear.referenced is not bool(apart)
    if apart:  # what the rest has told, not the more that the motion could explain
        why = Condition.UNEXPLAINED(used_deg=near(0.2 * 360.0 / 19), margin_deg=near(180.0 / 19))
        report = gear.report(0.0, Connections())['rotor input']
        assert Condition.NOT_FOUND(why=why) in report.facts


@pytest.mark.parametrize('stops', [False, True])
@pytest.mark.parametrize('wrong', [10, 10_000])
def test_motion_that_could_explain_a_jump_finds_no_turns(wrong, stops):
    """In motion, a delay of 20 ms could explain 2.4 rad of a rotor that got another zero."""
    settings = {'max_rotor_speed': 250.0, 'transmission_error_max_gap': 0.02}
    gear = GearState(replace(SINGLE, max_rotor_acceleration=2500.0, **settings))
    turned = 0.0
    for k in range(2400):
        share = min(max(0.01 * (k - 400), 0.0), 1.0, max(0.01 * (1900 - k), 0.0 if stops else 1.0))
        turned += 120.0 * share / 200
        stamp = START + k * SECOND // 200
        read = turned + 2.2 * (1200 <= k < 1200 + wrong)
        with suppress(RejectedInputError):
            gear.rotor(rotor_bytes(stamp, position=[math.remainder(read, math.tau)]), int)
        gear.encoder(rotor_bytes(stamp, ['shaft'], [turned / -19.0]), int)
        assert gear.referenced or not 400 <= k < 1200
    assert gear.input.plausibility.jumps
    assert gear.referenced is (wrong == 10)
    facts = gear.report(0.0, Connections())['rotor input'].facts
    if gear.referenced:
        turns, angle = gear.sample.position
        error = math.remainder(math.tau * turns + angle - turned, 19.0 * math.tau)
        assert error == pytest.approx(0.0, abs=1e-9)
    elif not stops:
        used = math.degrees(SINGLE.transmission_error_limit + 0.02 * 120.0 / 19)
        why = Condition.AMBIGUOUS(used_deg=near(used), margin_deg=near(math.degrees(1.1 / 19)))
        assert Condition.NOT_FOUND(why=why) in facts


@pytest.mark.parametrize('zero', [0.0, 0.5])
def test_jumps_count_by_their_sum(zero):
    """A delay of 20 ms could explain 0.6 rad of the rotor, which jumps by 2.2 rad, and back."""
    settings = {'max_rotor_speed': 250.0, 'transmission_error_max_gap': 0.02}
    gear, turned = GearState(replace(SINGLE, max_rotor_acceleration=2500.0, **settings)), 0.0
    for k in range(1500):
        turned += 30.0 / 200 * min(max(0.01 * (k - 200), 0.0), 1.0)
        read = turned + (2.2 if 800 <= k < 810 else zero * (k >= 810))
        stamp = START + k * SECOND // 200
        with suppress(RejectedInputError):
            gear.rotor(rotor_bytes(stamp, position=[math.remainder(read, math.tau)]), int)
        gear.encoder(rotor_bytes(stamp, ['shaft'], [turned / -19.0]), int)
        assert gear.referenced or not 200 <= k < 800
    assert gear.input.plausibility.jumps == 2
    assert gear.referenced is (not zero)


@pytest.mark.parametrize('noise', [0.0, 0.01])
@pytest.mark.parametrize('jump', [0.5, 1.0, 2.2])
def test_rest_finds_turns_after_a_jump_beside_a_noisy_encoder(jump, noise):
    """Its noise of 0.01 rad is more than half a jump of 0.5 rad of the rotor, over 121."""
    limits = {'max_rotor_speed': 250.0, 'max_rotor_acceleration': 500.0}
    gear, generator = GearState(replace(SINGLE, **limits, **LARA)), np.random.default_rng(0)
    for k in range(600):
        stamp = START + k * SECOND // 200
        turned = 0.01 * min(k, 50)
        with suppress(RejectedInputError):
            gear.rotor(rotor_bytes(stamp, position=[turned + jump * (200 <= k < 210)]), int)
        measured = turned / 121.0 + noise * generator.uniform(-1.0, 1.0)
        gear.encoder(rotor_bytes(stamp, ['shaft'], [measured]), int)
        assert gear.referenced or not 150 <= k < 200
    assert gear.input.plausibility.jumps
    assert gear.referenced
    assert gear.sample.position == (0, 0.5)
