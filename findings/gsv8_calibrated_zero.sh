#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gsv8-ethercat 0.1.0: a torque sensor that is zeroed and then calibrated with 10 N·m reads 15 N·m under this load and 5
# N·m without it.
#
# Its README zeroes all channels without a load and then calibrates a channel with a known load. Expected: 0 without the
# load and the known value under it. What happens: a reading is raw * scale + offset, and zeroing sets the offset for
# the present scale. Calibrating changes the scale alone, by known / measured, so that the zero moves: a sensor that
# gives 0.5 mV/V unloaded and 1.0 mV/V under 10 N·m, with a scale of 10 at first, reads 5 and 15 N·m. Once it is zeroed
# again, it reads 0 and 10 N·m. Neither the README nor the docstrings say so.
# The amplifier is faked by its process data as the package reads them: eight floats and eight bytes of status.
# For us: zero, calibrate and zero again, and check both loads before a torque is recorded.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gsv8-ethercat==0.1.0 pysoem==1.1.13
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import struct
from types import SimpleNamespace

from gsv8_ethercat import GSV8Calibration, GSV8Sensor

sensor = GSV8Sensor('none')
sensor._master = SimpleNamespace(send_processdata=lambda: None, receive_processdata=lambda timeout: 3)
sensor._is_operational = True
sensor.scales, sensor.offsets = [10.0] * 8, [0.0] * 8
calibration = GSV8Calibration(sensor)


def load(torque):
    raw = 0.5 + 0.05 * torque
    sensor._slave = SimpleNamespace(input=struct.pack('<8f8B', *[raw] * 8, *[0] * 8))


def readings():
    found = []
    for torque in (0, 10):
        load(torque)
        found.append(round(sensor.get_channel_force(0), 4))
    return found


load(0)
calibration.zero_all_channels(samples=5)
zeroed = readings()
load(10)
calibration.calibrate_channel(channel=0, known_value=10.0, samples=5)
calibrated = readings()
load(0)
calibration.zero_channel(0, samples=5)
again = readings()
print('unloaded and under 10 N·m: zeroed', zeroed, 'calibrated', calibrated, 'zeroed again', again)
assert zeroed == [0, 5] and calibrated == [5, 15] and again == [0, 10]
PYTHON
