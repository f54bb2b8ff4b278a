#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ros-kilted-rclpy 9.1.2: the wheel installs without any middleware, and then rclpy cannot be imported.
#
# `pip install ros-kilted-rclpy` succeeds, and `pip check` finds nothing missing. `import rclpy` raises an
# ImportError: librmw_fastrtps_cpp.so cannot be opened. The middleware comes with an extra of the wheel alone,
# ros-kilted-rclpy[fastrtps].
# For us: the message of the error does not name the extra; gearkin and the nodes do.
#
# Exit code 0: still so. Installs the version into a temporary folder, with and without the extra.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
pip="$folder/venv/bin/pip --disable-pip-version-check"
$pip install --quiet ros-kilted-rclpy==9.1.2
$pip check
if "$folder/venv/bin/python" -c 'import rclpy' 2> "$folder/error"; then exit 1; fi
grep -o 'ImportError: librmw_fastrtps_cpp.so: cannot open shared object file' "$folder/error"
if grep -q fastrtps] "$folder/error"; then exit 1; fi
$pip install --quiet 'ros-kilted-rclpy[fastrtps]==9.1.2'
"$folder/venv/bin/python" -c 'import rclpy'
