# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a node answers to messages in the order in which they arrive, without ROS."""

from collections.abc import Collection, Iterable
from contextlib import suppress
from dataclasses import replace
from functools import partial

from shipped_bags import ROTOR

from gear_kinematics.bag import Message
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.wire.joint_reader import RejectedInputError

ENCODER = '/output_encoder'


def answered(
    parameters: NodeParameters,
    messages: Iterable[Message],
    *,
    topics: Collection[str] = ('output_state', 'body_poses'),
    calibration: Calibration | None = None,
    home_after: int = -1,
    gear: GearState | None = None,
) -> list[Message]:
    """Return messages with the outputs of a node, which is homed after a number of rotor states.

    The outputs are recorded as soon as they are there. `gear` is what computes them.
    """
    gear, recorded = gear or GearState(parameters, calibration), []
    gear.choose(topics)
    for topic, received, data in messages:
        recorded.append((topic, received, data))
        now = partial(int, received)
        with suppress(RejectedInputError):
            if topic == ENCODER:
                gear.encoder(data, now)
            elif topic == ROTOR:
                gear.rotor(data, now)
                recorded += [(f'/{name}', received, message) for name, message in gear.encode()]
                if gear.input.received == home_after:
                    angle = parameters.gear.gear_ratio.rotor_angle(parameters.home_angle)
                    homed = replace(parameters, rotor_zero=gear.input.zero_for(angle))
                    gear.apply(homed, calibration)
                    gear.input.home(angle)
    return recorded
