"""Recordings as bags: the rotor's states and, if recorded, the output's encoder."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import Bag, BagError, DamagedBagError, ReportProgress, TopicMessages
from gear_kinematics.bag.roles import find_encoder_topic, find_rotor_topic
from gear_kinematics.kinematics import gear_from_mapping
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.recorded.clock import ClockError, times_of_rows
from gear_kinematics.lost_motion.recorded.encoder_step import Step, step_of
from gear_kinematics.lost_motion.recorded.motion import Motion
from gear_kinematics.lost_motion.recorded.recording import Loading, Recording
from gear_kinematics.state.output_encoder import EncoderSettings
from gear_kinematics.state.rotor_input import InputSettings, RotorInput, RotorSamples
from gear_kinematics.wire.batches import decode_joint_states
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.topics import OUTPUT_ENCODER

Array = NDArray[np.float64]


def read_bag(
    path: Path,
    parameters: Mapping[str, Any],
    rotor_topic: str | None = None,
    encoder_topic: str | None = None,
    counts: int | None = None,
    output_counts: int | None = None,
    progress: ReportProgress | None = None,
) -> Recording:
    """Read a bag.

    Args:
        path: of the bag.
        parameters: of the node, as `parameters.load` returns them.
        rotor_topic: of the rotor's states; None finds it by type and name.
        encoder_topic: of the output's encoder; None finds it by type and name, if recorded.
        counts: steps per turn of the rotor's encoder.
        output_counts: steps per turn of the output's encoder.
        progress: called after each batch, with the messages on all topics of the bag.

    Raises:
        BagError: if the bag cannot be read, or lacks a topic.
        ValueError: if the parameters describe no gear.
        MotionError: if no output angle can be compared.
    """
    ratio = gear_from_mapping(parameters).gear_ratio
    with Bag(path) as bag:
        encoder = find_encoder_topic(bag, encoder_topic)
        rotor = find_rotor_topic(bag, rotor_topic, parameters['rotor_joint'])
        messages = {topic: TopicMessages() for topic in (rotor, encoder) if topic}
        error = None
        try:
            bag.read(messages, progress)
        except DamagedBagError as damage:
            error = str(damage)
    rotor_input = RotorInput(InputSettings.from_mapping(parameters))
    samples = rotor_input.accept_batch(messages[rotor].data, messages[rotor].received)
    if not len(samples.stamp):
        why = f': {rotor_input.why_rejected}' if rotor_input.rejected else ''
        raise BagError(f'{path}: no usable rotor states on {rotor}{why}')
    remarks = [f'{rotor}: {count} states {cause}' for cause, count in rotor_input.rejected.items()]
    turns, angle = ratio.output_angle(samples.turns, samples.angle, np)
    positions = samples.turns * TURN + samples.angle
    rotor_step = step_of(counts, positions).scaled(1.0 / float(ratio))
    motion = None
    columns = [f'rotor {rotor}, joint {parameters["rotor_joint"]!r}, rad']
    if encoder:
        settings = EncoderSettings.from_mapping(parameters)
        states = decode_joint_states(messages[encoder].data, settings.output_encoder_joint)
        usable = ~states.malformed & states.present[:, 0]
        if states.lacking and not states.joint_found.any():
            raise BagError(f'{path}: {encoder}: {states.lacking}')
        measured = settings.output_angle(states.values[usable, 0])
        readings = states.values[:, 0][np.isfinite(states.values[:, 0])]
        motion = Motion.from_angles(
            settings.comparison(),
            (samples.stamp, turns, angle),
            (states.stamp[usable], measured),
            rotor_step,
            step_of(output_counts, readings),
        )
        columns.append(f'output {encoder}, rad')
    loading = _loading(samples, float(ratio), turns, angle, rotor_step, motion)
    if loading:
        columns.append(f'torque: effort of {rotor} × {ratio}, N·m')
    elif not motion:
        raise BagError(f'{path}: {rotor} has no effort, and there is no {OUTPUT_ENCODER}')
    return Recording(
        path.name,
        tuple(columns),
        len(samples.stamp),
        loading,
        motion,
        tuple(remarks),
        error,
    )


def _loading(
    samples: RotorSamples,
    ratio: float,
    turns: Array,
    angle: Array,
    rotor_step: Step,
    motion: Motion | None,
) -> Loading | None:
    """Torque and twist: of the gear if the output was measured, else of the whole drive."""
    known = np.isfinite(samples.effort)
    if not known.any():
        return None
    torque, stamp = ratio * samples.effort[known], samples.stamp[known]
    if motion is None:
        twist = (turns - turns[0])[known] * TURN + angle[known]
        return Loading(torque, twist, rotor_step, measured=False, time=_time(stamp))
    start = samples.stamp[0]
    torque = np.interp(motion.stamp - start, stamp - start, torque)
    return Loading.of_gear(torque, motion, _time(motion.stamp))


def _time(stamp: NDArray[np.int64]) -> Array | None:
    """Times of rows, s; None if a clock was set back."""
    try:
        return times_of_rows((stamp - stamp[0]) / SECOND)
    except ClockError:
        return None
