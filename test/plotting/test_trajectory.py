# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor's motion over time: read from bags, or at a constant speed."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gear_recordings import Samples, write_recording
from shipped_bags import ROTOR, write_bag

from gear_kinematics.bag import BagError
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.plotting.recorded import read_trajectory
from gear_kinematics.plotting.trajectory import MOST_TURNS, Trajectory
from gear_kinematics.share import share_directory
from gear_kinematics.wire.cdr import JointStateTemplate

MS = 1_000_000  # ns
TURN = 2.0 * math.pi


def config(**changes) -> NodeParameters:
    wide = {'max_rotor_speed': 1e6, 'max_rotor_acceleration': 1e9}
    return replace(NodeParameters.load(), **(wide | changes))


def positions(trajectory: Trajectory) -> np.ndarray:
    return TURN * trajectory.turns + trajectory.angle


def test_recorded_positions_are_those_of_the_rotor(tmp_path):
    stamps = [5_000 * MS, 5_010 * MS, 5_030 * MS]
    bag = write_recording(tmp_path / 'bag', Samples(stamps, [1.0, 2.0, 40.0]))
    read = read_trajectory(bag, config(rotor_direction=-1, rotor_zero=0.5))
    assert read.time == pytest.approx([0.0, 0.01, 0.03], abs=1e-15)
    assert positions(read) == pytest.approx([-0.5, -1.5, -39.5], abs=1e-12)
    # Without velocities: the slopes, in the middle weighted for uneven intervals.
    middle = (-1.0 / 0.01) * 2 / 3 + (-38.0 / 0.02) / 3
    assert read.velocity == pytest.approx([-100.0, middle, -1900.0])


def test_recorded_velocities_are_taken():
    read = read_trajectory(share_directory() / 'bags' / 'constant_speed_3000rpm', config())
    assert read.velocity == pytest.approx(100.0 * math.pi, abs=1.0)
    assert len(set(read.velocity.tolist())) > 100  # the noise of the recording


def test_a_stamp_counts_once_and_a_jump_back_ends_the_motion(tmp_path):
    stamps = [7_000 * MS, 7_001 * MS, 7_001 * MS, 7_002 * MS, 3_000 * MS, 3_001 * MS]
    template = JointStateTemplate(['rotor'], velocity=False, effort=False)
    samples = enumerate(zip(stamps, [0.0, 1.0, 9.0, 2.0, 5.0, 6.0], strict=True))
    messages = [(ROTOR, k, template.encode(stamp, [angle])) for k, (stamp, angle) in samples]
    read = read_trajectory(write_bag(tmp_path / 'bag', messages), config())
    assert read.time == pytest.approx([0.0, 0.001, 0.002])
    assert positions(read) == pytest.approx([0.0, 1.0, 2.0])


def test_faulty_messages_are_ignored():
    read = read_trajectory(share_directory() / 'bags' / 'driver_faults', config())
    assert np.all(np.diff(read.time) > 0.0)
    assert np.all(np.isfinite(positions(read)) & np.isfinite(read.velocity))


def test_huge_positions_give_no_warning(tmp_path, actuator):
    rotor = Samples([MS, MS + 1, 2 * MS, 3 * MS], [1.4e16, 1.4e16, 1.4e16, 1e300])
    read = read_trajectory(write_recording(tmp_path / 'bag', rotor), config())
    assert len(read.time) == 3
    assert np.all(np.isfinite(positions(read)))
    assert np.all(np.abs(read.state(actuator).oldham_centre) <= 0.0011)


def test_bags_without_a_motion_are_refused(tmp_path):
    still = write_recording(tmp_path / 'still', Samples([MS, MS], [0.0, 1.0]))
    with pytest.raises(BagError, match='/rotor_state has fewer than two rotor states'):
        read_trajectory(still, config())


def test_constant_speed_turns_from_zero(actuator):
    backwards = Trajectory.at_constant_speed(-50.0, turns=3)
    assert positions(backwards) == pytest.approx(-50.0 * backwards.time, abs=1e-12)
    assert positions(backwards)[[0, -1]] == pytest.approx([0.0, -3.0 * TURN])
    assert len(backwards.time) == 3 * 360 + 1
    state, expected = (
        backwards.state(actuator),
        matrix_method.solve(actuator, -50.0 * backwards.time, -50.0),
    )
    for field in ('output_angle', 'oldham_centre', 'satellite_velocity'):
        assert getattr(state, field) == pytest.approx(getattr(expected, field), abs=1e-9)


def test_more_turns_than_a_picture_shows_are_refused():
    with pytest.raises(ValueError, match=f'2000 turns of the rotor are more than {MOST_TURNS}'):
        Trajectory.at_constant_speed(TURN, 2000)


def test_even_intervals_reach_to_the_end():
    samples = Trajectory(
        np.array([1.0, 2.0, 4.0]), np.array([0.0, 1.0, 4.0]), np.zeros(3), np.ones(3)
    )
    even = samples.every(0.5)
    assert even.time == pytest.approx([1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
    assert positions(even) / TURN == pytest.approx([0.0, 0.5, 1.0, 1.75, 2.5, 3.25, 4.0])


def test_a_closed_loop_continues_seamlessly():
    loop = Trajectory.at_constant_speed(10.0, turns=19).every(0.05, closed=True)
    steps = np.diff([*positions(loop), 19.0 * TURN])
    assert steps == pytest.approx(19.0 * TURN / len(steps), rel=1e-9)
    assert len(steps) == round(19.0 * TURN / 10.0 / 0.05)
    short = Trajectory.at_constant_speed(10.0, turns=1).every(100.0, closed=True)
    assert positions(short).tolist() == [0.0]


def test_parts_are_between_two_times():
    samples = Trajectory.at_constant_speed(1.0, turns=1)
    part = samples.between(1.0, 2.0)
    assert part.time[[0, -1]] == pytest.approx([1.0, 2.0], abs=0.02)
    assert positions(part) == pytest.approx(part.time)
    with pytest.raises(ValueError, match='no rotor states from 7 s on; they are'):
        samples.between(7.0, math.inf)
