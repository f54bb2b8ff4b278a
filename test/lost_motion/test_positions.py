"""One result from several positions of the output."""

import math

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps, write_csv

from gear_kinematics.lost_motion import Columns, measure, read_csv
from gear_kinematics.lost_motion.several.common import at_common_torque
from gear_kinematics.lost_motion.several.comparison import Group, at_positions
from gear_kinematics.lost_motion.several.positions import DEFAULT_PATTERN, over_positions

PLAYS = {'1': 0.010, '2': 0.014, '3': 0.011}
STIFFNESS, FRICTION = 300.0, 0.8


@pytest.mark.parametrize(
    ('names', 'pattern', 'groups', 'positions'),
    [
        (['gear_position_1.csv', 'gear_position_2.csv'], DEFAULT_PATTERN,
         [Group('gear.csv', (0, 1))], ['1', '2']),
        (['a_pos1.csv', 'b_pos1.csv', 'a_pos2.csv', 'b_pos2.csv'], DEFAULT_PATTERN,
         [Group('a.csv', (0, 2)), Group('b.csv', (1, 3))], ['1', '1', '2', '2']),
        (['g at90deg.csv', 'g at180deg.csv'], r'at(\d+)deg',
         [Group('g.csv', (0, 1))], ['90', '180']),
    ],
)  # fmt: skip
def test_names_that_differ_in_the_position_alone_are_of_one_gear(
    names, pattern, groups, positions
):
    assert at_positions(names, pattern) == (groups, positions)


@pytest.mark.parametrize(
    ('names', 'pattern', 'complaint'),
    [
        (['a.csv'], DEFAULT_PATTERN, 'there is no position in the name a.csv'),
        (
            ['a_pos1.csv', 'b_pos1.csv'],
            DEFAULT_PATTERN,
            'no two recordings differ in the position',
        ),
        (['a_pos1.csv', 'a_pos2.csv'], r'pos\d', 'needs one group in parentheses, not 0'),
        (['a_pos1.csv', 'a_pos2.csv'], '(', '--positions (: '),
    ],
)
def test_positions_that_cannot_be_found_are_refused(names, pattern, complaint):
    with pytest.raises(ValueError, match='--positions') as caught:
        at_positions(names, pattern)
    assert complaint in str(caught.value)


@pytest.fixture(scope='module')
def reports(tmp_path_factory, actuator):
    folder = tmp_path_factory.mktemp('positions')
    torque = ramps(*[(5.0, 100)] * 3, (40.0, 100))
    found = []
    for position, play in PLAYS.items():
        angle = creep(Gear(play, STIFFNESS, FRICTION), torque)
        path = write_csv(folder / f'gear_position_{position}.csv', angle=angle, torque=torque)
        found.append(measure(read_csv(path, actuator, Columns(), 0.017), actuator))
    return at_common_torque(found, None, None)


def test_positions_have_a_mean_and_a_spread(reports):
    combined = over_positions(reports, [Group('gear.csv', (0, 1, 2))], list(PLAYS))
    found = {item['figure']: item for item in combined.data['positions']}['hysteresis']
    # In the model the hysteresis is play + 2 friction / stiffness.
    width = 2.0 * FRICTION / STIFFNESS
    plays = np.array(list(PLAYS.values()))
    assert found['mean'].value == pytest.approx(plays.mean() + width, abs=2e-5)
    # Three values have two degrees of freedom: Student's factor is 4.303.
    spread = 4.303 * plays.std(ddof=1) / math.sqrt(3.0)
    assert found['mean'].uncertainty == pytest.approx(spread, rel=0.01)
    assert found['least'] == {'value': pytest.approx(0.010 + width, abs=2e-5), 'position': '1'}
    assert found['greatest'] == {'value': pytest.approx(0.014 + width, abs=2e-5), 'position': '2'}
    assert found['spread'] == pytest.approx(0.004, abs=2e-5)
    assert found['positions'] == 3
    assert combined.sentence.startswith('over 3 positions: hysteresis ')


def test_repeats_at_a_position_count_as_one(reports):
    positions = ['1', '2', '2']
    combined = over_positions(reports, [Group('gear.csv', (0, 1, 2))], positions)
    found = combined.data['positions'][0]
    width = 2.0 * FRICTION / STIFFNESS
    assert found['positions'] == 2
    assert found['mean'].value == pytest.approx((0.010 + 0.0125) / 2 + width, abs=2e-5)
