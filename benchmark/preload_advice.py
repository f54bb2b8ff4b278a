# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How often the advice on a preload holds on simulated gears."""

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test' / 'support'))

from advising import SETTINGS, coverage


def main() -> None:
    """Print a line for each choice of settings."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=1000, help='of each choice')
    parser.add_argument('--load', type=float, default=2.0, help='N·m')
    parser.add_argument('--scatter', type=float, default=0.1, help='relative, of recordings')
    parser.add_argument('--settings', nargs='+', choices=SETTINGS)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    results = {}
    for name in options.settings or SETTINGS:
        results[name] = coverage(name, options.seeds, options.load, options.scatter)
        if not options.json:
            shares = ', '.join(f'{what} {s:.3f}' for what, s in results[name].items())
            print(f'{name}: {shares}', flush=True)
    if options.json:
        print(json.dumps(results))


if __name__ == '__main__':
    main()
