# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Print the figures of a catalogue from torque ramps: hysteresis, backlash and stiffness."""

import math
from argparse import ArgumentParser
from pathlib import Path

from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.parameters import NodeParameters

ArgumentParser(description=__doc__).parse_args()
config = NodeParameters.load()
ramps = Path(__file__).parents[1] / 'docs/examples/ramps.csv'
report = measure(read(ramps, config), config, rated_torque=5.0)
figures = report.figures


def arc_minutes(angle: float) -> str:
    return f'{60.0 * math.degrees(angle):.2f}′'


hysteresis = figures.hysteresis
print(f'hysteresis {arc_minutes(hysteresis.value)} ± {arc_minutes(hysteresis.uncertainty)}')
print(f'backlash {arc_minutes(figures.backlash.low)} to {arc_minutes(figures.backlash.high)}')
for part in figures.stiffness:
    print(f'stiffness from {part.low:g} to {part.high:g} N·m: {part.slope.value:.0f} N·m/rad')
