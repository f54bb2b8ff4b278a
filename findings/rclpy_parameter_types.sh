#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 9.1.2 (Kilted): the refusal of a parameter's type gives the types as numbers.
#
# A parameter that was declared as 1.0 is set to 'fast'. The reason of the refusal is
#
#     Wrong parameter type, expected '3' got '4'
#
# and does not name the parameter. In rclpy 7.1.6 (Jazzy) it is 'Type.DOUBLE' and 'Type.STRING': what
# `Parameter.Type` gives in an f-string has changed. `ros2 param set` shows this text to the user.
# For us: the nodes put the names of the types and the parameter into the reason.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check 'ros-kilted-rclpy[fastrtps]==9.1.2'
export ROS_AUTOMATIC_DISCOVERY_RANGE=OFF ROS_LOG_DIR="$folder"
"$folder/venv/bin/python" - <<'PYTHON'
import rclpy
from rclpy.parameter import Parameter

rclpy.init()
node = rclpy.create_node('node')
node.declare_parameter('gain', 1.0)
[result] = node.set_parameters([Parameter('gain', value='fast')])
print(result.reason)
assert result.reason == "Wrong parameter type, expected '3' got '4'"
PYTHON
