# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a measurement says: all sentences in one document."""

from pathlib import Path

from placeholders import filled

from gear_kinematics.measurement.sentences import Cause, Observation
from gear_kinematics.statistics.uncertainty import Estimate

GOLDEN = Path(__file__).with_name('sentences.txt')
ANGLE = Estimate(0.002, 1e-5, 9.0, 10)
"""6.875 ± 0.078 arc minutes: 1e-5 rad times 2.262, Student's t of 9 degrees of freedom."""
VALUES = {
    'moments': [12.3456789, 20.5, 31.0],
    'spans': ['28 to 30.36 s', '36 to 36.76 s'],
    'hysteresis': ANGLE,
    'error': ANGLE,
    'cause': Cause.SOFT,
}


def test_every_observation_has_its_sentence():
    own = 'at', 'unit', 'coverage'
    found = [what(timed=True, **filled(what.value, own, **VALUES)) for what in Observation]
    written = [f'{each.what.name}: {each}' for each in found]
    assert written == GOLDEN.read_text('utf-8').splitlines()


def test_counts_have_their_nouns_and_moments_of_samples_no_unit():
    assert str(Observation.STRAY(timed=False, moments=[7.0], more=0, count=1)) == (
        'left out: 1 reading that contradicts both neighbours, at sample 7'
    )
    assert Observation.JUMPED_FURTHER(count=1).sentence == (
        '1 further jump of the output against the rotor.'
    )
