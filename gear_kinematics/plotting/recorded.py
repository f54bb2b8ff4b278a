# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor's motion in a bag; whoever draws no recording imports neither `bag` nor `state`."""

from pathlib import Path

import numpy as np

from gear_kinematics.bag import Bag, BagError, ReportProgress
from gear_kinematics.bag.roles import find_rotor_topic
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.wire.cdr import SECOND


def read_trajectory(
    path: Path,
    parameters: NodeParameters,
    rotor_topic: str | None = None,
    progress: ReportProgress | None = None,
) -> Trajectory:
    """Read the rotor's motion from a bag, up to the first stamp that jumps back.

    Missing velocities are derived from the positions. Raises BagError if the bag cannot be read,
    or has fewer than two rotor states of different times.
    """
    with Bag(path) as bag:
        topic = find_rotor_topic(bag, rotor_topic, parameters.rotor_joint)
        messages = [message for batch in bag.batches([topic], progress) for message in batch]
    gear = GearState(parameters)
    samples = gear.batch(messages, topic).samples
    anew = np.flatnonzero(np.diff(samples.stamp) < 0)
    _, used = np.unique(samples.stamp[: anew[0] + 1 if len(anew) else None], return_index=True)
    if len(used) < 2:  # noqa: PLR2004, no motion
        why = f' ({gear.input.why_rejected})' if gear.input.rejected else ''
        raise BagError(f'{path}: {topic} has fewer than two rotor states of different times{why}')
    stamps, turns, angle, velocity = (column[used] for column in samples[:4])
    time = (stamps - stamps[0]) / SECOND
    positions = (turns - turns[0]) * TURN + angle
    with np.errstate(over='ignore', invalid='ignore'):
        velocity = np.where(np.isnan(velocity), np.gradient(positions, time), velocity)
    return Trajectory(time, turns, angle, velocity, bool(samples.referenced[used].all()))
