#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mks-servo-rs485 0.3.0: a stepper that has turned by ten turns is read at 0.22°, and one at -60 rpm at 65476 rpm.
#
# The drive gives whole turns and the counts within the turn (0x30), all counts in 48 bits with a sign (0x31), the
# speed in 16 and the pulses in 32 bits with a sign (0x32, 0x33). read_angle_carry() adds turns to counts as if both
# were counts. read_encoder_value() shifts the words by 8 instead of 16 bits, and ignores the sign, as the methods for
# the speed and the pulses do as well. The greatest current and the microsteps given to Servo() are never sent, as its
# own __init__() takes the place of the dataclass's, which would have called __post_init__(). An instrument answers
# here as the manual of the MKS SERVO42D says.
# For us: put the words of 0x31 together yourself, and call write_max_current() and write_subdivision().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --ignore-requires-python \
    mks-servo-rs485==0.3.0 minimalmodbus==2.1.1 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from mks_servo_rs485.servo import MotorType, Servo


class Drive:
    def __init__(self):
        self.written = []

    def read_registers(self, registeraddress, number_of_registers, functioncode):
        turns, counts = divmod(self.counts, 16384)
        answers = {
            0x30: struct.pack('>iH', turns, counts),
            0x31: self.counts.to_bytes(6, 'big', signed=True),
            0x32: struct.pack('>h', self.speed),
            0x33: struct.pack('>i', self.counts * 3200 // 16384),
        }
        return list(struct.unpack(f'>{number_of_registers}H', answers[registeraddress]))

    def write_register(self, registeraddress, value, functioncode):
        self.written.append(registeraddress)


drive = Drive()
servo = Servo(drive, MotorType.SERVO_42_D, 1, 800, 50, 200, 16)
drive.counts, drive.speed = 10 * 16384, 60
angle, counts = servo.read_angle_carry(), servo.read_encoder_value()
print('ten turns:', angle, '° and', counts, 'counts instead of', drive.counts)
assert abs(angle - 0.2197) < 1e-3 and counts == 33280
drive.counts, drive.speed = -10 * 16384, -60
back = servo.read_angle_carry(), servo.read_encoder_value(), servo.read_speed_rpm(), servo.read_number_of_pulses()
print('ten turns back:', back, 'written', drive.written)
assert abs(back[0] + 360.2197) < 1e-3
assert back[1:] == (4294966528, 65476, 4294935296)
assert drive.written == []
PYTHON
