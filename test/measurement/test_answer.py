# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a report says of a recording: its answer, its remarks, and what became of limits."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps, write_csv

from gear_kinematics.measurement.answer import Limits, answer, remarks
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.measured import Measured
from gear_kinematics.measurement.middle_line import Backlash, Cause
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.wording import rounded
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
    ('name', 'limit', 'holds', 'said'),
    [
        ('hysteresis', 33.5 * ARC_MINUTE, True, 'is within the limit of 33.5′'),
        ('hysteresis', 32.0 * ARC_MINUTE, False, 'is beyond the limit of 32′'),
        ('backlash', 10.5 * ARC_MINUTE, True, 'is within the limit'),
        ('backlash', 10.0 * ARC_MINUTE, False, 'may be beyond the limit of 10′'),
        ('backlash', 9.0 * ARC_MINUTE, False, 'is beyond the limit of 9′'),
        ('lost_motion', 1.0, True, 'is within'),
        ('lost_motion', 1e-4, False, 'is beyond'),
        ('stiffness', 290.0, True, 'is within the limit of 290 N·m/rad'),
        ('stiffness', 310.0, False, 'is beyond the limit of 310 N·m/rad'),
    ],
)
def test_limits_are_held_exceeded_or_not_shown(report, name, limit, holds, said):
    (judged,) = Limits(**{name: limit}).judge(report)
    assert (judged.holds, said in judged.text) == (holds, True), judged.text


def test_what_is_not_known_holds_no_limit(report_of):
    ideal = 0.01 * np.arange(400)
    output = ideal + 1e-5 * np.sin(ideal)
    judged = Limits(1.0, 1.0, 1.0, 1.0).judge(report_of(rotor=-19.0 * ideal, output=output))
    assert len(judged) == 4
    assert not any(one.holds for one in judged)
    assert all('is not known' in one.text for one in judged)


@pytest.mark.parametrize('name', ['hysteresis', 'stiffness', 'backlash'])
def test_a_limit_cannot_be_shown_to_hold_where_the_uncertainty_is_unknown(report_of, name):
    torque = ramps((40.0, 400))
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    limits = {'stiffness': 1.0} | dict.fromkeys(['hysteresis', 'backlash'], 1.0)
    (judged,) = Limits(**{name: limits[name]}).judge(report)
    assert not judged.holds
    said = 'is not known' if name == 'backlash' else 'cannot be shown to hold the limit'
    assert said in judged.text


@pytest.mark.parametrize(('amplitude', 'below'), [(4.0, True), (40.0, False)])
def test_lost_motion_below_the_friction_is_said_and_not_judged(report_of, amplitude, below):
    torque = ramps(*[(amplitude, 400)] * 5)  # read at 0.12 or 1.2 N·m; friction is 1 N·m
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    (judged,) = Limits(lost_motion=1.0).judge(report)
    assert judged.holds != below
    assert ('cannot be judged: it is read at a torque below the friction' in judged.text) == below
    assert ('below the friction of 1' in ' '.join(remarks(report))) == below


@pytest.mark.parametrize(
    ('friction', 'said'),
    [
        (0.5, '′ is play, the rest friction.'),
        # Of 4 N·m: the spring beyond the play is hardly loaded.
        (3.9, 'How much of it is play is not known; to separate them, ramp to a torque of at'),
    ],
)
def test_the_answer_is_a_sentence_for_who_must_decide(report_of, friction, said):
    report = report_of(angle=creep(GEAR._replace(friction=friction), SMALL), torque=SMALL)
    sentence = answer(report)
    assert sentence.startswith('At zero torque the output rests anywhere within ')
    assert said in sentence
    wide = Backlash(0.0, 0.132 * ARC_MINUTE, Cause.REPEATS)
    figures = replace(report.figures, backlash=wide)
    assert '′; backlash: 0 to 0.13′, the rest ' in answer(replace(report, figures=figures))


def test_remarks_tell_what_a_single_loop_cannot(report_of):
    torque = ramps((4.0, 200))
    report = report_of(angle=creep(GEAR, torque), torque=torque)
    said = ' '.join(remarks(report))
    assert 'All ramps have about one amplitude' in said
    assert 'Inferred, not measured' in said
    assert 'to separate them, repeat the ramps five times or more' in answer(report)


@pytest.mark.parametrize(('zero', 'said'), [(2.0, 'The torque goes from -8 to 12 N·m'), (1.0, '')])
def test_zero_of_a_torque_sensor_is_questioned_where_its_peaks_differ(report_of, zero, said):
    torque = ramps(*[(10.0, 200)] * 3)
    report = report_of(angle=creep(GEAR, torque), torque=torque + zero)
    found = [text for text in remarks(report) if 'its sensor reads 0' in text]
    assert [text.partition(':')[0] for text in found] == [said] * bool(said)


def test_ramps_in_which_friction_holds_the_gear_tell_nothing(report_of):
    torque = ramps(*[(4.0, 200)] * 5, *[(40.0, 2000)] * 3)
    held = Gear(play=0.0, stiffness=300.0, friction=4.5)
    sentence = answer(report_of(angle=creep(held, torque), torque=torque))
    within = 2.0 * 4.5 / 300.0 / ARC_MINUTE
    assert sentence.startswith(f'At zero torque the output rests anywhere within {within:.1f}')


@pytest.mark.parametrize('rows', [0, 15])
def test_a_torque_that_is_later_than_the_angle_makes_the_hysteresis_negative(report_of, rows):
    angle = creep(Gear(play=0.0, stiffness=300.0, friction=0.1), SMALL)
    late = np.concatenate([np.zeros(rows), SMALL])[: len(SMALL)]
    report = report_of(angle=angle, torque=late)
    assert answer(report).startswith('The hysteresis is negative') == (rows > 0)
    (judged,) = Limits(hysteresis=1.0).judge(report)
    assert judged.holds == (rows == 0)


def test_figures_that_their_uncertainty_exceeds_stand_out():
    for value, tone in ((0.03, Tone.PLAIN), (0.01, Tone.NOTABLE)):
        assert Measured('a', 'rad', Estimate(value, 0.01, 9.0, 10)).cell.tone == tone


@pytest.mark.parametrize(
    ('value', 'spread', 'written'),
    [
        (93.3456, 1.3789, ('93.3', '1.4')),
        (0.00123456, 0.000021, ('0.001235', '0.000021')),
        (-0.004, 0.5, ('0.00', '0.50')),
        (531.7, 134.2, ('532', '134')),
        (2.0, 0.0, ('2', '0')),
        (1 / 3, 1e-13, ('0.333333', '1e-13')),
        (3e-15, 4.4e-14, ('3e-15', '4.4e-14')),
    ],
)
def test_values_are_written_to_the_second_digit_of_their_uncertainty(value, spread, written):
    normal = Estimate.of_mean([value] * 9, Component(spread / 1.959964))
    assert rounded(normal, 1.0) == written


def test_lost_motion_is_not_told_where_its_uncertainty_says_nothing(shared_path, config):
    path = shared_path('data/faults/both_encoders_clean.csv')
    assert re.search(
        r'on reversals it loses 6\.(89|9)', answer(measure(read(path, config), config))
    )
    # A step of a quarter of a turn, 284 arcmin at the output.
    report = measure(read(path, config, Sources(rotor_counts=4)), config)
    assert (report.transmission.lost_motion, report.transmission.reversals) == (None, None)
    assert answer(report).endswith('what it loses on reversals cannot be told.')
