#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rpimotorlib 4.0.0: a servo that is to move from 10° to 180° in steps of 20°, as in its documentation, goes to 190°.
#
# Expected of servo_move_step(26, 10, 180, 2, 20, 1, True), the example in its documentation for moving "a servo from 10
# degrees to 180 degrees in 20 degree steps": it ends at 180°, and never goes beyond. What happens: it makes whole steps
# until it has passed the end, 10°, 30° and so on to 170°, and then 190°, which is a duty cycle of 12.56 % where the
# greatest of SG90servo is 12 %. From 170° to 0° in steps of 20° it ends at -10°, with a duty cycle of 1.44 % where the
# least is 2 %. Where the steps divide the way, it is right. The pins and the clock are stubs.
# For us: a joint runs against its stop by up to a step. Give steps that divide the way.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rpimotorlib==4.0.0
HOME="$folder" timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import sys
import time
import types
from unittest import mock

pins = mock.MagicMock()
sys.modules['RPi'] = types.ModuleType('RPi')
sys.modules['RPi.GPIO'] = sys.modules['RPi'].GPIO = pins
time.sleep = lambda seconds: None
from RpiMotorLib.rpiservolib import SG90servo  # noqa: E402


def angles(start, end, step):
    pins.reset_mock()
    SG90servo().servo_move_step(26, start, end, 2, step, 1)
    duties = [call.args[0] for call in pins.PWM.return_value.ChangeDutyCycle.call_args_list if call.args[0]]
    found = [round((duty - 2) * 18, 6) for duty in duties]
    print(f'from {start}° to {end}° in steps of {step}°: {found}, at last {duties[-1]:.2f} %')
    return found


assert angles(10, 170, 20) == [10, 30, 50, 70, 90, 110, 130, 150, 170]
assert angles(10, 180, 20) == [10, 30, 50, 70, 90, 110, 130, 150, 170, 190]
assert angles(170, 0, 20) == [170, 150, 130, 110, 90, 70, 50, 30, 10, -10]
PYTHON
