#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tilburg-hand 1.1.0: a joint from 0° to 95° that is sent to 0° goes to -9°, and -2 rpm are read as 983547508 rpm.
#
# The positions of a hand with Dynamixel servos can be given in degrees, or from 0 to 1, where a margin of 5 % of the
# range is kept at both ends, as the documentation says. Expected: a goal in degrees is the angle that is read there,
# and the margin keeps joints from their ends. What happens: not the range but the ticks of its ends, about 2000, are
# multiplied by 1.05 and 0.95, also for degrees. A joint whose ticks fall as it closes, as at the base of each finger,
# is sent up to 9° beyond its ends, another one is sent to 7.6° for 0° and to 77.3° for 90°. The list of goals is
# changed to ticks, so that sending it again sends other goals, and speeds are read without a sign, other than currents.
# A bus of sixteen servos takes the place of the hand.
# For us: give margin_pct=0 and a copy of the list; subtract 2^32 * 0.229 from speeds in rpm above 2^31 * 0.229.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tilburg-hand==1.1.0 dynamixel-sdk==4.1.0
cat > "$folder/config.json" <<'JSON'
{"motors_dynamixelsdk_port": "bus", "motors_dynamixelsdk_VID_PID": "0403:6014",
 "joint_motor_mapping": [23, 22, 21, 20, 27, 26, 25, 24, 31, 30, 29, 28, 35, 34, 33, 32, 255, 255]}
JSON
cat > "$folder/hand.py" <<'PYTHON'
import sys

from tilburg_hand import Finger, TilburgHandMotorInterface, Unit, motor_interface

POSITION, VELOCITY = 132, 128
ticks, speeds = {}, {}


class Port:
    """A port that is always open."""

    ser = None

    def __init__(self, name):
        self.asked = 0

    def openPort(self):
        return True

    def setBaudRate(self, rate):
        return True

    def closePort(self):
        return True


class Bus:
    """Servos that stand at their goals, with the registers of a Dynamixel XL330."""

    def __init__(self, protocol):
        self.present = None

    def getProtocolVersion(self):
        return 2.0

    def ping(self, port, number):
        return 1200, 0 if number != 255 else -3001, 0

    def write1ByteTxRx(self, port, number, address, data):
        return 0, 0

    def write4ByteTxRx(self, port, number, address, data):
        ticks[number] = data
        return 0, 0

    def syncWriteTxOnly(self, port, address, length, parameters, count):
        for start in range(0, count, 1 + length):
            ticks[parameters[start]] = int.from_bytes(bytes(parameters[start + 1:start + 1 + length]), 'little')
        return 0

    def syncReadTx(self, port, address, *request):
        self.present = ticks if address == POSITION else speeds
        return 0

    def readRx(self, port, number, length):
        return list((self.present.get(number, 0) & 0xFFFFFFFF).to_bytes(length, 'little')), 0, 0


motor_interface.PortHandler, motor_interface.PacketHandler = Port, Bus
motor_interface._set_low_latency_mode = lambda *_: None
hand = TilburgHandMotorInterface(config_file=sys.argv[1])
assert hand.connect() == 1
base, middle = Finger.INDEX_MCP, Finger.INDEX_PIP


def reached(joint, goal, **options):
    hand.set_pos_single(joint, goal, Unit.DEGREES, **options)
    return round(hand.get_encoder_vector(Unit.DEGREES)[joint], 1)


found = [[reached(joint, goal) for goal in (0, 45, 90)] for joint in (base, middle)]
right = [[reached(joint, goal, margin_pct=0) for goal in (0, 45, 90)] for joint in (base, middle)]
ends = [hand.motor_calib_min_range_deg[base], hand.motor_calib_max_range_deg[base]]
print('0°, 45° and 90°: base of a finger', found[0], 'middle', found[1], 'without a margin', right)
assert ends == [0, 95] and found == [[-9.0, 42.4, 93.6], [7.6, 42.5, 77.3]]
assert all(abs(angle - goal) < 0.15 for angles in right for angle, goal in zip(angles, (0, 45, 90)))
goals = [45] * 16
sent = []
for _ in range(2):
    hand.set_pos_vector(goals, Unit.DEGREES)
    sent.append([round(hand.get_encoder_vector(Unit.DEGREES)[joint], 1) for joint in (base, middle)])
print('the same list of 45° twice:', sent)
assert sent == [[42.4, 42.5], [99.3, 81.2]]
speeds[hand.joint_motor_mapping[middle]] = -10
rpm = hand.get_velocity_vector(Unit.REV_PER_MINUTE)[middle]
print('-10 * 0.229 rpm are read as', round(rpm), 'rpm')
assert round(rpm - 2**32 * 0.229, 2) == -2.29
PYTHON
HOME="$folder" timeout 60 "$folder/venv/bin/python" "$folder/hand.py" "$folder/config.json"
