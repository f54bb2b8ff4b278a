#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 7.1.6 and 9.1.2: a node refuses its own parameter file when it is loaded again, if a gain in it is written as
# 2e-3.
#
# A node is started with --params-file, and the same file is loaded into it by
# AsyncParameterClient.load_parameter_file(), as after an edit. Expected: nothing changes. What happens: rcl reads the
# file at the start by its own rules, the client by PyYAML, which knows exponents only with a point and a sign. 2e-3
# and 1.0e3 are numbers at the start and texts afterwards, and 1_000, a text for rcl, is an integer afterwards: "Wrong
# parameter type, expected 'Type.DOUBLE' got 'Type.STRING'" in 7.1.6. A parameter with dynamic typing takes the text.
# For us: write 0.002, or 2.0e-3, which both read alike; the commands of gearkin read as rcl does.
#
# Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/drive.yaml" <<'YAML'
drive:
  ros__parameters:
    gain: 2e-3
    limit: 1.0e3
    count: 1_000
    right: 2.0e-3
    free: 2e-3
YAML
cat > "$folder/load.py" <<'PYTHON'
import sys
import time

import rclpy
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter_client import AsyncParameterClient

path = sys.argv[-1]
rclpy.init(args=sys.argv)
node = rclpy.create_node('drive')
for name, default in {'gain': 0.0, 'limit': 0.0, 'count': '', 'right': 0.0}.items():
    node.declare_parameter(name, default)
node.declare_parameter('free', 0.0, ParameterDescriptor(dynamic_typing=True))
host = rclpy.create_node('host')
executor = SingleThreadedExecutor()
executor.add_node(node)
executor.add_node(host)


def values():
    return {name: node.get_parameter(name).value for name in ('gain', 'limit', 'count', 'right', 'free')}


started = values()
print('at the start', started)
assert started == {'gain': 0.002, 'limit': 1000.0, 'count': '1_000', 'right': 0.002, 'free': 0.002}

client = AsyncParameterClient(host, '/drive')
future = client.load_parameter_file(path)
deadline = time.monotonic() + 30
while not future.done() and time.monotonic() < deadline:
    executor.spin_once(0.1)
results, loaded = future.result().results, values()
for result in results:
    print('loaded again:', result.reason or 'successful')
assert [result.successful for result in results] == [False, False, False, True, True]
assert results[0].reason.startswith('Wrong parameter type')
assert loaded == {**started, 'free': '2e-3'}
PYTHON
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$folder/log"
for wheel in 'ros-jazzy-rclpy[fastrtps]==7.1.6' 'ros-kilted-rclpy[fastrtps]==9.1.2'; do
    rm -rf "$folder/venv"
    python3 -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$wheel"
    echo "$wheel"
    timeout 100 "$folder/venv/bin/python" "$folder/load.py" --ros-args --params-file "$folder/drive.yaml"
done
