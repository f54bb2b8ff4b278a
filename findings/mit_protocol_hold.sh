#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# damiao-motor 1.0.6, pydamiao 0.1.4: the command to hold a motor where it is moves it, and a velocity of 0 is not sent
# as 0.
#
# In the MIT protocol a position is a whole number of 16 bits over ±12.5 rad. Both libraries round down where they
# send one, and floating-point numbers lose a little where they read one. Who sends the position just read:
#
#     damiao-motor    7.7 % of positions go one count down; from -12.243 rad on step by step down to -12.5 rad
#     pydamiao       50.0 % of positions go one count down, up to 82 of them in a row (0.031 rad)
#
# And a velocity of 0 becomes -0.0073 rad/s of ±30, as 0 lies between two of the 4096 numbers.
# For us: a slow creep of the rotor at standstill may come from the driver: hold a position that was read once.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check damiao-motor==1.0.6 pydamiao==0.1.4
"$folder/venv/bin/python" - <<'PYTHON'
from damiao_motor.core.motor import DaMiaoMotor
from pydamiao.protocol import DamiaoProtocol
from pydamiao.structs import MOTOR_LIMITS, MotorType

damiao = DaMiaoMotor(1, 17, None, motor_type='4310')
limits = MOTOR_LIMITS[MotorType.DM4310]
assert (damiao._p_max, damiao._v_max) == limits[:2] == (12.5, 30)


def status(position):
    return bytes([1, position >> 8, position & 0xFF, 0x80, 8, 0, 25, 25])


def by_damiao_motor(position):
    read = damiao.decode_sensor_feedback(status(position))['pos']
    return damiao.encode_cmd_msg(read, 0.0, 0.0, 10.0, 1.0)


def by_pydamiao(position):
    read = DamiaoProtocol.decode_status(status(position), limits)[0]
    return DamiaoProtocol.encode_mit_control(1, limits, 10.0, 1.0, read, 0.0, 0.0)[-9:-1]


for name, command, share, longest, end in (
    ('damiao-motor', by_damiao_motor, 7.7, 675, 675),
    ('pydamiao', by_pydamiao, 50.0, 82, 245),
):
    lowered = run = found = 0
    for position in range(1 << 16):
        sent = command(position)
        step = int.from_bytes(sent[:2], 'big') - position
        assert step in (0, -1)
        lowered -= step
        run = run + 1 if step else 0
        if run > found:
            found, last = run, position
        velocity = (sent[2] << 4 | sent[3] >> 4) * 60 / 4095 - 30
        assert abs(velocity + 0.0073) < 1e-4
    print(f'{name}: {lowered / 655.36:.1f} % of positions are lowered, {found} in a row below {last}')
    print(f'that is {found * 25 / 65535:.3f} rad; a velocity of 0 is sent as {velocity:.4f} rad/s')
    assert (round(lowered / 655.36, 1), found, last) == (share, longest, end)
PYTHON
