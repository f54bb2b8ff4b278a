#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cycloidgen 8.0.0: the forces of the output pins are not in the load of a cycloidal gear's cam bearing, which lives 3
# times too long.
#
# A gear of 39 lobes with two discs, 60 N·m at the output, 3000 rpm. Ring pins, output pins and cam hold a disc in
# balance. Expected of eccentric_bearing_load_N: the greatest sum of the forces of both kinds of pins, 1402 N, as all
# output pins push the disc against its eccentricity. What happens: 1004 N, the ring pins alone. The bearing that is
# chosen by it, HK2212, has a life of 29015 h instead of 9544 h. The losses of the cam and the radial load of the motor
# are computed from the same force. The greatest forces of a ring pin and of an output pin are right.
# For us: add the forces of the output pins, 4 T / (pi R) for each disc, to those of the ring pins before choosing the
# cam's bearing.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pydantic==2.12.5 numpy==2.4.6
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps cycloidgen==8.0.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from cycloidgen.analysis.bearings import life_hours, select_bearings
from cycloidgen.analysis.mechanics import analyse_contacts
from cycloidgen.core.kinematics import contacts, disc_pose
from cycloidgen.core.spec import GearSpec
from cycloidgen.core.validate import validate

gear = GearSpec(
    lobes=39, eccentricity=0.8, pin_radius=2.0, disc_thickness=12.0, center_bore_diameter=28.0,
    eccentric_cam_diameter=22.0, output_pin_count=8, process='CNC machined', disc_material='Steel 1045',
    housing_material='Steel 1045', output_torque_Nm=60.0, input_rpm=3000.0,
)
assert not [finding for finding in validate(gear).findings if finding.severity.value != 'info']
torque = gear.output_torque_Nm * 1000 / gear.disc_count  # of one disc, N·mm
ring_loads, cam_loads, output_pin_loads = [], [], []
for crank in np.linspace(0, 2 * np.pi, 721):
    ring = contacts(gear, crank)
    pins = ring.forces(torque)
    on_disc = -(pins[:, None] * ring.normals).sum(axis=0)
    centre, turn = disc_pose(crank, gear.eccentricity, gear.lobes)
    arms = ring.points - centre
    moment = -(pins * (arms[:, 0] * ring.normals[:, 1] - arms[:, 1] * ring.normals[:, 0])).sum()
    # A pin lies on the side of its hole that the eccentricity points away from, and can only push there.
    places = turn + 2 * np.pi * np.arange(gear.output_pin_count) / gear.output_pin_count
    holes = gear.output_bolt_circle_radius * np.stack([np.cos(places), np.sin(places)], axis=1)
    push = -centre / gear.eccentricity
    levers = np.maximum(holes[:, 1] * push[0] - holes[:, 0] * push[1], 0)
    output_pins = torque * levers / (levers**2).sum()
    assert abs(moment - (output_pins * levers).sum()) < 1e-6  # the disc is in balance about its centre
    ring_loads.append(np.hypot(*on_disc))
    cam_loads.append(np.hypot(*(on_disc + output_pins.sum() * push)))
    output_pin_loads.append(output_pins.max())
contact = analyse_contacts(gear)
load = contact.eccentric_bearing_load_N
(choice,) = (choice for choice in select_bearings(gear, load, 0) if choice.role == 'Eccentric cam bearing')
right_life = life_hours(choice.bearing, max(cam_loads), choice.speed_rpm)
print(f'cam {load:.0f} N instead of {max(cam_loads):.0f} N, ring pins alone {max(ring_loads):.0f} N, '
      f'{choice.bearing.designation} {choice.life_hours:.0f} h instead of {right_life:.0f} h')
assert abs(max(output_pin_loads) / contact.max_output_force_N - 1) < 0.01
assert abs(load - max(ring_loads)) < 0.1 and abs(max(cam_loads) / load - 1.396) < 0.001
assert choice.bearing.designation == 'HK2212' and 3.0 < choice.life_hours / right_life < 3.1
PYTHON
