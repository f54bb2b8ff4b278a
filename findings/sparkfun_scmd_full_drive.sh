#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-scmd 2.0.0: full drive backwards, 255, turns a motor forwards with full drive.
#
# set_drive(motor, direction, level) has "0 or 1 for forward and backward" and a level up to 255. SparkFun's Serial
# Controlled Motor Driver takes one byte: 128 is no drive, 0 is full drive in direction 0, and 255 in direction 1.
# Expected of a level of 255 in direction 1: the byte 255, as of 254. What happens: 255 is halved and rounded up to
# 128, and with the middle of 128 it is 256, of which smbus2, through which the package writes on Linux, sends the
# lower byte, 0. So the motor reverses from one end to the other as the level goes from 254 to 255. In direction 0,
# 255 is right. The message to the kernel is looked at here instead of being sent.
# For us: limit the level to 254.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-scmd==2.0.0 \
    sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import qwiic_scmd
import smbus2
from qwiic_i2c.linux_i2c import LinuxI2C

sent = []


def ioctl(file, request, message):
    if request == smbus2.smbus2.I2C_SMBUS:
        sent.append((message.command, message.data.contents.byte))


smbus2.smbus2.ioctl = ioctl
driver = object.__new__(LinuxI2C)
driver._i2cbus = smbus2.SMBus(None)
driver._i2cbus.fd = 0
motor = qwiic_scmd.QwiicScmd(address=0x5D, i2c_driver=driver)
bytes_of = {}
for direction in (0, 1):
    for level in (0, 100, 254, 255):
        motor.set_drive(0, direction, level)
        bytes_of[direction, level] = sent[-1][1]
print({f'{"backwards" if d else "forwards"} {level}': byte for (d, level), byte in bytes_of.items()})
assert {register for register, _ in sent} == {0x20}
assert [bytes_of[1, level] for level in (0, 100, 254, 255)] == [128, 178, 255, 0]
assert [bytes_of[0, level] for level in (0, 100, 254, 255)] == [128, 78, 0, 0]
PYTHON
