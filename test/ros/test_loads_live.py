# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads and the preload of the node as a process of its own."""

import itertools
from pathlib import Path

import pytest
from live import SECOND, connected, rotor_state, stamp_of
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState, MultiDOFJointState

pytestmark = pytest.mark.live

MS = SECOND // 1000
PRELOADED = Path(__file__).parents[2] / 'docs/examples/preloaded.yaml'


def test_every_effort_is_answered_with_loads_and_the_margin_is_reported(tmp_path):
    with connected(tmp_path, '--ros-args', '--params-file', str(PRELOADED)) as peer:
        qos = QoSProfile(depth=2000)
        branches = peer.listen(JointState, 'branch_loads', qos)
        joints = peer.listen(MultiDOFJointState, 'joint_loads', qos)
        peer.wait_until(branches.get_publisher_count, 'branch_loads')
        peer.wait_until(joints.get_publisher_count, 'joint_loads')
        torques, wrenches = peer.received['branch_loads'], peer.received['joint_loads']
        probes = itertools.count(MS, MS)

        def loads():
            peer.answer(rotor_state(next(probes), position=[0.0], effort=[0.0]))
            return torques and wrenches

        peer.wait_until(loads, 'loads')  # the node discovers the listeners in its own time
        stamps = [peer.stamp() for _ in range(50)]
        # i τ2 = 4 N·m is beyond the 1.875 N·m at which branch B leaves mesh.
        peer.send(*(rotor_state(s, position=[0.1], effort=[-4 / 19]) for s in stamps[:-1]))
        peer.send(rotor_state(stamps[-1], position=[0.1]))  # nothing is known of its loads
        peer.outputs(50)

        def answered(received):
            return [stamp_of(message) for message in received if stamp_of(message) >= stamps[0]]

        peer.wait_until(lambda: len(answered(torques)) == len(answered(wrenches)) >= 49, 'loads')
        assert answered(torques) == answered(wrenches) == stamps[:-1]
        assert list(torques[-1].effort) == pytest.approx([4.0, 0.0])
        assert torques[-1].position[1] == pytest.approx(4.0 / 750 - 1.5 * (2 / 3000 + 1 / 1000))

        def preload(status):
            return status.name.endswith(': preload') and 'out of mesh' in status.message

        def again():
            peer.send(rotor_state(peer.stamp(), position=[0.1], effort=[-4 / 19]))

        _, status = peer.report(preload, 'a warning of the preload', again)
        values = {value.key: value.value for value in status.values}
        assert status.level == b'\x01'
        assert float(values['least margin (N·m)']) == pytest.approx(1.5 - 0.8 * 4.0)
