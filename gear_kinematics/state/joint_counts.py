# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Counts of the messages of an encoder's joint, on a topic that other joints may share."""

from collections import Counter

from gear_kinematics.wire.joint_reader import RejectedInputError, Rejection


class JointCounts:
    """Counts messages, and what is wrong with them, of a joint that is still to be found."""

    def __init__(self) -> None:
        self.received = 0
        self.rejected: Counter[str] = Counter()
        self.of_others = 0  # messages of other joints only, as of a shared /joint_states
        self.missing_joint = ''  # which joints the first message without this one has

    def reject(self, rejection: RejectedInputError, *, found: bool) -> None:
        """Count a rejected message of a joint that has or has not been found in any other."""
        self.rejected[str(rejection)] += 1
        if not self.missing_joint and str(rejection) == Rejection.JOINT_MISSING:
            self.missing_joint = rejection.detail
        if found:
            self.leave_others()

    def leave_others(self) -> None:
        """Count messages without the joint, which is in others, as no fault."""
        self.of_others += self.rejected.pop(Rejection.JOINT_MISSING, 0)
        self.missing_joint = ''
