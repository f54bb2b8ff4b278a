#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# feetech-cli 0.1.8: the self-test of a servo that may turn on and on, which is to move it by 9°, turns it by 263°.
#
# Expected of selftest(), whose "moves stay within --span counts of where the servo started (100 by default, about 9
# degrees)": a servo at 3000 counts goes to 2900 and 3100 at most. What happens: goals are kept 10 counts within the
# limits of the servo, and where both limits are 0, as FEETECH's memory table has them for turning over several turns,
# each goal is 10. The servo turns by 2990 counts, with torque, and back at the end. That the "position range is usable"
# is found to be false before, and the result is "not passed", but only after the motion. In the same way, a servo that
# stands 400 counts beyond its limit is turned by 410. The servo is the one that the package simulates.
# For us: an output turns into its stops. Look at the limits with `feetech read` before, or move by hand.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check feetech-cli==0.1.8
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from feetech_cli.controller import FeetechServoController
from feetech_cli.protocol import PacketHandler
from feetech_cli.registers import CONTROL_TABLE
from feetech_cli.simulator import SimulatedBus, SimulatedServo


def tested(least, greatest, start):
    servo = SimulatedServo(1)
    for name, value in (('min_position_limit', least), ('max_position_limit', greatest), ('present_position', start)):
        address = CONTROL_TABLE[name].address
        servo.memory[address : address + 2] = value.to_bytes(2, 'little')
    servo.raw_position = start
    controller = FeetechServoController(port='simulated', baudrate=1000000)
    controller.serial = SimulatedBus([servo])
    controller.packet_handler = PacketHandler(controller.serial)
    result = controller.selftest(1)
    farthest = max(abs(move['reached'] - start) for move in result['moves'])
    usable = dict(check[:2] for check in result['checks'])['position range is usable']
    print(f'limits {least} to {greatest}, from {start}: moved by {farthest} counts, {farthest * 360 / 4096:.0f}°,',
          f'range usable: {usable}, passed: {result["passed"]}')
    return farthest, usable, result['passed']


assert tested(0, 4095, 3000) == (100, True, True)
assert tested(0, 0, 3000) == (2990, False, False)
assert tested(1000, 3000, 3400) == (410, True, True)
PYTHON
