#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 7.1.6 and 9.1.2: a parameter from -0.3 to 0.3 in steps of 0.1 takes all seven values but 0.0.
#
# A trim in degrees is declared with FloatingPointRange(from_value=-0.3, to_value=0.3, step=0.1). Expected: 0.0 is one
# of its seven values, as 0.1 is. What happens: -0.3 + 3 * 0.1 is 5.6e-17 in floating point, and is compared with 0.0 by
# a relative tolerance alone, by which no number is near 0: "not close enough to a valid step", in declare_parameter()
# an exception, so that the node does not start with its default of 0.0. So it is for 83 of 472 ranges of the usual
# steps, among them ±0.3, ±0.6 and ±0.7 of 0.1, and for none with a limit of 0.5, 1 or 2. All other values have a
# tolerance of 1e-6 of their size.
# For us: no parameter of the node has a step. In a driver, leave the step at 0, or let the range begin at 0.
#
# Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/range.py" <<'PYTHON'
import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterValueException
from rclpy.parameter import Parameter

rclpy.init()
node = rclpy.create_node('driver')


def declared(limit, step, value, name):
    span = FloatingPointRange(from_value=-limit, to_value=limit, step=step)
    node.declare_parameter(name, value, ParameterDescriptor(floating_point_range=[span]))


declared(0.3, 0.1, 0.1, 'trim')
taken = {}
for value in (-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3):
    [result] = node.set_parameters([Parameter('trim', value=value)])
    taken[value] = result.successful
    print(value, 'is taken' if result.successful else result.reason)
assert [value for value, successful in taken.items() if not successful] == [0.0]

refused, tried = [], 0
for step in (0.1, 0.01, 0.05, 0.2, 0.001, 0.02, 0.5, 0.25):
    for steps in range(1, 60):
        limit = round(steps * step, 6)
        tried += 1
        try:
            declared(limit, step, 0.0, f'range_{tried}')
        except InvalidParameterValueException:
            refused.append((limit, step))
print('0.0 is refused in', len(refused), 'of', tried, 'ranges, such as', refused[:4])
assert len(refused) == 83 and tried == 472 and (0.3, 0.1) in refused and (1.0, 0.1) not in refused
PYTHON
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$folder/log"
for wheel in 'ros-jazzy-rclpy[fastrtps]==7.1.6' 'ros-kilted-rclpy[fastrtps]==9.1.2'; do
    rm -rf "$folder/venv"
    python3 -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$wheel"
    echo "$wheel"
    timeout 60 "$folder/venv/bin/python" "$folder/range.py"
done
