# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compare a recording with the outputs the node should have published, as a pytest could do."""

from argparse import ArgumentParser
from pathlib import Path

from gear_kinematics.parameters import default_config
from gear_kinematics.validation import explain, validate

ROOT = Path(__file__).parents[1]


def test_recording(bag: Path, parameters: Path) -> None:
    report = validate(bag, parameters)
    assert report.passed, explain(report)


if __name__ == '__main__':
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('bag', type=Path, nargs='?', default=ROOT / 'bags/servo_point_to_point')
    parser.add_argument('parameters', type=Path, nargs='?', default=default_config())
    given = parser.parse_args()
    test_recording(given.bag, given.parameters)
    print(f'{given.bag.name}: what was published is right')
