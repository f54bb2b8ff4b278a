# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The messages that the node publishes for its samples, serialised."""

import math
from collections.abc import Iterable, Iterator, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from gear_kinematics.correction.corrector import Correction
from gear_kinematics.kinematics import GearRatio, Mechanism, RotorSample
from gear_kinematics.kinematics.motion import BranchPosition, closed_form
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.shape.urdf import joint_names
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.wire.batches import Array, encode
from gear_kinematics.wire.cdr import JointStateTemplate, PoseArrayTemplate, Template
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_INTERVAL,
    CORRECTED_STATE,
    OUTPUT_STATE,
)

Row = tuple[str, Template, Sequence[float]]  # topic, template and numbers of a message


class OutputMessages:
    """Computes the state of the output shaft at a sample and encodes its messages."""

    def __init__(self, ratio: GearRatio, *, output_joint: str) -> None:
        self._ratio = ratio
        self._torque_ratio = float(ratio)
        self._output_states = {
            (velocity, effort): JointStateTemplate(
                [output_joint], velocity=velocity, effort=effort
            )
            for velocity in (False, True)
            for effort in (False, True)
        }
        self.angle = self._output_states[False, False]  # of messages with an angle alone

    def rows(self, sample: RotorSample, topics: Iterable[str]) -> list[Row]:
        """Return topics, templates and numbers of the messages for a sample."""
        output_turns, output_rest = self._ratio.output_angle(*sample.position, math)
        angle = TURN * output_turns + output_rest
        _, _, velocity, effort = sample
        return [self._output_state(topic, angle, velocity, effort) for topic in topics]

    @np.errstate(over='ignore')  # an effort can overflow, as it does for a single sample
    def encode_outputs(self, samples: RotorSamples) -> dict[str, list[bytes]]:
        """Encode the topics of a recording for many samples, with the numbers of `rows`."""
        output_turns, output_rest = self._ratio.output_angle(samples.turns, samples.angle, np)
        return {OUTPUT_STATE: self._output_states_of(samples, TURN * output_turns + output_rest)}

    def corrected_rows(
        self, sample: RotorSample, correction: Correction, topics: Iterable[str]
    ) -> Iterator[Row]:
        """Yield templates and numbers of the messages on some of CORRECTED_TOPICS."""
        for topic in topics:
            if topic == CORRECTED_STATE:
                turns, rest = self._ratio.output_angle(*sample.position, math)
                angle = TURN * turns + rest + correction.deviation
                _, _, velocity, effort = sample
                if velocity is not None:
                    velocity *= 1.0 + correction.slope
                yield self._output_state(topic, angle, velocity, effort)
            else:
                yield topic, self.angle, [correction.half_width]

    @np.errstate(over='ignore')
    def encode_corrections(
        self, samples: RotorSamples, correction: Correction
    ) -> dict[str, list[bytes]]:
        """Encode all CORRECTED_TOPICS for many samples, as `corrected_rows`."""
        turns, rest = self._ratio.output_angle(samples.turns, samples.angle, np)
        angle = TURN * turns + rest + correction.deviation
        corrected = samples._replace(velocity=samples.velocity * (1.0 + correction.slope))
        return {
            CORRECTED_STATE: self._output_states_of(corrected, angle),
            CORRECTED_INTERVAL: encode(self.angle, samples.stamp, [correction.half_width]),
        }

    def _output_state(self, topic: str, output_angle: Any, velocity: Any, effort: Any) -> Row:
        """Return the row of an output_state: floats or arrays; None where absent."""
        numbers = [output_angle]
        if velocity is not None:
            numbers.append(self._ratio.output_rate(velocity))
        if effort is not None:
            numbers.append(self._torque_ratio * effort)
        return topic, self._output_states[velocity is not None, effort is not None], numbers

    def _output_states_of(self, samples: RotorSamples, output_angle: Array) -> list[bytes]:
        output_states = len(samples.stamp) * [b'']
        absent = np.isnan([samples.velocity, samples.effort])
        for present in self._output_states:
            rows = np.flatnonzero(np.all(present != absent.T, axis=1))
            rates, torques = samples.velocity[rows], samples.effort[rows]
            given = rates if present[0] else None, torques if present[1] else None
            _, template, numbers = self._output_state(OUTPUT_STATE, output_angle[rows], *given)
            encoded = encode(template, samples.stamp[rows], numbers)
            for row, message in zip(rows.tolist(), encoded, strict=True):
                output_states[row] = message
        return output_states


