# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The driver of a simulated motor: what it makes of commands, and what its encoders read."""

import math

import pytest

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.twin.driver import Command, Driver
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.parameters import TwinParameters

VALUES = {'play': 1e-3, 'friction': 0.05, 'rotor_damping': 0.0, 'output_inertia': 0.005}
VALUES |= {'rotor_counts': 0, 'output_counts': 0}
SHARED = {'preload': 1.5, 'branch_stiffness': [3000.0], 'loads.rotor_inertia': 1e-5}
INERTIA = 1e-5 + 0.005 / 361.0
FREE = Command(None, None, None)


def driver(shared=(), *, max_torque=0.5, **options) -> Driver:
    own = TwinParameters.of({**VALUES, 'max_rotor_torque': max_torque, **options})
    gear = TwinGear.of(NodeParameters.of({**SHARED, **dict(shared)}), own)
    return Driver(FastModel(gear), own)


def run(driver: Driver, command: Command, seconds: float, load: float = 0.0) -> None:
    driver.follow(command)
    for _ in range(round(1000 * seconds)):
        driver.advance(1e-3, load)


def test_without_a_command_the_rotor_is_free():
    free = driver()
    for _ in range(100):
        free.advance(1e-3, 1.0)
    assert free.torque == 0.0
    assert abs(free.model.output_angle) > 0.1


@pytest.mark.parametrize('direction', [1, -1])
def test_position_is_reached_and_held_against_a_load(direction):
    held = driver({'rotor_direction': direction, 'rotor_zero': 5.0})
    run(held, Command(25.0, None, None), 1.0)
    assert held.model.rotor_angle == pytest.approx(direction * 20.0, abs=1e-3)
    run(held, Command(25.0, None, None), 1.0, load=1.9)
    position, velocity, effort = held.rotor()
    assert position == pytest.approx(25.0, abs=1e-3)
    assert velocity == pytest.approx(0.0, abs=0.01)
    assert effort == pytest.approx(direction * 1.9 / 19.0, abs=0.05 / 19.0)


@pytest.mark.parametrize(('heavy', 'steps'), [(1.0, 4000), (200.0, 20_000)])
def test_step_overshoots_little_with_any_inertia_of_the_output(heavy, steps):
    stepped = driver(output_inertia=heavy * 0.005)
    stepped.follow(Command(5.0, None, None))
    reached = []
    for _ in range(steps):
        stepped.advance(1e-3, 0.0)
        reached.append(stepped.model.rotor_angle)
    assert max(reached) < 5.0 * 1.25
    assert reached[-1000:] == pytest.approx([5.0] * 1000, abs=0.02)


def test_velocity_is_reached_by_the_bandwidth():
    turned = driver()
    run(turned, Command(None, 10.0, None), 1.0 / (math.tau * 30.0))
    assert turned.model.rotor_velocity == pytest.approx(10.0 * (1.0 - math.exp(-1.0)), rel=0.15)
    run(turned, Command(None, 10.0, None), 1.0)
    assert turned.rotor()[1] == pytest.approx(10.0, rel=1e-3)


def test_effort_accelerates_both_inertias():
    pushed = driver({'rotor_direction': -1})
    run(pushed, Command(None, None, 0.02), 0.5)
    expected = (0.02 - 0.05 / 19.0) / INERTIA * 0.5
    assert pushed.rotor()[1] == pytest.approx(expected, rel=0.02)
    assert pushed.rotor()[2] == 0.02


def test_position_goes_before_velocity_and_effort():
    held = driver()
    run(held, Command(2.0, 0.0, 0.4), 1.0)
    assert held.model.rotor_angle == pytest.approx(2.0, abs=1e-3)
    run(held, Command(None, 0.0, 0.4), 1.0)
    assert held.model.rotor_velocity == pytest.approx(0.0, abs=1e-3)


def test_stream_of_positions_is_followed_smoothly_and_a_single_one_is_held():
    """At 100 Hz and 50 rad/s: the torque is that of the friction, not of steps of 0.5 rad."""
    streamed = driver()
    efforts = []
    for step in range(100):
        run(streamed, Command(0.5 * step, 50.0, None), 0.01)
        efforts.append(streamed.rotor()[2])
    assert efforts[50:] == pytest.approx([0.05 / 19.0] * 50, rel=0.1)
    run(streamed, Command(0.5 * 100, 50.0, None), 1.0)
    assert streamed.rotor()[0] == pytest.approx(50.0, abs=1e-3)


def test_limits_hold():
    limited = driver({'max_rotor_speed': 50.0}, max_torque=0.1)
    efforts, speeds = [], []
    limited.follow(Command(1000.0, None, None))
    for _ in range(1000):
        limited.advance(1e-3, 0.0)
        efforts.append(limited.torque)
        speeds.append(limited.model.rotor_velocity)
    assert max(map(abs, efforts)) == 0.1
    assert max(speeds) == pytest.approx(45.0, rel=0.05)
    run(limited, Command(None, None, 5.0), 1.0)
    assert limited.model.rotor_velocity == pytest.approx(45.0, rel=0.05)


def test_locked_rotor_tells_the_torque_that_holds_it():
    locked = driver()
    locked.model.rotor_locked = True
    run(locked, FREE, 0.5, load=1.9)
    assert locked.rotor()[2] == pytest.approx(1.9 / 19.0, abs=0.05 / 19.0 + 1e-3)


def test_encoders_count_in_steps_and_wrap():
    """Steps of 0.628 rad of a rotor at angle + 0.1, of 6.28 mrad of an output at 1 - angle."""
    read = driver(
        {'rotor_zero': 0.1, 'output_encoder_zero': 1.0, 'output_encoder_direction': -1},
        rotor_counts=10,
        output_counts=1000,
    )
    step = math.tau / 10.0
    for angle, count in ((0.0, 0), (0.3, 1), (-8.0, -13), (1e6, 1591550)):
        read.model.rotor_angle = angle
        assert read.rotor()[0] == pytest.approx(count * step, abs=1e-9 * max(1, count))
    for angle, count in ((0.0, 159), (-1.5, 398), (2.0, 841), (200.0 * math.pi + 2.0, 841)):
        read.model.output_angle = angle
        assert read.output()[0] == pytest.approx(count * math.tau / 1000.0)


def test_single_turn_encoder_wraps_and_survives_a_power_cycle():
    read = driver({'rotor_encoder': 'single_turn', 'rotor_zero': 1.0})
    read.model.rotor_angle = 20.0
    before = read.rotor()[0]
    assert before == pytest.approx(21.0 - 3.0 * math.tau)
    read.power_cycle()
    assert read.rotor()[0] == before


def test_multi_turn_encoder_counts_from_where_it_is_switched_on():
    read = driver({'rotor_direction': -1, 'rotor_zero': 1.0})
    run(read, Command(40.0, None, None), 1.0)
    output = read.output()[0]
    read.power_cycle()
    assert read.rotor()[0] == pytest.approx(0.0, abs=1e-9)
    assert read.output()[0] == output
    run(read, Command(2.0, None, None), 1.0)
    assert read.rotor()[0] == pytest.approx(2.0, abs=1e-3)
    assert read.model.rotor_angle == pytest.approx(-39.0 - 2.0, abs=1e-2)


def test_dropouts_are_a_share_and_the_same_in_each_run():
    first, second, complete = driver(dropout=0.1), driver(dropout=0.1), driver()
    dropped = [first.drops() for _ in range(10_000)]
    assert dropped == [second.drops() for _ in range(10_000)]
    assert sum(dropped) == pytest.approx(1000, abs=120)  # 4 σ
    assert not any(complete.drops() for _ in range(1000))
