# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings of an arm of three gears whose ratios are known: written by rosbags, by division."""

import math
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import yaml
from live import rotor_bytes

RATIOS = {'shoulder': Fraction(-19), 'elbow': Fraction(1457, 26), 'wrist': Fraction(30)}
ROTOR, OUTPUT = '/rotor_state', '/output_state'
STEP, START = 4_000_000, 5_000_000_000  # ns


class Joints(NamedTuple):
    """A JointState: names, and a position, velocity and effort for each, or none."""

    names: list[str]
    position: list[float]
    velocity: list[float]
    effort: list[float]

    def encode(self, stamp: int) -> bytes:
        return rotor_bytes(stamp, *self)


def config(path: Path, **more) -> Path:
    """Write the parameter file of the arm."""
    values = {f'{name}.gear_ratio': str(ratio) for name, ratio in RATIOS.items()}
    values |= {'actuators': list(RATIOS), **more}
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': values}}), 'utf-8')
    return path


def inputs(steps: int) -> list[tuple[int, Joints]]:
    """Stamps and states of rotors: all in one message, or of two drivers with equal stamps."""
    found = []
    for k in range(steps):
        stamp, time = START + k * STEP, 0.004 * k
        shoulder, elbow, wrist = math.sin(time), 9.0 * time, math.cos(3.0 * time)
        if k % 3:
            found.append(
                (stamp, Joints(['wrist', 'shoulder', 'elbow'], [wrist, shoulder, elbow],
                        [math.nan, math.cos(time), 9.0], [math.nan, 0.25, math.nan]))
            )  # fmt: skip
        else:
            pair = Joints(['shoulder', 'elbow'], [shoulder, elbow], [math.cos(time), 9.0], [])
            found += [(stamp, pair), (stamp, Joints(['wrist'], [wrist], [], []))]
    return found


def output(state: Joints) -> Joints:
    """The message of the node for one of the rotors."""
    given = dict(zip(state.names, range(len(state.names)), strict=True))
    names = [name for name in RATIOS if name in given]
    turns = {name: float(ratio) for name, ratio in RATIOS.items()}
    position, velocity = (
        [values[given[name]] / turns[name] for name in names if values] for values in state[1:3]
    )
    effort = [state.effort[given[name]] * turns[name] for name in names if state.effort]
    return Joints(names, position, velocity, effort)


def recording(
    steps: int = 60, edit=lambda _, state: [state], read=lambda state: state
) -> list[tuple[str, int, bytes]]:
    """The messages, with those of the node as `edit` makes them of its number and its content.

    The encoders of the rotors give what `read` makes of their state.
    """
    messages = []
    for number, (stamp, state) in enumerate(inputs(steps)):
        messages.append((ROTOR, stamp + 1000, read(state).encode(stamp)))
        for k, joints in enumerate(edit(number, output(state))):
            messages.append((OUTPUT, stamp + 2000 + k, joints.encode(stamp)))
    return messages
