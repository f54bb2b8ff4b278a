# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How good calibrations of simulated gears are on recordings that were not used."""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test' / 'support'))

from calibrating import IN_CLASS, MOTIONS, OUT_OF_CLASS, judged


def main() -> None:
    """Print a line for each scenario."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--gears', type=int, default=200, help='of each scenario')
    parser.add_argument('--duration', type=float, default=60.0, help='of a recording, s')
    parser.add_argument('--motion', choices=MOTIONS, default='fast')
    parser.add_argument('--scenario', nargs='+', choices=[*IN_CLASS, *OUT_OF_CLASS])
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    results = {}
    for name, setting in (IN_CLASS | OUT_OF_CLASS).items():
        if options.scenario and name not in options.scenario:
            continue
        start = time.process_time()
        found = judged(setting, options.gears, options.duration, options.motion)
        rms = [one.relative_rms for one in found]
        results[name] = {
            'relative_rms': float(np.mean(rms)),
            'relative_rms_95': float(np.quantile(rms, 0.95)),
            'coverage': float(np.mean([one.coverage for one in found])),
            'seconds': (time.process_time() - start) / options.gears,
        }
        if not options.json:
            values = ', '.join(f'{key} {value:.4f}' for key, value in results[name].items())
            print(f'{name}: {values}', flush=True)
    if options.json:
        print(json.dumps(results))


if __name__ == '__main__':
    main()
