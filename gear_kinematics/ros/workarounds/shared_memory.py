# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Checks that /dev/shm has enough space for ROS.

Without, SIGBUS kills the process when rclpy is imported, or Fast DDS 2.14 loses messages.
"""

import os

_PLACE = '/dev/shm'  # noqa: S108, where Linux keeps shared memory
_TRACING = 2 * os.sysconf('SC_PAGE_SIZE')  # bytes that LTTng uses unreserved as rclpy is imported
_PARTICIPANT = 2**20  # bytes; Fast DDS reserves 650 KiB for a participant


class SharedMemoryError(RuntimeError):
    """There is too little shared memory to import rclpy."""


def check_shared_memory(participants: int = 1) -> str | None:
    """Check before rclpy is imported; returns a warning if messages may get lost.

    Fast DDS falls back to UDP if it cannot reserve memory for messages. If there is enough for the
    messages but not for a port to receive them, they are lost silently. SharedMemoryError is
    raised if the process would be killed.
    """
    try:
        status = os.statvfs(_PLACE)
    except FileNotFoundError:  # not Linux
        return None
    free = status.f_bavail * status.f_frsize
    advice = 'remove what crashed processes left there, or enlarge it (docker run --shm-size)'
    if free < _TRACING:
        raise SharedMemoryError(f'ROS cannot start, {_PLACE} is full: {advice}')
    if free < participants * _PARTICIPANT:
        return f'only {free // 1024} KiB are free in {_PLACE}, messages may get lost: {advice}'
    return None
