#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# opensourceleg 3.5.0: a torque of 0.5 N·m at the output of a T-Motor with a gear of 9 is sent as 40.5 N·m.
#
# Expected: the motor's torque is that of the output divided by the gear ratio, as its Dephy and Moteus actuators have
# it. What happens: TMotorServoActuator multiplies instead, and divides where it reads, so that output_torque says 0.5
# N·m again. From 0.77 N·m on the limit of 60 A holds, 62 N·m at the output. Of a Moteus, a current in amperes is
# taken as milliamperes: 40 A are a torque of 0.5 mN·m instead of 4.5 N·m, and the model of its winding, which is to
# stop the motor at 110 °C after 2.6 s, is at 29.7 °C after a minute.
# For us: call set_motor_torque() with the torque divided by the ratio; compute torques from motor_current.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    opensourceleg==3.5.0 python-can==4.6.1 moteus==0.3.101 smbus2==0.6.1
cd "$folder"
timeout 60 venv/bin/python - 2> log <<'PYTHON'
import asyncio
from types import SimpleNamespace

from moteus import Register
from opensourceleg.actuators import moteus, tmotor
from opensourceleg.actuators.base import CONTROL_MODES
from opensourceleg.math import ThermalLimitException, ThermalModel


class Can:
    def add_motor_listener(self, motor):
        pass

    def set_control_mode(self, identifier, mode):
        pass

    def set_current(self, identifier, amperes):
        self.amperes = float(amperes)


tmotor.CANManagerServo = Can
servo = tmotor.TMotorServoActuator(motor_type='AK80-9', gear_ratio=9.0)
servo.set_control_mode(CONTROL_MODES.CURRENT)
servo.set_output_torque(0.5)
amperes = servo._canman.amperes
servo._motor_state.current = amperes
print('0.5 N·m at the output:', amperes, 'A,', amperes * 0.115 * 9.0, 'N·m; read', servo.output_torque)
assert abs(amperes * 0.115 * 9.0 - 40.5) < 1e-9 and abs(servo.output_torque - 0.5) < 1e-9


class Transport:
    async def cycle(self, commands):
        values = {Register.Q_CURRENT: 40.0, Register.TEMPERATURE: 30.0}
        return [SimpleNamespace(values=values)]


async def minute(motor):
    for _ in range(60 * motor.frequency):
        await motor.update()


motor = moteus.MoteusActuator(gear_ratio=9.0)
moteus.MoteusInterface.transport = Transport()
asyncio.run(minute(motor))
model = ThermalModel(motor_constants=motor.MOTOR_CONSTANTS)
steps = 0
try:
    while True:
        model.update(dt=1 / motor.frequency, motor_current=40e3, case_temperature=30.0)
        steps += 1
except ThermalLimitException:
    pass
print('40 A:', motor.motor_torque, 'N·m,', motor.winding_temperature, '°C; hot after', steps / motor.frequency, 's')
assert abs(motor.motor_torque - 40.0 * 0.1133 / 9000) < 1e-9
assert 29.0 < motor.winding_temperature < 31.0 and steps / motor.frequency < 3.0
PYTHON
