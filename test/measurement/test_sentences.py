# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a measurement says: all sentences in one document."""

from fractions import Fraction
from pathlib import Path

from gear_kinematics.measurement.sentences import Cause, Observation
from gear_kinematics.statistics.uncertainty import Estimate

GOLDEN = Path(__file__).with_name('sentences.txt')
ANGLE = Estimate(0.002, 1e-5, 9.0, 10)
"""6.875 ± 0.078 arc minutes: 1e-5 rad times 2.262, Student's t of 9 degrees of freedom."""
VALUES = {
    'timed': True,
    'moments': [12.3456789, 20.5, 31.0],
    'moment': 12.3456789,
    'more': 2,
    'count': 3,
    'spans': ['28 to 30.36 s', '36 to 36.76 s'],
    'angle': 0.05,
    'first': 1.0,
    'last': 12.3456789,
    'deviation': 1.5e-6,
    'size': 25.1327412,
    'stamp': 1_700_000_000_123_456_789,
    'seconds': 35.96,
    'topic': '/rotor_state',
    'cause': Cause.SOFT,
    'every': 4,
    'rows': 12,
    'column': 'time_s',
    'times': 5,
    'why': 'the output does not turn',
    'assumed': Fraction(-19),
    'given': Fraction(-30),
    'ratio': Fraction(-58, 3),
    'measured': Estimate(-19.3333, 0.0004, 9.0, 10),
    'candidates': [Fraction(-58, 3), Fraction(-39, 2)],
    'degrees': 390,
    'advice': Observation.SAMPLE_TOGETHER(),
    'hysteresis': ANGLE,
    'play': ANGLE,
    'error': ANGLE,
    'lost': ANGLE,
    'delay': Estimate(0.0012, 1e-5, 9.0, 10),
    'low': 0.0005,
    'high': 0.001234,
    'torque': 2.3456,
    'friction': 0.1,
    'figure': 'hysteresis',
    'value': '6.875 ± 0.078′',
    'limit': '7′',
    'evidence': Observation.SENSE_KEPT(),
    'teeth': ['80/76', '160/152'],
    'wraps': 1,
    'turns': 4,
    'ranges': '25 and 25.1',
    'sense': Observation.SAME_SENSE(),
    'recording': 'monday',
    'spread': 0.01,
    'speed': 123.456,
    'rotor': 999.98,
    'output': 500.0,
    'target': 'actuator.yaml',
    'changes': 'rotor_direction is 1, not -1',
    'answer': Observation.NOT_LATE(),
    'before': 0.00123,
    'after': 0.0001,
    'half_width': 0.0002,
    'inside': 95.04,
    'term': 'wind-up',
    'cycles': 1.2345,
    'percent': 12.34,
    'left': 0.0005,
    'often': 'once per output turn',
    'source': 'the given parameters',
    'time': '20 s',
    'needed': 1.2345,
    'preload': 2.0,
    'total': 0.51,
    'start': 1.2345,
    'question': 'the effort is 0 throughout',
    'branch': 'a',
    'duration': 0.25,
    'causes': ['joint missing 12', 'not a JointState 1'],
    'rating': 5000.0,
    'second': 'with preload',
    'clear': 2,
    'judgement': 'significant',
    'names': ['monday', 'tuesday'],
}


def test_every_observation_has_its_sentence():
    written = [f'{what.name}: {what(**VALUES)}' for what in Observation]
    assert written == GOLDEN.read_text('utf-8').splitlines()


def test_counts_have_their_nouns_and_moments_of_samples_no_unit():
    assert str(Observation.STRAY(timed=False, moments=[7.0], more=0, count=1)) == (
        '1 reading that contradicts both neighbours left out, at sample 7'
    )
    assert Observation.JUMPED_FURTHER(count=1).sentence == (
        '1 further jump of the output against the rotor.'
    )
