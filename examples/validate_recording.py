"""Hold a recording of a package to what the node should have published, as its pytest could.

python validate_recording.py [BAG [PARAMETERS]]
"""

import sys
from pathlib import Path

from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validate_bag import validate_bag

ROOT = Path(__file__).parents[1]


def test_recording(bag: Path, config: Path) -> None:
    report = validate_bag(Task(bag, NodeParameters.load(config), str(config)))
    assert report.passed, report.error or '; '.join(finding.text for finding in report.findings)


if __name__ == '__main__':
    given = [*map(Path, sys.argv[1:])]
    bag = given[0] if given else ROOT / 'bags/servo_point_to_point'
    test_recording(bag, given[1] if len(given) > 1 else default_config())
    print(f'{bag.name}: what was published is right')
