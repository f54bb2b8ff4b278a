# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error of recordings whose errors are known."""

import math

import numpy as np
import pytest
from gear_recordings import Samples, write_csv, write_recording
from simulated_encoders import (
    ARC_MINUTE,
    MS,
    START,
    TURN,
    Drive,
    even_strokes,
    sine_strokes,
    stepped,
)

from gear_kinematics.correction.transmission_error import Direction
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.measurement.two_encoders import directions

PLAY = 3e-3
AMPLITUDES = {19: 1.0e-3, 20: 4e-4, 2: 5e-4, 1520: 2e-4}  # by order
RATE = 1000.0
SPEED = 1.0  # rad/s of the output


def there_and_back(turns: float, times: int) -> np.ndarray:
    """Output angles at an even speed, to `turns` and back."""
    seconds = turns * TURN / SPEED
    time = np.arange(round(2 * times * seconds * RATE) + 1) / RATE
    return even_strokes(turns * TURN, seconds)(time)


def bag_of(path, ideal, *, rotor_counts=2**16, output_counts=2**20, efforts=None, offset=1.0):
    """Record the rotor at 1 kHz, and a single-turn output encoder a third of a sample later."""
    stamps = START + np.arange(len(ideal)) * MS
    rotor = Samples(stamps, stepped(-19.0 * ideal, TURN / rotor_counts), efforts)
    later = ideal[:-1] + np.diff(ideal) / 3.0
    output = Drive(PLAY, AMPLITUDES).output(later) + offset
    measured = stepped(output % TURN, TURN / output_counts)
    return write_recording(path, rotor, Samples(stamps[:-1] + MS // 3, measured))


@pytest.fixture(scope='module')
def recording(tmp_path_factory, config):
    path = bag_of(tmp_path_factory.mktemp('bags') / 'motion', there_and_back(2.2, 2))
    return read(path, config)


@pytest.fixture(scope='module')
def found(recording, config):
    return measure(recording, config).transmission


@pytest.mark.slow
def test_lost_motion_on_reversals_is_the_play(found):
    assert (found.offset, found.travel) == pytest.approx((1.0, 2.2 * TURN), rel=1e-3)
    # At one speed, play cannot be told from a delay, of which there is none.
    assert found.lost_motion is None
    assert found.reversals.repeats == 2
    assert abs(found.reversals.value - PLAY) <= found.reversals.uncertainty < 2e-5


@pytest.mark.slow
def test_accuracy_is_peak_to_peak_in_one_direction(found):
    ideal = np.linspace(0.0, 2.2 * TURN, 200_000)
    errors = sum(a * np.sin(order * ideal + order) for order, a in AMPLITUDES.items())
    for way in (found.forward, found.backward):
        assert way.repeats == 2
        assert way.value == pytest.approx(np.ptp(errors), abs=2e-5)


@pytest.mark.parametrize('ways', [-1.0, 2.0])
def test_output_that_does_not_follow_is_refused(tmp_path, config, ways):
    ideal = there_and_back(0.8, 1)
    path = write_csv(tmp_path / 'wrong.csv', rotor=-19.0 * ideal, output=ways * ideal)
    with pytest.raises(RecordingError, match='does not follow the rotor'):
        measure(read(path, config), config)


@pytest.mark.parametrize(
    ('rotor', 'encoder', 'cause'),
    [
        ([0, 1], [-5, -4], 'no output angle was measured between two rotor'),
        ([0] * 9 + [1000], [1, 2], '/rotor_state: 8 of 10 stamps repeat the one before'),
        ([0, 1], [0] * 9 + [1], '/output_encoder: 8 of 10 stamps repeat the one before'),
    ],
)
def test_recording_without_usable_stamps_is_refused(tmp_path, config, rotor, encoder, cause):
    states = (
        Samples([START + ms * MS for ms in stamps], [0.1 * k for k in range(len(stamps))])
        for stamps in (rotor, encoder)
    )
    path = write_recording(tmp_path / 'stamps', *states)
    with pytest.raises(RecordingError, match=cause):
        read(path, config)


def test_recording_without_a_number_of_the_output_is_refused(tmp_path, config):
    rotor, output = (Samples([START, START + MS], [k, k]) for k in (0.0, math.nan))
    path = write_recording(tmp_path / 'nan', rotor, output)
    with pytest.raises(RecordingError, match='no output angle was measured'):
        read(path, config)


@pytest.mark.slow
def test_twist_is_measured_with_both_encoders(tmp_path, config):
    """The output turns under load; only the twist of the gear counts."""
    gear_stiffness, bench_stiffness, friction = 400.0, 50.0, 0.5
    torque = 8.0 * np.sin(np.arange(8000) * TURN / 2000)
    load = Drive(2.0 * friction).output(torque)  # less friction: a stop like that of play
    bench, gear = load / bench_stiffness, load / gear_stiffness
    stamps = START + np.arange(len(torque)) * MS
    rotor = Samples(stamps, -19.0 * (bench + gear), torque / -19.0)
    path = write_recording(tmp_path / 'loaded', rotor, Samples(stamps, bench))
    report = measure(read(path, config), config)
    figures = report.figures
    assert report.measured
    assert figures.stiffness[-1].slope.value == pytest.approx(gear_stiffness, rel=0.01)
    assert figures.hysteresis.value == pytest.approx(2.0 * friction / gear_stiffness, rel=0.02)
    assert report.transmission is not None


@pytest.mark.parametrize('play', [45.0, 90.0])
def test_lost_motion_of_more_than_a_travel_of_one_degree_is_the_play(tmp_path, config, play):
    """With 90', 86.4 ± 1.0' were found, as a third was left to cross where counting began."""
    drive = Drive(play=play * ARC_MINUTE, errors={1.0: 2.0 * ARC_MINUTE}, noise=2e-5)
    time, rotor, output = drive.readings(sine_strokes(math.radians(150.0), 4.0), 40.0, 100.0)
    path = tmp_path / 'both.csv'
    write_csv(path, time_s=time, rotor_rad=rotor, output_rad=output)
    lost = measure(read(path, config), config).transmission.lost_motion
    assert lost.expanded < 0.5 * ARC_MINUTE
    assert lost.value == pytest.approx(play * ARC_MINUTE, abs=lost.expanded)


@pytest.mark.parametrize(('travel', 'starts'), [(0.0, ()), (3.0, (0, 5000)), (20.5, (7, 4096))])
def test_directions_of_a_recording_are_those_that_a_node_finds(travel, starts):
    path = np.cumsum(np.random.default_rng(2).integers(-3, 4, 9000)).astype(float)
    one_by_one = Direction(travel)
    expected = []
    for row, step in enumerate(np.diff(path, prepend=path[0]).tolist()):
        if row in starts:
            one_by_one.reset()
        expected.append(one_by_one.move(step))
    assert len(set(expected)) == 1 + 2 * (travel > 0.0)
    np.testing.assert_array_equal(directions(path, travel, starts), expected)
