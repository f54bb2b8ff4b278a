# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Without rosbags, as on a machine of which apt installed everything."""

import sys
from functools import partial

import pytest
from blocked_bags import finished
from made_bags import mcap_file, ros1_bag
from mcap.writer import CompressionType
from shipped_bags import BAGS

WITHOUT = """
import sys


class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split('.')[0] in BLOCKED:
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)


BLOCKED = sys.argv.pop(1).split(',')
sys.meta_path.insert(0, Missing())
"""
ALL_MODULES = """
import importlib
import pkgutil

import gear_kinematics

for module in pkgutil.walk_packages(gear_kinematics.__path__, 'gear_kinematics.'):
    if not module.name.endswith(('__main__', *NEED_ROSBAGS)):
        importlib.import_module(module.name)
"""
NEED_ROSBAGS = ('bag.ros1', 'bag.writing')
GEARKIN = """
from gear_kinematics.commands.cli import main

sys.exit(main())
"""
ADVICE = "pip install 'gear_kinematics[rosbags]'"


def run(code: str, *arguments: object, blocked: str = 'rosbags'):
    return finished([sys.executable, '-c', WITHOUT + code, blocked, *arguments])


def gearkin(*arguments: object, blocked: str = 'rosbags') -> str:
    done = run(GEARKIN, *arguments, blocked=blocked)
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


@pytest.mark.slow
def test_no_other_module_needs_rosbags():
    done = run(f'NEED_ROSBAGS = {NEED_ROSBAGS}\n{ALL_MODULES}')
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize('blocked', ['rosbags', 'rosbags,lz4,backports,compression'])
def test_recordings_are_validated(blocked):
    """The second time zstandard decompresses, which Ubuntu has packaged."""
    shipped = [BAGS / name for name in ('servo_point_to_point', 'driver_faults')]  # mcap, sqlite3
    assert gearkin('validate', *shipped, blocked=blocked).count('verdict: passed') == 2


@pytest.mark.slow
def test_what_cannot_be_written_is_one_line(tmp_path):
    done = run(GEARKIN, 'compute', BAGS / 'driver_faults', tmp_path / 'out')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == f'gearkin: rosbags is not installed: {ADVICE}\n'
    assert gearkin('compute', '--help').startswith('usage: ')
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize(
    ('make', 'blocked', 'remedy'),
    [
        (ros1_bag, 'rosbags', ADVICE),
        (
            mcap_file,
            'zstandard,backports,compression',
            'apt install python3-zstandard, or pip install backports.zstd',
        ),
        (
            partial(mcap_file, compression=CompressionType.LZ4),
            'lz4',
            'apt install python3-lz4, or pip install lz4',
        ),
    ],
)
def test_what_a_recording_needs_is_one_line(recorded, make, blocked, remedy, tmp_path):
    bag = make(tmp_path / 'b', recorded)
    done = run(GEARKIN, 'validate', bag, blocked=blocked)
    assert done.returncode == 2
    needed = f'needs {blocked.split(",")[0]}: {remedy}'
    assert done.stderr.startswith(f'gearkin: {bag}: ')
    assert done.stderr.endswith(f'{needed}\n')
    assert done.stderr.count('\n') == 1
