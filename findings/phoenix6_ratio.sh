#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# phoenix6 26.3.0: behind a gear of 20, an output that turned by 800 turns in simulation is read at 799.80 turns.
#
# Expected of a simulated TalonFX with a sensor_to_mechanism_ratio of 20: the position of the rotor, divided by 20. What
# happens: the ratio acts as 20.0049, so that each turn of the output is read 1.5 mrad short, and this adds up: 0.195
# turns are missing after 800. The reason fits all ratios: the reciprocal is cut off to a multiple of 1/65536, here 3276
# of 3276.8. A ratio of 16 is right, one of 1457/26 is 0.04 % off and one of 750 is 0.44 % off. The ratio that is read
# back from the device, and the position of the rotor, are right. The documentation gives the range from -1000 to 1000.
# For us: give the node the position of the rotor, get_rotor_position(), and leave the ratio to it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check phoenix6==26.3.0
cat > "$folder/gear.py" <<'PYTHON'
import sys
import time
from fractions import Fraction

from phoenix6 import configs, hardware, unmanaged

ROTOR, RESOLUTION = 16000, 1 / 4096

unmanaged.set_phoenix_diagnostics_start_time(-1)
motor = hardware.TalonFX(1)


def until(condition):
    """Wait until a condition holds, at most for 20 s."""
    deadline = time.monotonic() + 20
    while not condition():
        assert time.monotonic() < deadline
        unmanaged.feed_enable(0.5)
        time.sleep(0.02)


def at_rest():
    """Whether the rotor has arrived and the position has not changed for 0.3 s."""
    position = motor.get_position().value
    time.sleep(0.3)
    return motor.get_rotor_position().value == ROTOR and motor.get_position().value == position != 0


def output(ratio):
    """The position of the output at 16 000 turns of the rotor."""
    gear = configs.TalonFXConfiguration()
    gear.feedback.sensor_to_mechanism_ratio = float(ratio)
    motor.sim_state.set_supply_voltage(12)
    motor.sim_state.set_raw_rotor_position(0)
    until(lambda: motor.configurator.apply(gear).is_ok())
    until(lambda: motor.get_rotor_position().value == 0 == motor.get_position().value)
    motor.sim_state.set_raw_rotor_position(ROTOR)
    until(at_rest)
    read = configs.TalonFXConfiguration()
    until(lambda: motor.configurator.refresh(read).is_ok())
    assert abs(read.feedback.sensor_to_mechanism_ratio - ratio) < 1e-4 * ratio
    return motor.get_position().value


for ratio in (Fraction(16), Fraction(20), Fraction(1457, 26), Fraction(750)):
    found, right = output(ratio), ROTOR / ratio
    cut_off = ROTOR * (65536 / ratio // 1) / 65536
    print(f'read: ratio {ratio}, output at {float(right):.3f} turns, read at {found:.3f}', file=sys.stderr)
    assert abs(found - cut_off) <= 2 * RESOLUTION, (found, cut_off)
    assert (ratio == 16) == (abs(found - right) <= 2 * RESOLUTION)
PYTHON
cd "$folder"
CTR_TARGET=Simulation timeout 200 venv/bin/python gear.py > log 2>&1 || { cat log; exit 1; }
grep '^read' log
