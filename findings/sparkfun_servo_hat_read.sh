#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-pi-servo-hat 2.0.0: a servo that was sent to 180° is read at 270°, and one at 0° is read at -90°.
#
# Many servos take pulses from 0.5 to 2.5 ms, for which PiServoHat has min_pt and max_pt and set_pulse_time. Expected:
# get_servo_position gives the degrees that were sent by move_servo_position, but for rounding. What happens: the move
# is scaled by the times that were set, and the position that is read by 1 and 2 ms, whatever was set. Both agree at
# half of the range alone; a servo with pulses from 1 to 2 ms is read right. The pulse itself is right in either case,
# as the registers show that stand in here for the PCA9685 of the board, by its data sheet.
# For us: keep the angle that was sent, or compute it from the registers by the times that were set.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-pi-servo-hat==2.0.0 \
    sparkfun-qwiic-pca9685==2.0.0 sparkfun-qwiic-i2c==2.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import qwiic_i2c
from pi_servo_hat import PiServoHat

LED0_ON, LED0_OFF, PRE_SCALE = 0x06, 0x08, 0xFE


class Registers:
    """The registers of a PCA9685, whose words have their low byte first."""

    def __init__(self):
        self.bytes = {0x00: 0x11, PRE_SCALE: 0x1E}

    def readByte(self, address, register):
        return self.bytes.get(register, 0)

    def writeByte(self, address, register, value):
        self.bytes[register] = value

    def readWord(self, address, register):
        return self.readByte(address, register) | self.readByte(address, register + 1) << 8

    def writeWord(self, address, register, value):
        self.bytes[register], self.bytes[register + 1] = value & 0xFF, value >> 8

    def pulse(self):
        """Return the length of the pulse of the first channel in ms."""
        counts = self.readWord(0, LED0_OFF) - self.readWord(0, LED0_ON)
        return counts * (self.bytes[PRE_SCALE] + 1) / 25e6 * 1000


registers = Registers()
qwiic_i2c.getI2CDriver = lambda *_, **__: registers
qwiic_i2c.isDeviceConnected = lambda address: True
found = {}
for times in (0.5, 2.5), (1, 2):
    hat = PiServoHat(min_pt=times[0], max_pt=times[1])
    for angle in 0, 45, 90, 180:
        hat.move_servo_position(0, angle, 180)
        read = hat.get_servo_position(0, 180)
        found[times, angle] = round(registers.pulse(), 2), round(read)
        print(f'pulses from {times[0]} to {times[1]} ms: sent to {angle}°, a pulse of {registers.pulse():.2f} ms,', end=' ')
        print(f'read at {read:.1f}°')
assert [found[(0.5, 2.5), angle] for angle in (0, 45, 90, 180)] == [(0.5, -90), (1.0, 0), (1.5, 90), (2.5, 270)], found
assert all(abs(found[(1, 2), angle][1] - angle) <= 1 for angle in (0, 45, 90, 180))
PYTHON