class StateMessages(OutputMessages):
    """Computes the state of a mechanism at a sample and encodes its messages."""

    def __init__(self, mechanism: Mechanism, *, output_joint: str, frame_prefix: str) -> None:
        super().__init__(mechanism.gear_ratio, output_joint=output_joint)
        self._form = closed_form(mechanism)
        self._axial_positions = 2 * [branch.axial_position for branch in mechanism.branches]
        self._body_poses = PoseArrayTemplate(frame_prefix + 'stator', 2 * len(mechanism.branches))
        names = joint_names(mechanism, output_joint=output_joint, frame_prefix=frame_prefix)
        self._joint_states = {
            velocity: JointStateTemplate(names, velocity=velocity, effort=False)
            for velocity in (False, True)
        }

    def rows(self, sample: RotorSample, topics: Iterable[str]) -> list[Row]:
        """Return topics, templates and numbers of the messages for a sample."""
        _, (turns, angle), velocity, effort = sample
        output_turns, output_rest = self._ratio.output_angle(turns, angle, math)
        output_angle = TURN * output_turns + output_rest
        branches: list[BranchPosition] = []
        rows: list[Row] = []
        for topic in topics:
            if topic == OUTPUT_STATE:
                rows.append(self._output_state(topic, output_angle, velocity, effort))
                continue
            branches = branches or self._form.branches(angle, output_rest, math)
            if topic == BODY_POSES:
                numbers = self._pose_numbers(output_rest, branches, math)
                rows.append((topic, self._body_poses, numbers))
            else:
                rows.append((topic, *self._joint_state(sample, output_angle, branches)))
        return rows

    def encode_outputs(self, samples: RotorSamples) -> dict[str, list[bytes]]:
        """Encode the topics of a recording for many samples, with the numbers of `rows`."""
        _, output_rest = self._ratio.output_angle(samples.turns, samples.angle, np)
        branches = self._form.branches(samples.angle, output_rest, np)
        numbers = self._pose_numbers(output_rest, branches, np)
        poses = encode(self._body_poses, samples.stamp, numbers)
        return super().encode_outputs(samples) | {BODY_POSES: poses}

    def _pose_numbers(
        self, output_angle: Any, branches: Sequence[BranchPosition], xp: ModuleType
    ) -> list[Any]:
        """Return the numbers of body_poses: floats or arrays."""
        # All these bodies turn by φ5, whose quaternion has w >= 0 within the turn.
        sine, cosine = xp.sin(0.5 * output_angle), xp.cos(0.5 * output_angle)
        centres = [branch.satellite for branch in branches]
        centres += [branch.oldham for branch in branches]
        numbers: list[Any] = []
        for (x, y), z in zip(centres, self._axial_positions, strict=True):
            numbers += (x, y, z, 0.0, 0.0, sine, cosine)
        return numbers

    def _joint_state(
        self, sample: RotorSample, output_angle: float, branches: Sequence[BranchPosition]
    ) -> tuple[Template, Sequence[float]]:
        """Return template and numbers of the joint states, in the order of `joint_names`."""
        rotor_angle = TURN * sample.position.turns + sample.position.angle
        on_cam = output_angle - rotor_angle
        numbers = [rotor_angle, *(on_cam for _ in branches)]
        numbers += [branch.satellite_slide for branch in branches]
        numbers.append(output_angle)
        velocity = sample.velocity
        if velocity is not None:
            output_velocity = self._ratio.output_rate(velocity)
            numbers += [velocity, *(output_velocity - velocity for _ in branches)]
            numbers += [self._form.slide_velocities(branch, velocity)[0] for branch in branches]
            numbers.append(output_velocity)
        return self._joint_states[velocity is not None], numbers


def state_messages(parameters: NodeParameters) -> OutputMessages:
    """Return the messages of a gear, including its bodies unless only the ratio is known.

    Raises ValueError if a name is empty, not printable, or that of two joints.
    """
    gear, joint, prefix = parameters.gear, parameters.output_name, parameters.frame_prefix
    if isinstance(gear, Mechanism):
        return StateMessages(gear, output_joint=joint, frame_prefix=prefix)
    joint_names(gear, output_joint=joint, frame_prefix=prefix)  # to check them
    return OutputMessages(gear, output_joint=joint)
