"""Whether /dev/shm has the room that ROS needs; a process that finds none is killed by SIGBUS."""

import os

_PLACE = '/dev/shm'  # noqa: S108, where Linux keeps shared memory
_TRACING = 2 * os.sysconf('SC_PAGE_SIZE')
"""Bytes that LTTng writes to when rclpy is imported, without reserving them."""
_PARTICIPANT = 2**20
"""Bytes, more than the 650 KiB that Fast DDS reserves for a participant."""


class SharedMemoryError(RuntimeError):
    """There is too little shared memory to import rclpy."""


def check_shared_memory(participants: int = 1) -> str | None:
    """Check it before rclpy is imported; returns a warning if messages may get lost.

    Fast DDS falls back to UDP if it cannot reserve memory for messages. Where there is enough for
    these but not for a port to receive them, they are lost without a word.

    Args:
        participants: how many are about to be created.

    Raises:
        SharedMemoryError: if the process would be killed.
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
