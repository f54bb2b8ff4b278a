# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How often the figures of torque ramps hold on simulated gears, as a table."""

import argparse
import json
import math
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from itertools import count, repeat
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test' / 'support'))

from simulated_ramps import SCENARIOS, judge

ARC_MINUTES = 60.0 * math.degrees(1.0)


def main() -> None:
    """Print a row for each scenario."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=200, help='recordings of each scenario')
    parser.add_argument('--jobs', type=int, default=1)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    start = time.perf_counter()
    with ProcessPoolExecutor(options.jobs) as pool:
        # Gears of their own for each scenario.
        found = list(pool.map(judge, SCENARIOS, repeat(options.seeds), count(1)))
    if options.json:
        print(json.dumps({s.name: one._asdict() for s, one in zip(SCENARIOS, found, strict=True)}))
        return
    print(
        '| scenario | hysteresis | friction | backlash | median width | 95 % of them | above 0 |'
    )
    print('|---|---|---|---|---|---|---|')
    for scenario, one in zip(SCENARIOS, found, strict=True):
        held = map(_percent, (one.hysteresis, one.friction, one.backlash))
        widths = (f'{ARC_MINUTES * width:.1f}′' for width in (one.width, one.widest))
        name = scenario.name if scenario.contained else f'*{scenario.name}*'
        print(f'| {" | ".join([name, *held, *widths, _percent(one.above_zero)])} |')
    print(f'{options.seeds} recordings each, {time.perf_counter() - start:.0f} s')


def _percent(share: float) -> str:
    return '' if math.isnan(share) else f'{100.0 * share:.1f} %'


if __name__ == '__main__':
    main()
