# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a simulated millisecond costs: both models of the twin, and the servo loop on top."""

import argparse
import json
import statistics
import time
from collections.abc import Callable

from gear_kinematics.twin.driver import Command, Driver
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.mujoco_model import MujocoModel
from gear_kinematics.twin.parameters import TwinParameters, default_config

MILLISECOND = 1e-3
MODELS: dict[str, Callable[[TwinGear], TwinModel]] = {'fast': FastModel, 'MuJoCo': MujocoModel}


def main() -> None:
    """Print the CPU time of each model over the time that it simulates."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=2.0, help='simulated in a round')
    parser.add_argument('--rounds', type=int, default=5, help='of which the median counts')
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    steps = round(options.seconds / MILLISECOND)
    gear = TwinGear.load(default_config())
    rounds = [
        {
            (name, way): measure(model(gear), steps)
            for name, model in MODELS.items()
            for way, measure in {'alone': alone, 'driven': driven}.items()
        }
        for _ in range(options.rounds)
    ]
    results: dict[str, dict[str, float]] = {}
    for name in MODELS:
        for way in ('alone', 'driven'):
            cost = statistics.median(each[name, way] for each in rounds)
            ratio = statistics.median(each[name, way] / each['fast', way] for each in rounds)
            results[f'{name}, {way}'] = {
                'microseconds_per_millisecond': 1e6 * cost * MILLISECOND,
                'of_real_time': cost,
                'times_the_fast_model': ratio,
            }
    if options.json:
        print(json.dumps(results))
        return
    print('| model | CPU time of a simulated ms | of real time | times the fast model |')
    print('|---|---|---|---|')
    for name, each in results.items():
        cost, share, ratio = each.values()
        print(f'| {name} | {cost:.0f} µs | {100 * share:.1f} % | {ratio:.1f} × |')


def alone(model: TwinModel, steps: int) -> float:
    """CPU time over simulated time of a model under a load, with the rotor locked."""
    model.rotor_locked = True
    start = time.process_time()
    for _ in range(steps):
        model.advance(MILLISECOND, 0.0, 3.0)
    return (time.process_time() - start) / (steps * MILLISECOND)


def driven(model: TwinModel, steps: int) -> float:
    """CPU time over simulated time of a model with a driven rotor and both encoders read."""
    own = TwinParameters.of({'max_rotor_torque': 1.0, 'rotor_counts': 0, 'output_counts': 0})
    driver = Driver(model, own)
    driver.follow(Command(None, 20.0, None))
    start = time.process_time()
    for _ in range(steps):
        driver.advance(MILLISECOND, 3.0)
        driver.rotor()
        driver.output()
    return (time.process_time() - start) / (steps * MILLISECOND)


if __name__ == '__main__':
    main()
