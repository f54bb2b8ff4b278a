#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# py_gearworks 0.0.24: a gear pair without backlash has a backlash of 0.42 mm.
#
# calc_involute_mesh_distance() gives the distance of the axes for a backlash, and backlash_from_ax_distance() is said
# to be its inverse. Two gears of module 1 with 20 and 40 teeth, at 20°, have 30 mm and no backlash, 30.1436 mm and 0.1
# mm of it: the first agrees with the textbook to 1e-9 mm. What happens: the second gives 0.42 mm and 0.52 mm, as one of
# its terms is taken once instead of twice. It wants the angles at the base circle with the other sign, too; with the
# same, it gives 4.2 mm.
# For us: backlash along the line of action is 2 (r1 + r2) (inv a - inv 20°), with cos a = (r1 + r2) / distance, r at
# the base.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
    py_gearworks==0.0.24 numpy==2.4.6 scipy==1.17.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import importlib.util
import math
import sys
import types

package = types.ModuleType('py_gearworks')  # without the modules that draw, which need a CAD kernel
package.__path__ = importlib.util.find_spec('py_gearworks').submodule_search_locations
sys.modules['py_gearworks'] = package

from py_gearworks.gearmath import (  # noqa: E402
    backlash_from_ax_distance,
    calc_involute_mesh_distance,
)

TEETH, PRESSURE = (20, 40), math.radians(20)


def involute(angle):
    return math.tan(angle) - angle


radii = [teeth / 2 * math.cos(PRESSURE) for teeth in TEETH]
halves = [math.pi / 2 / teeth + involute(PRESSURE) for teeth in TEETH]
pitch = math.tau / TEETH[1]
for backlash in (0.0, 0.1, 0.2):
    distance = calc_involute_mesh_distance(*radii, *halves, pitch, backlash=backlash)
    meshing = math.acos(sum(radii) / distance)
    textbook = 2 * sum(radii) * (involute(meshing) - involute(PRESSURE))
    negated = backlash_from_ax_distance(distance, *radii, *(-half for half in halves), pitch)
    same = backlash_from_ax_distance(distance, *radii, *halves, pitch)
    print('backlash', backlash, 'distance', distance, 'textbook', textbook, 'given back', negated, same)
    assert abs(textbook - backlash) < 1e-9
    assert abs(negated - backlash - 0.420166) < 1e-6
    assert abs(same - backlash - 4.212630) < 1e-6
PYTHON
