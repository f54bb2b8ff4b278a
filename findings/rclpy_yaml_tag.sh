#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 7.1.6 (Jazzy) and 9.1.2 (Kilted): `speed: !!float 10` in a parameter file is an integer.
#
# Of the tags of YAML, the parser of parameter files obeys !!str and ignores the others, without a word: the node
# gets an INTEGER of 10, and a parameter that was declared as a double is refused.
# Seen: PyYAML reads 10.0 of the same line. rcl obeys the tags since its pull request 1275, thus from Lyrical on.
# For us: write 10.0; gearkin and the nodes refuse tags other than !!str.
#
# Exit code 0: still so. Installs both versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/read.py" <<'PYTHON'
import sys

import rclpy
import yaml

rclpy.init(args=sys.argv)
node = rclpy.create_node('node', automatically_declare_parameters_from_overrides=True)
speed = node.get_parameter('speed')
print(speed.type_.name, repr(speed.value))
assert (speed.type_.name, speed.value) == ('INTEGER', 10)
[read] = yaml.safe_load(open(sys.argv[-1]))['/**'].values()
assert isinstance(read['speed'], float)
PYTHON
printf '/**:\n  ros__parameters:\n    speed: !!float 10\n' > "$folder/file.yaml"
export ROS_AUTOMATIC_DISCOVERY_RANGE=OFF ROS_LOG_DIR="$folder"
for wheel in 'ros-jazzy-rclpy[fastrtps]==7.1.6' 'ros-kilted-rclpy[fastrtps]==9.1.2'; do
    python3 -m venv --clear "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$wheel"
    "$folder/venv/bin/python" "$folder/read.py" --ros-args --params-file "$folder/file.yaml"
done
