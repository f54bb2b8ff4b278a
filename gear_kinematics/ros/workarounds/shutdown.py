# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Shutdown of ROS that does not hang in Fast DDS.

Destroying a node waits, without a time limit, until no discovery callback runs. Fast DDS 2.14, if
built with glibc before 2.30 as the wheels are, then hangs if one does run: its infinite deadline
overflows when it is converted to another clock, pthread_cond_timedwait refuses it without
releasing the lock that the callback needs to return, and Fast DDS tries again.
"""

import ctypes
import os
from contextlib import suppress

import rclpy
from rclpy.node import Node

_TIMEOUT = 5  # s; a discovery callback takes microseconds
# Mangled names of C++ functions.
_GET_PARTICIPANT = '_ZN16rmw_fastrtps_cpp22get_domain_participantEP10rmw_node_s'
_SET_LISTENER = (
    '_ZN8eprosima7fastdds3dds17DomainParticipant12set_listener'
    'EPNS1_25DomainParticipantListenerENSt6chrono8durationIlSt5ratioILl1ELl1EEEE'
)


def shut_down(node: Node) -> None:
    """Destroy the only node of a context, and shut the context down."""
    with suppress(OSError, AttributeError):  # another middleware, or another version
        _end_discovery(node)
    node.destroy_node()
    rclpy.try_shutdown(context=node.context)


def _end_discovery(node: Node) -> None:
    """Wait, with a time limit, until no discovery callback runs, and prevent further ones.

    OSError means that rmw_fastrtps is not in use, AttributeError that it lacks these functions.
    """
    rcl, rmw = (
        ctypes.CDLL(f'lib{name}.so', os.RTLD_NOLOAD | os.RTLD_NOW)
        for name in ('rcl', 'rmw_fastrtps_cpp')
    )
    get_rmw_node, get_participant = rcl.rcl_node_get_rmw_handle, rmw[_GET_PARTICIPANT]
    get_rmw_node.restype = get_participant.restype = ctypes.c_void_p
    get_rmw_node.argtypes = get_participant.argtypes = [ctypes.c_void_p]
    set_listener = rmw[_SET_LISTENER]
    set_listener.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64]
    with node.handle:
        participant = get_participant(get_rmw_node(node.handle.pointer))
        set_listener(participant, None, _TIMEOUT)
