# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Calibrate a gear from a recording of rotor and output encoder, and check it with another one."""

from argparse import ArgumentParser
from dataclasses import replace
from pathlib import Path

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.calibration import fit, judge
from gear_kinematics.measurement.reading import read
from gear_kinematics.parameters import NodeParameters

parser = ArgumentParser(description=__doc__)
parser.add_argument('first', type=Path, help='bag or CSV file')
parser.add_argument('second', type=Path, help='bag or CSV file')
parser.add_argument('ratio', type=GearRatio.parse, help='such as -19 or 1457/26')
given = parser.parse_args()
first, second, ratio = given.first, given.second, given.ratio
config = replace(NodeParameters.load(), gear_ratio=str(ratio))
result = fit([read(first, config)], ratio)
Path('calibration.yaml').write_text(result.calibration.text(), 'utf-8')  # a parameter of the node
judged = judge(read(second, config), result.calibration)
print(f'rms of the error on {second.name}: {1e3 * judged.rms_before:.2f} mrad before, ', end='')
width = 1e3 * result.calibration.half_width
print(f'{1e3 * judged.rms_after:.2f} mrad after; interval ± {width:.2f} mrad')
print('it holds' if judged.holds else 'it does not hold')
