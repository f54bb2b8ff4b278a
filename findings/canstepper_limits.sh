#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# grafito-canstepper 0.2.3: an axis with a limit of 10 turns goes to 12 by two moves of 6, and anywhere before its first
# report.
#
# Expected of Axis(max_pos=10): move_by(6) and, before the axis is there, move_by(6) again are 12, so that the second is
# a LimitViolation. What happens: the limit is compared with the last position that was reported plus the step, but the
# motor adds the step to its goal, as the documentation of move_by() says: both are sent, and it goes to 12. As long as
# no position was reported, nothing is compared, and move_by(1000) is sent. run(1) is never compared with the limits,
# and turns through them. move_to(12) is refused, as is move_by(6) where the axis stands at 6.
# For us: keep the goal in the driver, and send move_to() alone.
#
# The motor is that of the package's own simulation, but turns with a speed. Exit code 0: still so. Installs the
# package.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check grafito-canstepper==0.2.3
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import struct

from canstepper import Axis, CANStepperBus, LimitViolation
from canstepper.protocol import Mode, Tel
from canstepper.sim import SimNetwork, SimNode


class TurningNode(SimNode):
    """A motor that turns by 360° a second to its goal, and reports where it is."""

    def _move(self, target):
        self.mode, self.target_deg = Mode.POSITION, target

    def tick(self, seconds):
        step = self.target_deg - self.position_deg
        self.position_deg += max(-360 * seconds, min(360 * seconds, step))
        self._emit(Tel.POSITION, struct.pack('<d', self.position_deg))


def axis(reported=True):
    network = SimNetwork([])
    network.nodes[1] = TurningNode(1, network)
    moved = Axis(CANStepperBus(network).node(1), rotation_distance=1.0, min_pos=0.0, max_pos=10.0)
    moved.node.enable()
    if reported:
        network.tick(0.0)
    return moved, network


def refused(move, *arguments):
    try:
        move(*arguments)
    except LimitViolation as error:
        print('refused:', error)
        return True
    return False


moved, network = axis()
assert refused(moved.move_to, 12.0)
assert not refused(moved.move_by, 6.0)
network.tick(1.0)
assert not refused(moved.move_by, 6.0)
network.tick(60.0)
print('two moves of 6 in a row:', moved.position, 'turns')
assert abs(moved.position - 12) < 1e-9

moved, network = axis()
moved.move_by(6.0)
network.tick(60.0)
assert refused(moved.move_by, 6.0)
network.nodes[1].position_deg = 3600.0
network.tick(0.0)
assert moved.position == 10 and not refused(moved.run, 1.0)
print('at the limit: runs on at', network.nodes[1].velocity_deg_s / 360, 'turns/s')
assert network.nodes[1].velocity_deg_s == 360
moved, network = axis(reported=False)
assert not refused(moved.move_by, 1000.0)
print('before the first report: goal', network.nodes[1].target_deg / 360, 'turns')
assert abs(network.nodes[1].target_deg - 360000) < 1e-6
PYTHON
