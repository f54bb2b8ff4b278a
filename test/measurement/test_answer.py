# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a report says of a recording: its answer, its remarks, and what became of limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps, write_csv

from gear_kinematics.measurement.answer import Limits, answer, remarks
from gear_kinematics.measurement.backlash import Backlash
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.measured import Measured
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.sentences import Cause, Observation
from gear_kinematics.measurement.wording import plus_minus
from gear_kinematics.report.document import Tone
from gear_kinematics.statistics.uncertainty import Component, Estimate

ARC_MINUTE = math.radians(1.0 / 60.0)
GEAR = Gear(play=10.0 * ARC_MINUTE, stiffness=300.0, friction=1.0)  # hysteresis 32.9′
SMALL = ramps(*[(4.0, 200)] * 3)


@pytest.fixture(scope='module')
def report_of(tmp_path_factory, config):
    def measured(**columns):
        path = write_csv(tmp_path_factory.mktemp('answer') / 'r.csv', **columns)
        return measure(read(path, config), config)

    return measured


@pytest.fixture(scope='module')
def report(report_of):
    torque = ramps(*[(4.0, 200)] * 5, *[(40.0, 400)] * 3)
    return report_of(angle=creep(GEAR, torque), torque=torque)


@pytest.mark.parametrize(
    ('name', 'limit', 'holds', 'why'),
    [
        ('hysteresis', 33.5 * ARC_MINUTE, True, 'WITHIN_LIMIT'),
        ('hysteresis', 32.0 * ARC_MINUTE, False, 'BEYOND_LIMIT'),
        ('backlash', 10.5 * ARC_MINUTE, True, 'WITHIN_LIMIT'),
        ('backlash', 10.0 * ARC_MINUTE, False, 'PERHAPS_BEYOND'),
        ('backlash', 9.0 * ARC_MINUTE, False, 'BEYOND_LIMIT'),
        ('lost_motion', 1.0, True, 'WITHIN_LIMIT'),
        ('lost_motion', 1e-4, False, 'BEYOND_LIMIT'),
        ('stiffness', 290.0, True, 'WITHIN_LIMIT'),
        ('stiffness', 310.0, False, 'BEYOND_LIMIT'),
    ],
)
def test_limits_are_held_exceeded_or_not_shown(report, name, limit, holds, why):
    (judged,) = Limits(**{name: limit}).judge(report)
    assert (judged.holds, judged.why.what) == (holds, Observation[why])


def test_what_is_not_known_holds_no_limit(report_of):
    ideal = 0.01 * np.arange(400)
    output = ideal + 1e-5 * np.sin(ideal)
    judged = Limits(1.0, 1.0, 1.0, 1.0).judge(report_of(rotor=-19.0 * ideal, output=output))
    found = [(one.holds, one.why.what) for one in judged]
    assert found == 4 * [(False, Observation.NOT_KNOWN)]


@pytest.mark.parametrize('name', ['hysteresis', 'stiffness', 'backlash'])
def test_a_limit_cannot_be_shown_to_hold_where_the_uncertainty_is_unknown(report_of, name):
    torque = ramps((40.0, 400))
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    limits = {'stiffness': 1.0} | dict.fromkeys(['hysteresis', 'backlash'], 1.0)
    (judged,) = Limits(**{name: limits[name]}).judge(report)
    assert not judged.holds
    unknown = Observation.NOT_KNOWN if name == 'backlash' else Observation.MEASURED_ONCE
    assert judged.why.what is unknown


@pytest.mark.parametrize(('amplitude', 'below'), [(4.0, True), (40.0, False)])
def test_lost_motion_below_the_friction_is_said_and_not_judged(report_of, amplitude, below):
    torque = ramps(*[(amplitude, 400)] * 5)  # read at 0.12 or 1.2 N·m; friction is 1 N·m
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    (judged,) = Limits(lost_motion=1.0).judge(report)
    assert judged.holds != below
    assert (judged.why.what is Observation.NOT_JUDGED) == below
    said = [
        found.values for found in remarks(report) if found.what is Observation.READ_BELOW_FRICTION
    ]
    known = {'torque': pytest.approx(0.12), 'friction': pytest.approx(1.0, rel=0.01)}
    assert said == [known] * below


