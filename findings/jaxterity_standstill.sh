#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# jaxterity 1.2.0: at standstill, a gear of 30 multiplies the torque of its motor by 312, and a self-locking screw
# pushes 1930 times too hard.
#
# 1 N·m at the motor of a Gearbox of 30 whose efficiency is 0.8 forward and 0.05 backward ("nearly non-backdrivable").
# Expected at the joint: 24 N·m while it drives, and no more than 30 N·m when it stands. What happens: 312 N·m at a
# speed of 0, and 24 N·m at 0.1 rad/s. The documented formula passes smoothly from 0.8 to 1 / 0.05 with the sign of the
# power, so it takes the mean of both at a power of 0; what this does to a drive that starts is not mentioned. With the
# efficiencies by default it is 32.3 N·m. A LeadScrew.from_geometry() of 2 mm that locks itself pushes with 157 kN
# instead of 81 N at 0.1 N·m. So each simulation that begins at rest begins with a blow.
# For us: take a transmission's torque at standstill as ratio times motor torque, within its friction, not from these
# blocks.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check jaxterity==1.2.0 jax==0.9.2 jaxonomy==3.4.1 \
    numpy==2.4.6 mujoco==3.10.0
cd "$folder"
timeout 120 venv/bin/python - 2> log <<'PYTHON' || { cat log; exit 1; }
from jaxonomy import DiagramBuilder
from jaxonomy.library import Constant
from jaxterity.actuators.gearbox import Gearbox
from jaxterity.actuators.lead_screw import LeadScrew


def delivered(block, torque, speed):
    builder = DiagramBuilder()
    builder.add(block)
    for port, value in zip(block.input_ports, (torque, speed)):
        source = builder.add(Constant(value, name=f'source_{port.name}'))
        builder.connect(source.output_ports[0], port)
    diagram = builder.build()
    return float(block.output_ports[0].eval(diagram.create_context()))


blocks = {
    'gearbox': (lambda: Gearbox(N=30.0, eta_f=0.8, eta_b=0.05), 1.0, 312.0, 24.0),
    'screw': (lambda: LeadScrew.from_geometry(lead=0.002, pitch_diameter=0.012, mu=0.15), 0.1, 157120.0, 81.43),
    'gearbox by default': (lambda: Gearbox(), 1.0, 32.25, 27.0),
}
for name, (block, torque, standing, moving) in blocks.items():
    results = [delivered(block(), torque, speed) for speed in (0.0, 0.1)]
    print(f'{name}: {torque} N·m give {results[0]:.1f} at standstill and {results[1]:.2f} at 0.1 rad/s')
    assert abs(results[0] - standing) < 1e-4 * standing and abs(results[1] - moving) < 1e-3 * moving
PYTHON
