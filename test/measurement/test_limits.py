"""Limits of a gear: judged at the end of the interval that speaks against it."""

import math

import pytest
from gear_recordings import Gear, creep, ramps, write_csv

from gear_kinematics.measurement.answer import answer
from gear_kinematics.measurement.limits import Limits
from gear_kinematics.measurement.lost_motion import Request, measure
from gear_kinematics.measurement.reading import read

ARC_MINUTE = math.radians(1.0 / 60.0)
GEAR = Gear(play=10.0 * ARC_MINUTE, stiffness=300.0, friction=1.0)  # hysteresis 32.9′


@pytest.fixture(scope='module')
def report(tmp_path_factory, config, actuator):
    torque = ramps(*[(4.0, 200)] * 5, *[(40.0, 400)] * 3)
    path = tmp_path_factory.mktemp('limits') / 'ramps.csv'
    write_csv(path, angle=creep(GEAR, torque), torque=torque)
    return measure(read(path, config), actuator, config, Request())


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


def test_a_limit_within_the_uncertainty_cannot_be_shown(report):
    value = report.figures.largest.stiffness[-1].both
    (judged,) = Limits(stiffness=value.value - 0.5 * value.uncertainty).judge(report)
    assert not judged.holds
    assert 'may be beyond' in judged.text


def test_the_answer_is_a_sentence_for_who_must_decide(report):
    said = answer(report)
    assert said.startswith('At zero torque the output rests anywhere within 32.')
    assert '′ is play, the rest friction.' in said


def test_what_is_not_known_holds_no_limit(tmp_path, config, actuator):
    ideal = [0.01 * k for k in range(400)]
    path = write_csv(tmp_path / 'r.csv', rotor=[-19.0 * x for x in ideal], output=ideal)
    report = measure(read(path, config), actuator, config, Request())
    for judged in Limits(1.0, 1.0, 1.0, 1.0).judge(report):
        assert not judged.holds
        assert 'is not known' in judged.text
