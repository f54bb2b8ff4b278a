"""Rates of ramps, and the doubts about figures of recordings with different rates."""

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps, write_csv

from gear_kinematics.lost_motion import Columns, measure, read_csv
from gear_kinematics.lost_motion.several.common import at_common_torque, basis, doubts
from gear_kinematics.lost_motion.several.compared import compared
from gear_kinematics.lost_motion.static.ramps import find_ramps
from gear_kinematics.lost_motion.static.rate import rates

GEAR = Gear(play=0.01, stiffness=300.0, friction=0.8)
TORQUE = ramps(*[(5.0, 100)] * 3, *[(40.0, 200)] * 2)


@pytest.fixture(scope='module')
def angle():
    return creep(GEAR, TORQUE)


def even_clock(per_second: float) -> np.ndarray:
    """Times at which the torque has changed by so much per second, with rests at the peaks."""
    travel = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(TORQUE)))])
    return travel / per_second + 1e-6 * np.arange(len(TORQUE))


def test_rate_and_duration_of_ramps(angle):
    small, large = rates(find_ramps(TORQUE, angle, even_clock(2.5)))
    assert small.rate == pytest.approx(2.5, rel=0.01)
    assert small.duration == pytest.approx(4 * 5.0 / 2.5, rel=0.02)
    assert large.rate == pytest.approx(2.5, rel=0.01)
    assert large.duration == pytest.approx(4 * 40.0 / 2.5, rel=0.02)


def test_small_ramps_have_their_own_rate_though_the_last_one_goes_on_faster(angle):
    rows = np.arange(len(TORQUE))
    seconds = np.where(rows < 1200, 0.02, 0.04)  # 5 N·m in 100 rows, 40 N·m in 200
    small, large = rates(find_ramps(TORQUE, angle, np.cumsum(seconds)))
    assert small.rate == pytest.approx(2.5, rel=0.01)
    assert large.rate == pytest.approx(5.0, rel=0.01)


def test_without_times_there_is_no_rate(angle):
    assert rates(find_ramps(TORQUE, angle)) == (None, None)


@pytest.fixture(scope='module')
def report_at(tmp_path_factory, actuator, angle):
    def build(name: str, per_second: float):
        folder = tmp_path_factory.mktemp('rates')
        columns = {'angle': angle, 'torque': TORQUE, 'time': even_clock(per_second)}
        path = write_csv(folder / f'{name}.csv', **columns)
        return measure(read_csv(path, actuator, Columns(), 0.017), actuator)

    return build


def test_different_rates_are_told_with_their_numbers(report_at):
    reports = at_common_torque([report_at('slow', 2.0), report_at('fast', 5.0)], None, None)
    said = [text for text in doubts(reports, basis(reports)) if 'equally fast' in text]
    assert len(said) == 2
    assert 'slow.csv with 2 N·m/s, 10 s a loop to 5 N·m' in said[0]
    assert 'fast.csv with 5 N·m/s, 4 s a loop to 5 N·m' in said[0]
    assert 'lost motion and stiffness' in said[1]
    assert compared(reports).sentence.endswith('; at different rates of the torque')


def test_rates_of_the_same_command_raise_no_doubt(report_at):
    reports = at_common_torque([report_at('one', 4.0), report_at('two', 4.5)], None, None)
    assert not any('equally fast' in text for text in doubts(reports, basis(reports)))
    assert 'rates' not in compared(reports).sentence
