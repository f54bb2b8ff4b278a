#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# TMotorCANControl 1.2.6: an AK80-64 has a gear of 80, and the torque of a rotor is that of its output times the gear.
#
# Expected: 64 turns of the rotor for one of the output, the rotor's torque as 1/9 of that of an AK80-9's output, and
# a positive acceleration where a motor gets faster. What happens: the table of motors has 80 as the ratio of an
# AK80-64, so that its rotor is read 25 % too far and a goal of 64 rad turns it by 51.2 rad. The torque of the rotor
# is that of the output times the ratio, and as a goal 1 N·m at the rotor is 0.115 N·m at the output. The acceleration
# has the wrong sign, as its interval is subtracted the wrong way round. A virtual bus answers here in the MIT frames
# of the AK series.
# For us: take the values of the output, and compute those of the rotor from them.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-can==4.6.1 numpy==2.4.6 pyserial==3.5
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps TMotorCANControl==1.2.6
timeout 60 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import time

import can
from TMotorCANControl import mit_can

mit_can.os.system = lambda command: 0
mit_can.can.interface.Bus = lambda channel, bustype: can.Bus(interface='virtual', channel='bench')


class Motor(can.Listener):
    """Answers each command with a position of 1 rad, a torque of 9 N·m and a speed that rises by 0.5 rad/s."""

    def __init__(self, bus, kind):
        self.bus, self.limits, self.speed, self.commands = bus, mit_can.MIT_Params[kind], 0.0, []

    def word(self, value, name, bits):
        least, most = self.limits[f'{name}_min'], self.limits[f'{name}_max']
        return round((value - least) / (most - least) * (2**bits - 1))

    def on_message_received(self, message):
        self.commands.append(bytes(message.data))
        self.speed = min(self.speed + 0.5, 40.0)
        words = self.word(1.0, 'P', 16) << 24 | self.word(self.speed, 'V', 12) << 12 | self.word(9.0, 'T', 12)
        self.bus.send(can.Message(arbitration_id=0, data=b'\x01' + words.to_bytes(5, 'big') + b'\x1e\x00'))


def tried(kind):
    with can.Bus(interface='virtual', channel='bench') as bus:
        answering = Motor(bus, kind)
        notifier = can.Notifier(bus, [answering])
        with mit_can.TMotorManager_mit_can(motor_type=kind, motor_ID=1) as motor:
            motor.update()
            time.sleep(0.02)
            motor.update()
            output, rotor = motor.get_output_torque_newton_meters(), motor.get_motor_torque_newton_meters()
            acceleration = motor.get_output_acceleration_radians_per_second_squared()
            found = motor.get_motor_angle_radians(), rotor / output, acceleration
            motor.set_current_gains()
            motor.set_motor_torque_newton_meters(1.0)
            sent = motor._command.current * motor.get_output_torque_newton_meters() / motor.get_current_qaxis_amps()
            motor.set_impedance_gains_real_unit()
            motor.set_motor_angle_radians(64.0)
            goal = motor._command.position
        notifier.stop()
    print(kind, 'rotor at', found[0], 'rad, its torque', found[1], 'times, acceleration', found[2], 'sent', sent, goal)
    return *found, sent, goal


angle, _, _, _, goal = tried('AK80-64')
assert abs(angle - 80.0) < 0.05 and abs(goal - 0.8) < 1e-9
_, ratio, acceleration, sent, _ = tried('AK80-9')
assert abs(ratio - 9.0) < 1e-9 and acceleration < 0 and abs(sent - 0.115) < 1e-9
PYTHON