@pytest.mark.parametrize(
    ('friction', 'what', 'cause'),
    [
        (0.5, Observation.PLAY, None),
        # Of 4 N·m: the spring beyond the play is hardly loaded.
        (3.9, Observation.PLAY_UNKNOWN, Cause.FRICTION),
    ],
)
def test_answer_tells_play_from_friction_where_it_can(report_of, friction, what, cause):
    report = report_of(angle=creep(GEAR._replace(friction=friction), SMALL), torque=SMALL)
    found = answer(report)
    assert (found.what, found.values.get('cause')) == (what, cause)
    slow = Observation.PLAY_BY_SLOW_RAMPS if friction < 1.0 else Observation.PLAY_NOT_SEPARATED
    for unclear, said in (
        (Cause.REPEATS, Observation.PLAY_NOT_SEPARATED),
        (Cause.BENT, slow),
        (Cause.NONE, Observation.PLAY_WITHIN),
    ):
        figures = replace(report.figures, backlash=Backlash(0.0, 0.1, unclear))
        assert answer(replace(report, figures=figures)).what is said


def test_remarks_tell_what_a_single_loop_cannot(report_of):
    torque = ramps((4.0, 200))
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    said = [found.what for found in remarks(report)]
    assert said == [Observation.INFERRED, Observation.ONE_AMPLITUDE, Observation.PLUS_MINUS]
    assert answer(report).values['cause'] is Cause.REPEATS


@pytest.mark.parametrize(('zero', 'ends'), [(2.0, [-8.0, 12.0]), (1.0, [])])
def test_zero_of_a_torque_sensor_is_questioned_where_its_peaks_differ(report_of, zero, ends):
    torque = ramps(*[(10.0, 200)] * 3)
    report = report_of(angle=creep(GEAR, torque), torque=torque + zero)
    found = [each for each in remarks(report) if each.what is Observation.UNEQUAL_PEAKS]
    assert [end for each in found for end in each.values.values()] == pytest.approx(ends)


def test_ramps_in_which_friction_holds_the_gear_tell_nothing(report_of):
    torque = ramps(*[(4.0, 200)] * 5, *[(40.0, 2000)] * 3)
    held = Gear(play=0.0, stiffness=300.0, friction=4.5)
    width = answer(report_of(angle=creep(held, torque), torque=torque)).values['hysteresis']
    assert width.value == pytest.approx(2.0 * 4.5 / 300.0, rel=1e-3)


@pytest.mark.parametrize('rows', [0, 15])
def test_a_torque_that_is_later_than_the_angle_makes_the_hysteresis_negative(report_of, rows):
    angle = creep(Gear(play=0.0, stiffness=300.0, friction=0.1), SMALL)
    late = np.concatenate([np.zeros(rows), SMALL])[: len(SMALL)]
    report = report_of(angle=angle, torque=late)
    assert (answer(report).what is Observation.NEGATIVE_HYSTERESIS) == (rows > 0)
    (judged,) = Limits(hysteresis=1.0).judge(report)
    assert judged.holds == (rows == 0)


def test_figures_that_their_uncertainty_exceeds_stand_out():
    for value, tone in ((0.03, Tone.PLAIN), (0.01, Tone.NOTABLE)):
        assert Measured('a', 'rad', Estimate(value, 0.01, 9.0, 10)).cell.tone == tone


@pytest.mark.parametrize(
    ('value', 'spread', 'written'),
    [
        (93.3456, 1.3789, '93.3 ± 1.4'),
        (0.00123456, 0.000021, '0.001235 ± 0.000021'),
        (-0.004, 0.5, '0.00 ± 0.50'),
        (531.7, 134.2, '532 ± 134'),
        (2.0, 0.0, '2 ± 0'),
        (1 / 3, 2e-13, '0.33333333333333 ± 2e-13'),
        (49 / 3, 9.2e-6, '16.3333333 ± 9.2e-6'),
        (-19.0, 7e-5, '-19 ± 7e-5'),
        (1 / 3, 1e-30, '0.3333333333333333 ± 1e-30'),
        (3e-15, 4.4e-14, '3e-15 ± 4.4e-14'),
    ],
)
def test_values_are_written_to_the_second_digit_of_their_uncertainty(value, spread, written):
    normal = Estimate.of_mean([value] * 9, Component(spread / 1.959964))
    assert plus_minus(normal) == written


