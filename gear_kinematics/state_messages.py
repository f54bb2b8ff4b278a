"""The messages that the node publishes for a rotor sample, as bytes ready to be sent."""

import math
from collections.abc import Sequence

from gear_kinematics.description import joint_names
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.motion import BranchPosition, closed_form
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.messages import JointStateTemplate, PoseArrayTemplate
from gear_kinematics.rotor_input import RotorSample


class StateMessages:
    """Computes the state at a sample and encodes it."""

    def __init__(self, mechanism: Mechanism, *, output_joint: str, frame_prefix: str) -> None:
        """Lay the messages out."""
        self._form = closed_form(mechanism)
        self._ratio = float(mechanism.gear_ratio)
        self._axial_positions = [branch.axial_position for branch in mechanism.branches]
        self._output_states = {
            (velocity, effort): JointStateTemplate(
                [frame_prefix + output_joint], velocity=velocity, effort=effort
            )
            for velocity in (False, True)
            for effort in (False, True)
        }
        self._body_poses = PoseArrayTemplate(frame_prefix + 'stator', 2 * len(mechanism.branches))
        names = joint_names(mechanism, output_joint=output_joint, frame_prefix=frame_prefix)
        self._joint_states = {
            velocity: JointStateTemplate(names, velocity=velocity, effort=False)
            for velocity in (False, True)
        }

    def encode(self, sample: RotorSample) -> tuple[bytes, bytes, bytes]:
        """Give output_state, body_poses and mechanism_joint_states for a sample."""
        turns, angle = sample.position
        output_turns, output_rest = self._form.output_angle(turns, angle, math)
        branches = self._form.branches(angle, output_rest, math)
        output_angle = TURN * output_turns + output_rest
        return (
            self._output_state(sample, output_angle),
            self._body_poses.encode(sample.stamp, self._poses(output_rest, branches)),
            self._joint_state(sample, output_angle, branches),
        )

    def _output_state(self, sample: RotorSample, output_angle: float) -> bytes:
        arrays = [(output_angle,)]
        if sample.velocity is not None:
            arrays.append((self._form.output_rate(sample.velocity),))
        if sample.effort is not None:
            arrays.append((self._ratio * sample.effort,))
        template = self._output_states[sample.velocity is not None, sample.effort is not None]
        return template.encode(sample.stamp, *arrays)

    def _poses(self, output_angle: float, branches: Sequence[BranchPosition]) -> list[float]:
        # Every body but the rotor has the angle φ5; within the turn its quaternion has w >= 0.
        quaternion = (0.0, 0.0, math.sin(0.5 * output_angle), math.cos(0.5 * output_angle))
        numbers: list[float] = []
        for branch, z in zip(branches, self._axial_positions, strict=True):
            numbers += (branch.satellite_x, branch.satellite_y, z, *quaternion)
        for branch, z in zip(branches, self._axial_positions, strict=True):
            numbers += (branch.oldham_x, branch.oldham_y, z, *quaternion)
        return numbers

    def _joint_state(
        self, sample: RotorSample, output_angle: float, branches: Sequence[BranchPosition]
    ) -> bytes:
        """In the order of `joint_names`."""
        rotor_angle = TURN * sample.position.turns + sample.position.angle
        on_cam = output_angle - rotor_angle
        positions = [rotor_angle, *(on_cam for _ in branches)]
        positions += [branch.satellite_slide for branch in branches]
        positions.append(output_angle)
        velocity = sample.velocity
        if velocity is None:
            return self._joint_states[False].encode(sample.stamp, positions)
        output_velocity = self._form.output_rate(velocity)
        velocities = [velocity, *(output_velocity - velocity for _ in branches)]
        velocities += [self._form.slide_velocities(branch, velocity)[0] for branch in branches]
        velocities.append(output_velocity)
        return self._joint_states[True].encode(sample.stamp, positions, velocities)
