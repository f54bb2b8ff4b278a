#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# moteus 1.1.1: in 16 bits, a command to turn to 5 turns is sent as 3.2767 turns, without an error.
#
# The resolution INT16, which saves bytes on the bus, has steps of 0.1 mrev for a position and of 0.25 mrev/s for a
# velocity. A position beyond ±3.2767 turns, which a rotor before a gear of 19 reaches in a sixth of a turn of its
# output, and a velocity beyond ±8.19 rev/s are cut to these. A controller's answer that is read in 16 bits ends there
# as well.
# For us: keep F32 or INT32 for the position and the velocity of a rotor; INT16 is enough for torques.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check moteus==1.1.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import moteus


def sent(resolution, layout, position, velocity):
    chosen = moteus.PositionResolution()
    chosen.position = chosen.velocity = resolution
    data = moteus.Controller(id=1, position_resolution=chosen).make_position(
        position=position, velocity=velocity
    ).data
    return struct.unpack_from(layout, data, len(data) - struct.calcsize(layout))


short = [value * step for value, step in zip(sent(moteus.INT16, '<hh', 5.0, 20.0), (1e-4, 2.5e-4))]
exact = sent(moteus.F32, '<ff', 5.0, 20.0)
within = sent(moteus.INT16, '<hh', 3.2, 8.0)
print('INT16', short, 'F32', exact, 'INT16 of 3.2 turns and 8 rev/s', within)
assert abs(short[0] - 3.2767) < 1e-9 and abs(short[1] - 8.19175) < 1e-9
assert exact == (5.0, 20.0)
assert within == (32000, 32000)
PYTHON