def test_lost_motion_is_not_told_where_its_uncertainty_says_nothing(shared_path, config):
    path = shared_path('data/faults/both_encoders_clean.csv')
    found = answer(measure(read(path, config), config))
    assert found.what is Observation.LOSES
    assert found.values['lost'].value == pytest.approx(6.9 * ARC_MINUTE, rel=0.002)
    # A step of a quarter of a turn, 284 arcmin at the output.
    report = measure(read(path, config, Sources(rotor_counts=4)), config)
    assert (report.transmission.lost_motion, report.transmission.reversals) == (None, None)
    assert answer(report).what is Observation.LOSS_NOT_TOLD


@pytest.mark.parametrize(('drift', 'differ'), [(0.0, False), (0.01, True)])
def test_loops_that_differ_by_more_than_their_width_tell_nothing(report_of, drift, differ):
    """An angle that steps at random, as where it slips: 34′ beside a hysteresis of 2.3′."""
    torque = ramps(*[(4.0, 200)] * 5)
    angle = creep(Gear(play=0.0, stiffness=300.0, friction=0.1), torque)
    steps = np.repeat(np.random.default_rng(1).normal(size=50), len(angle) // 50 + 1)
    report = report_of(angle=angle + drift * steps[: len(angle)], torque=torque)
    assert (answer(report).what is Observation.LOOPS_DIFFER) == differ


@pytest.mark.parametrize(
    ('amplitude', 'late', 'what', 'said'),
    [
        (2.0, 0.0, Observation.LOSES, []),
        (2.0, 0.004, Observation.LOSES, [Observation.DELAY_TAKEN_OUT]),
        (1e-3, 0.0, Observation.HARDLY_MOVES, []),  # rad, less than a reversal needs
    ],
)
def test_delay_is_said_and_too_small_a_motion_tells_nothing(
    report_of, amplitude, late, what, said
):
    time = np.arange(4000) * 0.005
    rotor, output = (amplitude * np.sin(t) for t in (time, time - late))
    error = 5e-5 * np.sin(19.0 * output)  # rad, once per turn of the rotor
    report = report_of(time=time, rotor=-19.0 * rotor, output=output + error)
    assert answer(report).what is what
    assert [found.what for found in remarks(report)] == [*said, Observation.PLUS_MINUS]


@pytest.mark.parametrize('late', [0.2, 0.5])  # s
def test_lost_motion_is_right_however_late_the_output_is(report_of, shared_path, late):
    path = shared_path('data/faults/both_encoders_clean.csv')  # with a lost motion of 6.9′
    time, rotor, output = np.loadtxt(path, delimiter=',', skiprows=1).T
    delayed = np.interp(time - late, time, output)
    found = report_of(time_s=time, rotor_rad=rotor, output_rad=delayed).transmission
    assert found.delay.value == pytest.approx(late, abs=1e-4)
    assert abs(found.lost_motion.value - 6.9 * ARC_MINUTE) <= found.lost_motion.expanded


@pytest.mark.parametrize(('speed', 'scatters'), [(0.2, False), (40.0, True)])
def test_what_the_moments_of_reading_add_is_not_called_an_error_of_the_gear(
    report_of, speed, scatters
):
    """The gear deviates by 17′; messages of the output come up to 3 ms late, in which it turns."""
    random = np.random.default_rng(4)
    time = 0.01 * np.arange(4000)
    late = random.uniform(0.0, 3e-3, len(time))
    turned, seen = (speed * np.sin(0.3 * when) / 0.3 for when in (time, time + late))
    output = seen + 2.5e-3 * np.sin(seen)
    report = report_of(time=time, rotor=-19.0 * turned, output=output)
    assert (answer(report).what is Observation.SCATTERS) is scatters


@pytest.mark.parametrize('bits', [10, 14])
def test_steps_of_an_encoder_are_not_said_to_scatter(report_of, bits):
    """Readings jump by a step there and back, by more than the gear deviates."""
    time, step = 0.01 * np.arange(4000), 2.0 * math.pi / 2**bits
    turned = 2.0 * np.sin(0.3 * time)
    output = turned + 2.0 * ARC_MINUTE / 2 ** (bits - 10) * np.sin(turned)
    stepped = step * np.round(output / step)
    report = report_of(time=time, rotor=-19.0 * turned, output=stepped)
    assert answer(report).what is not Observation.SCATTERS
