# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a Dask scheduler with two workers takes for 40 recordings, beside `--jobs 2`.

    python benchmark/cluster.py [--rounds 5]

Both take turns. The cluster is running, as one that is used is; the values are medians.
"""

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from distributed import LocalCluster

_BAG = Path(__file__).parents[1] / 'bags' / 'servo_point_to_point'
_GEARKIN = 'import sys; from gear_kinematics.__main__ import gearkin; sys.exit(gearkin())'
_MOST = 1.2  # times what --jobs takes


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rounds', type=int, default=5)
    rounds = parser.parse_args().rounds
    with (
        tempfile.TemporaryDirectory() as folder,
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
    ):
        for k in range(40):
            Path(folder, f'recording_{k}').symlink_to(_BAG)
        ways = ['--jobs', '2'], ['--scheduler', cluster.scheduler_address]
        taken: list[list[float]] = [[], []]
        for _ in range(rounds):
            for way, times in zip(ways, taken, strict=True):
                began = time.perf_counter()
                command = [sys.executable, '-c', _GEARKIN, 'validate', '--quiet', *way]
                subprocess.run([*command, *sorted(Path(folder).iterdir())], check=True)  # noqa: S603, its own
                times.append(time.perf_counter() - began)
    processes, workers = map(statistics.median, taken)
    print(f'--jobs 2: {processes:.2f} s, --scheduler: {workers:.2f} s')
    print(f'{workers / processes:.2f} x, at most {_MOST} x')
    return workers > _MOST * processes


if __name__ == '__main__':
    sys.exit(main())
