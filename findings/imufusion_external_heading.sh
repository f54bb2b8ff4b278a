#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# imufusion 1.3.3: a forearm that is pitched by 60° and whose heading is given as 45° settles at a yaw of 63.4°.
#
# Expected of update_external_heading(), for an IMU at rest with a pitch of 60°, a roll of 0° and an external heading of
# 45°, updated for 60 s: a yaw of 45°, as update() finds with a magnetometer, as compass() gives of the same attitude,
# and as set_heading() sets. What happens: 63.4°, and 88.3° for 80° at a pitch of 80°, as the magnetic field that is
# made of the heading takes the roll into account, but not the pitch: the tangent is divided by the cosine of the pitch.
# Without pitch it is right, also with a roll. In the convention ENU, it is 90° more in each case, so that a level IMU
# with a heading of 30° is at 120°; compass() and set_heading() have 30° for it there. The heading is documented as
# "Heading in degrees" in each of the functions, and as one that may come from a GPS.
# For us: take 90° off the heading in ENU, and give atan2(sin(heading)·cos(pitch), cos(heading)) instead of it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check imufusion==1.3.3 numpy==2.4.6 scipy==1.17.1
cat > "$folder/heading.py" <<'PYTHON'
import imufusion
import numpy as np
from scipy.spatial.transform import Rotation

STILL = np.zeros(3)
GRAVITY = {'NWU': (0, 0, 1), 'ENU': (0, 0, 1), 'NED': (0, 0, -1)}
NORTH = {'NWU': (1, 0, 0), 'ENU': (0, 1, 0), 'NED': (1, 0, 0)}


def settled(convention, update):
    """Give the yaw in degrees after 60 s of updates at 100 Hz, with the default settings, and by set_heading()."""
    ahrs = imufusion.Ahrs()
    settings = imufusion.AhrsSettings()
    settings.sample_rate = 100
    settings.convention = convention
    ahrs.set_settings(settings)
    for _ in range(6000):
        update(ahrs)
    found = imufusion.quaternion_to_euler(ahrs.get_quaternion())
    ahrs.set_heading(yaw)
    return found, imufusion.quaternion_to_euler(ahrs.get_quaternion())[2]


for name, (yaw, pitch, roll), expected in (
    ('NWU', (45, 60, 0), 63.43), ('NWU', (80, 80, 0), 88.25), ('NWU', (30, 0, 60), 30), ('NED', (45, 60, 0), 63.43),
    ('ENU', (30, 0, 0), 120), ('ENU', (45, 60, 0), 153.43),
):
    convention = getattr(imufusion, f'CONVENTION_{name}')
    attitude = Rotation.from_euler('ZYX', (yaw, pitch, roll), degrees=True)
    gravity, field = attitude.inv().apply((GRAVITY[name], NORTH[name]))
    wrong, put = settled(convention, lambda ahrs: ahrs.update_external_heading(STILL, gravity, yaw))
    right, _ = settled(convention, lambda ahrs: ahrs.update(STILL, gravity, field))
    compass = imufusion.compass(gravity, field, convention)
    radians = np.deg2rad(yaw - 90 * (name == 'ENU'))
    other = np.rad2deg(np.arctan2(np.sin(radians) * np.cos(np.deg2rad(pitch)), np.cos(radians)))
    mended, _ = settled(convention, lambda ahrs: ahrs.update_external_heading(STILL, gravity, other))
    print(f'{name}, heading {yaw}°, pitch {pitch}°, roll {roll}°: yaw {wrong[2]:.2f}° by the heading, '
          f'{right[2]:.2f}° by the magnetometer, {compass:.2f}° by compass(), {put:.2f}° by set_heading()')
    assert np.allclose(wrong, (roll, pitch, expected), atol=0.1)
    assert np.allclose((right, mended), (roll, pitch, yaw), atol=0.1) and np.allclose((compass, put), yaw, atol=0.1)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/heading.py"
