# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads at the node's samples: torque, acceleration, messages, batches, and the margin."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState, MultiDOFJointState
from wire import of_rows

from gear_kinematics.kinematics import MechanismError, RotorSample, loads, solve, split_turns
from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import Acceleration, LoadEstimator, PreloadMonitor
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.topics import LOAD_TOPICS

DEFAULT = NodeParameters.load()
BRACED = replace(DEFAULT, preload=3.0, branch_stiffness=(2000.0, 1000.0), shaft_stiffness=5000.0)
HEAVY = replace(BRACED, loads=Bodies(0.05, 2e-5, 0.02, 3e-6, 4e-5, 0.4))
MILLISECOND = 1_000_000


def accelerated(count: int = 60, rate: float = 700.0) -> list[RotorSample]:
    """A rotor that has 40 rad/s at first, and `rate` rad/s² from then on."""
    time = np.arange(count) * 1e-3
    angle = 40.0 * time + 0.5 * rate * time**2
    return [
        RotorSample(k * MILLISECOND, split_turns(angle[k]), 40.0 + rate * time[k], 0.2)
        for k in range(count)
    ]


def test_output_torque_is_what_the_inertias_leave_of_the_rotors():
    """The torques that `kinematics.loads` needs for the rotor's effort, at the true motion."""
    followed, last = LoadEstimator(HEAVY), None
    for last in accelerated():
        found = followed.follow(last, 0)
    rotor = TURN * last.position.turns + last.position.angle
    mechanism = HEAVY.mechanism
    state = solve(mechanism, rotor, last.velocity, 700.0)
    expected = loads.solve(mechanism, state, found.torques, HEAVY.loads)
    assert expected.rotor_torque == pytest.approx(last.effort, rel=1e-9)
    for k, (_, mesh, cam, *_) in enumerate(found.branches):
        assert cam == pytest.approx(expected.cam_force[k], rel=1e-6)
        assert mesh == pytest.approx(expected.mesh_force[k], rel=1e-6)


def test_messages_are_those_of_the_contract():
    parameters = replace(BRACED, frame_prefix='left_')
    followed = LoadEstimator(parameters)
    sample = RotorSample(5, split_turns(0.3), 10.0, 0.5)
    encoded = of_rows(followed.rows(followed.follow(sample, 0), LOAD_TOPICS), 5)
    branches = deserialize_message(encoded['branch_loads'], JointState)
    assert branches.name == ['left_branch_a', 'left_branch_b']
    # i τ2 = -9.5 N·m is beyond the threshold of A, -3 (1 + kB/kAe) = -5.1: B carries all of it.
    assert list(branches.effort) == [0.0, -9.5]
    # cB M - (cA + cB) T0 with cA = 1/2000 + 1/5000 and cB = 1/1000.
    assert branches.position[0] == pytest.approx(9.5e-3 - 1.7e-3 * 3.0)
    assert branches.position[1] == 0.0
    joints = deserialize_message(encoded['joint_loads'], MultiDOFJointState)
    assert joints.header.frame_id == 'left_stator'
    kinds = 'mesh', 'cam', 'slot_satellite', 'slot_arm'
    assert joints.joint_names == [f'left_{kind}_{branch}' for branch in 'ab' for kind in kinds]
    assert not joints.transforms
    assert not joints.twist
    mesh, cam = joints.wrench[4].force, joints.wrench[5].force
    assert math.hypot(mesh.x, mesh.y) == pytest.approx(
        9.5 / parameters.mechanism.satellite_rolling_radius
    )
    assert (cam.x, cam.y) == pytest.approx((-mesh.x, -mesh.y))
    assert [w.torque.z for w in joints.wrench] == [0.0] * 6 + [-9.5, 9.5]
    unknown = followed.follow(sample._replace(effort=None), 0)
    assert not list(followed.rows(unknown, LOAD_TOPICS))


def test_acceleration_lags_by_half_of_its_window():
    """The velocity grows with the square of time, so that its acceleration is 2 t."""
    estimate = Acceleration()
    for k in range(100):
        time = k * 1e-3
        found = estimate.follow(k * MILLISECOND, time**2, 0)
        expected = 2.0 * (time - 0.010) if k >= 20 else math.nan
        assert found == pytest.approx(expected, nan_ok=True)


@pytest.mark.parametrize(
    ('stamp', 'segment'), [(300 * MILLISECOND, 0), (21 * MILLISECOND, 1)], ids=['gap', 'segment']
)
def test_acceleration_is_unknown_across_a_break(stamp, segment):
    estimate = Acceleration()
    for k in range(21):
        estimate.follow(k * MILLISECOND, 1.0, 0)
    assert math.isnan(estimate.follow(stamp, 1.0, segment))


@pytest.mark.parametrize(
    ('changes', 'cause'),
    [
        ({'branch_stiffness': (0.0,), 'shaft_stiffness': 0.0}, 'a preload needs branch_stiffness'),
        ({'branches': DEFAULT.branches[:1]}, 'exactly two branches'),
        ({'preload': 2000.0}, 'by 3.4 rad: a gear takes at most 1 rad'),  # 2 N·m, in N·mm
        ({'gear_ratio': '100'}, 'only the ratio of this gear is known'),
    ],
)
def test_preload_that_cannot_be_is_refused(changes, cause):
    with pytest.raises(MechanismError, match=cause):
        LoadEstimator(replace(BRACED, **changes))


def monitored(torques):
    """Return the monitor after these torques of the output, N·m."""
    monitor = PreloadMonitor(replace(DEFAULT, preload=3.0, branch_stiffness=(2000.0,)))
    for k, torque in enumerate(torques):
        effort = None if math.isnan(torque) else torque / -19.0
        monitor.follow(RotorSample(k * MILLISECOND, split_turns(0.0), None, effort), 0)
    return monitor


def test_margin_falls_by_half_of_the_load_of_equal_branches():
    report = monitored([0.0, 4.0, -2.0]).report()
    assert (report.message, report.texts) == (
        'ok',
        {
            'preload (N·m)': '3',
            'margin (N·m)': '2',
            'margin (% of the preload)': '66.7',
            'least margin (N·m)': '1',
            'least margin (% of the preload)': '33.3',
            'out of mesh (% of the time)': '0.0',
        },
    )


def test_time_out_of_mesh_is_a_warning_until_the_next_report():
    monitor = monitored([0.0] * 76 + [8.0] * 25)
    report = monitor.report()
    assert report.facts == [Condition.OUT_OF_MESH(share=pytest.approx(25.0))]
    assert report.values['least margin (N·m)'] == pytest.approx(-1.0)
    unknown = [Condition.MARGIN_UNKNOWN(lacking='effort')]
    assert monitor.report().facts == monitored([math.nan] * 2).report().facts == unknown
