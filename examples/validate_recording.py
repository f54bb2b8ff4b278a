# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compare a recording with the outputs the node should have published, as a pytest could do.

python validate_recording.py [BAG [PARAMETERS]]
"""

import sys
from pathlib import Path

from gear_kinematics.parameters import default_config
from gear_kinematics.validation import explain, validate

ROOT = Path(__file__).parents[1]


def test_recording(bag: Path, parameters: Path) -> None:
    report = validate(bag, parameters)
    assert report.passed, explain(report)


if __name__ == '__main__':
    given = [*map(Path, sys.argv[1:])]
    bag = given[0] if given else ROOT / 'bags/servo_point_to_point'
    test_recording(bag, given[1] if len(given) > 1 else default_config())
    print(f'{bag.name}: what was published is right')
