# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Make the recordings of this folder again: a driver and gear_state_publisher over DDS, recorded.

    python bags/record.py DIRECTORY

Each scenario drives the real node with a trajectory at a fixed rate, in real time, and records
rotor_state, output_state and body_poses as they arrive. Stamps are the driver's clock at the
moment of sampling, so that no two recordings are alike.
"""

import math
import random
import time
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.ros.live import Replay, running_node
from gear_kinematics.share import share_directory
from gear_kinematics.wire.cdr import JointStateTemplate, Template
from gear_kinematics.wire.topics import BODY_POSES, OUTPUT_STATE, ROTOR_STATE, TOPICS

_COUNTS = 2**20  # of the encoder, per turn
_INERTIA = 2.0e-4  # kg m², of the rotor and what it moves
_FRICTION = 0.02  # N·m


class Motion(NamedTuple):
    """The rotor at an instant: rad, rad/s, rad/s²."""

    angle: float
    velocity: float
    acceleration: float


@dataclass(frozen=True)
class Scenario:
    """What is recorded."""

    motion: Callable[[float], Motion]
    """By the time in s."""
    driver: Callable[[int, int, Motion], list[bytes]]
    """The messages for a sample, by its number and stamp."""
    rate: float
    """Hz."""
    duration: float
    """s."""
    storage: Literal['mcap', 'sqlite3'] = 'mcap'
    arguments: tuple[str, ...] = ()
    """Arguments of the node."""


def point_to_point(t: float) -> Motion:
    """Servo moves with rests between them, there and back, by quintic polynomials."""
    targets, move, rest = (0.0, 75.0, -40.0, 12.5, 130.0, 0.0), 0.9, 0.3
    index, local = divmod(t, move + rest)
    start, end = (targets[min(int(index) + k, len(targets) - 1)] for k in (0, 1))
    s = min(local / move, 1.0)
    span = end - start
    return Motion(
        start + span * s**3 * (10.0 - 15.0 * s + 6.0 * s**2),
        span / move * 30.0 * s**2 * (1.0 - s) ** 2,
        span / move**2 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
    )


def constant_speed(t: float) -> Motion:
    """3000 rpm."""
    speed = 3000.0 * 2.0 * math.pi / 60.0
    return Motion(speed * t, speed, 0.0)


def swinging(t: float) -> Motion:
    """About twenty turns forth and back, at up to 200 rad/s."""
    amplitude, rate = 64.0, math.pi
    return Motion(
        amplitude * math.sin(rate * t),
        amplitude * rate * math.cos(rate * t),
        -amplitude * rate**2 * math.sin(rate * t),
    )


_noise = random.Random(1)  # noqa: S311  # measurement noise, not cryptography
_full = JointStateTemplate(['rotor'], velocity=True, effort=True)
_position_only = JointStateTemplate(['rotor'], velocity=False, effort=False)


def _encoder(angle: float) -> float:
    return round(angle / (2.0 * math.pi) * _COUNTS) / _COUNTS * 2.0 * math.pi


def _readings(motion: Motion) -> tuple[float, float, float]:
    torque = _INERTIA * motion.acceleration
    if motion.velocity:
        torque += math.copysign(_FRICTION, motion.velocity)
    return (
        _encoder(motion.angle),
        motion.velocity + _noise.gauss(0.0, 0.05),
        torque + _noise.gauss(0.0, 0.002),
    )


def servo_driver(_number: int, stamp: int, motion: Motion) -> list[bytes]:
    """A driver that reports all there is."""
    return [_full.encode(stamp, _readings(motion))]


def single_turn_driver(_number: int, stamp: int, motion: Motion) -> list[bytes]:
    """An encoder log: the position alone, in [0, 2π)."""
    return [_position_only.encode(stamp, [_encoder(motion.angle) % (2.0 * math.pi)])]


def faulty_driver(number: int, stamp: int, motion: Motion) -> list[bytes]:
    """Every fault of real drivers, each a few times."""
    readings = position, velocity, effort = _readings(motion)
    good = _full.encode(stamp, readings)
    if any(number in silence for silence in _SILENCES):
        return []
    match number % 100:
        case 10:
            return [good, good]  # the same stamp twice
        case 20:
            return [good, _full.encode(stamp - 5_000_000, readings)]
        case 30:
            return [_full.encode(stamp, [math.nan, velocity, effort])]
        case 40:
            return [_WRONG_JOINT.encode(stamp, readings)]
        case 50:
            return [_NO_NUMBERS.encode(stamp, [])]
        case 60:
            return [_full.encode(stamp, [position, math.nan, math.inf])]
        case 70:
            return [_position_only.encode(stamp, [position])]
    return [good]


_SILENCES = range(400, 460), range(900, 1050)  # 0.12 s and 0.3 s
_WRONG_JOINT = JointStateTemplate(['gripper'], velocity=True, effort=True)
_NO_NUMBERS = Template('', ['rotor'], (0, 1, ()), (0, 1, ()), (0, 1, ()))

SCENARIOS = {
    'servo_point_to_point': Scenario(point_to_point, servo_driver, 500.0, 6.0),
    'constant_speed_3000rpm': Scenario(constant_speed, servo_driver, 1000.0, 3.0),
    'single_turn_encoder': Scenario(
        swinging,
        single_turn_driver,
        1000.0,
        2.5,
        arguments=(
            '--ros-args',
            '--params-file',
            str(share_directory() / 'config' / 'single_turn.yaml'),
        ),
    ),
    'driver_faults': Scenario(point_to_point, faulty_driver, 500.0, 3.0, storage='sqlite3'),
}


def record(path: Path, scenario: Scenario) -> None:
    """Record one scenario to a new bag."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with running_node(scenario.arguments), Replay() as replay:
        replay.wait_for_node('rotor')
        sent = 0
        start = time.monotonic()
        for number in range(round(scenario.rate * scenario.duration)):
            replay.receive_until(start + number / scenario.rate)
            stamp, now = time.time_ns(), time.monotonic() - start
            for data in scenario.driver(number, stamp, scenario.motion(now)):
                replay.send(data)
                sent += 1
        replay.receive(Counter({'/rotor_state': sent}))
        replay.receive_until(time.monotonic() + 0.5)  # what the node still answers
        compression: Literal['zstd', 'none'] = 'zstd' if scenario.storage == 'mcap' else 'none'
        with BagWriter(path, scenario.storage, compression) as writer:
            for name in (ROTOR_STATE, OUTPUT_STATE, BODY_POSES):
                writer.add_topic(f'/{name}', TOPICS[name].type)
            writer.write_all(replay.received)


if __name__ == '__main__':
    parser = ArgumentParser(description=__doc__, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=Path, metavar='DIRECTORY', help='folder to create')
    given = parser.parse_args()
    for name, scenario in SCENARIOS.items():
        record(given.folder / name, scenario)
