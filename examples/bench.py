# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Call ~/wear or ~/power_cycle of gear_simulator, or ramp its load and write angle and torque."""

import math
import sys
from pathlib import Path

import rclpy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

RESTING = 0.001  # rad/s, which a step of the torque exceeds within a sample
rclpy.init()
node, output = rclpy.create_node('bench'), [JointState(effort=[math.nan])]


def call(name: str, kind: type = Trigger, **values: bool) -> None:
    client = node.create_client(kind, f'/gear_simulator/{name}')
    if not client.wait_for_service(10.0):
        sys.exit('no gear_simulator is running')
    answer = client.call_async(kind.Request(**values))
    rclpy.spin_until_future_complete(node, answer)
    print(answer.result().message)


if sys.argv[1] in {'wear', 'power_cycle'}:
    sys.exit(call(sys.argv[1]))
call('lock_rotor', SetBool, data=True)
loads = node.create_publisher(Float64, '/load_torque', 10)
node.create_subscription(JointState, '/output_encoder', output.append, 10)
rows, ramps = ['angle,torque'], [(0.4, 60)] * 5 + [(4.0, 200)] * 3  # N·m, steps there and back
for amplitude, phase in [(most, step / count) for most, count in ramps for step in range(count)]:
    torque = amplitude * 2.0 / math.pi * math.asin(math.sin(math.tau * phase))
    loads.publish(Float64(data=torque))
    while output[-1].effort[0] != torque or abs(output[-1].velocity[0]) > RESTING:
        rclpy.spin_once(node)
    rows.append(f'{math.remainder(output[-1].position[0], math.tau)},{torque}')
Path(sys.argv[1]).write_text('\n'.join(rows))
call('lock_rotor', SetBool, data=False)
