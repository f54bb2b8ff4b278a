# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Call ~/wear or ~/power_cycle of gear_simulator, or ramp its load and write angle and torque."""

from argparse import ArgumentParser
from math import asin, nan, remainder, sin, tau
from pathlib import Path

import rclpy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger


def call(name: str, kind: type = Trigger, **values: bool) -> None:
    client = node.create_client(kind, f'/gear_simulator/{name}')
    while client.wait_for_service(10.0):
        answer = client.call_async(kind.Request(**values))
        rclpy.spin_until_future_complete(node, answer, timeout_sec=5.0)
        if answer.done():  # else it was lost, as its sender had not discovered this node yet
            return print(answer.result().message)
    raise SystemExit(f'no gear_simulator that answers ~/{name} is running')


parser = ArgumentParser(description=__doc__)
parser.add_argument('what', help='wear, power_cycle, or the .csv file to write')
rclpy.init()
node, output, resting = rclpy.create_node('bench'), [JointState(effort=[nan])], 0.001  # rad/s
if not (what := parser.parse_args().what).endswith('.csv'):
    raise SystemExit(call(what))
loads = node.create_publisher(Float64, '/load_torque', 10)
call('lock_rotor', SetBool, data=True)  # who answers has discovered the publisher before
node.create_subscription(JointState, '/output_encoder', output.append, 10)
rows, ramps = ['angle,torque'], [(0.4, 60)] * 5 + [(4.0, 200)] * 3  # N·m, steps there and back
for torque in [most * asin(sin(tau * k / n)) / asin(1) for most, n in ramps for k in range(n)]:
    loads.publish(Float64(data=torque))
    while output[-1].effort[0] != torque or abs(output[-1].velocity[0]) > resting:
        rclpy.spin_once(node)
    rows.append(f'{remainder(output[-1].position[0], tau)},{torque}')
Path(what).write_text('\n'.join(rows))
call('lock_rotor', SetBool, data=False)
