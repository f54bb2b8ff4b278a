#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# apexdrive 1.3.0: with mock_mode=False, an actuator on a bus that does not exist turns, with 48 V, 35 °C and no fault.
#
# Expected: the client for SocketCAN opens the bus, or raises an error. What happens: Actuator() never opens anything,
# whatever interface, node and mock_mode it is given. set_impedance() steps a simulated rotor by 1 ms a call, also
# before arm() and however much time has passed, and get_state() gives its angle as that of the actuator, with
# constants as the voltage and the temperature. An emergency stop leaves its speed as it was.
# For us: a state of this library is no measurement; 48.0 V and 35.0 °C that never change are its mark.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check apexdrive==1.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import time

from apexdrive import Actuator

joint = Actuator(interface='no-such-bus', node_id=200, mock_mode=False)
for _ in range(10):
    joint.set_impedance(pos_rad=1.0, kp=50.0, kd=0.1)
    time.sleep(0.01)
state = joint.get_state()
joint.emergency_stop()
stopped = joint.get_state()
print(state, 'after the stop', stopped.velocity_rad_s)
assert state.mode == 'STANDBY' and state.position_rad > 1.0 and state.fault_flags == 0
assert (state.v_bus_v, state.temperature_c) == (48.0, 35.0)
assert stopped.velocity_rad_s == state.velocity_rad_s != 0.0
PYTHON
