# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The classes of the node in the order in which its messages arrive, without ROS."""

from collections.abc import Iterable
from dataclasses import replace

from shipped_bags import OUTPUT, POSES, ROTOR

from gear_kinematics.bag import Message
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.state.turn_reference import TurnReference

ENCODER = '/output_encoder'


def answered(
    parameters: NodeParameters, messages: Iterable[Message], home_after: int = -1
) -> list[Message]:
    """Return messages with the outputs of a node, which is homed after a number of rotor states.

    The outputs are recorded as soon as they are there.
    """
    rotor, outputs, recorded = RotorInput(parameters), state_messages(parameters), []
    encoder = OutputEncoder(parameters, TurnReference(rotor))
    for topic, received, data in messages:
        recorded.append((topic, received, data))
        if topic == ENCODER:
            encoder.accept(data, lambda: 0)
        elif topic == ROTOR:
            sample = rotor.accept(data, lambda: 0)
            encoded = dict(outputs.encode(sample, ('output_state', 'body_poses')))
            recorded += [(name, received, encoded[name[1:]]) for name in (OUTPUT, POSES)]
            if encoder.received:
                encoder.follow(sample)
            if rotor.received == home_after:
                angle = parameters.gear.gear_ratio.rotor_angle(parameters.home_angle)
                rotor.parameters = replace(parameters, rotor_zero=rotor.zero_for(angle))
                rotor.home(angle)
    return recorded
