# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the loads add to the node's work for a message, beside its other topics, in one run.

    python benchmark/loads.py [--rounds 200]

All take turns with the messages of one motion; the values are medians over the rounds.
"""

import argparse
import math
import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import replace

from gear_kinematics.kinematics import RotorSample, split_turns
from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import LoadEstimator, PreloadMonitor
from gear_kinematics.state.state_messages import Row, state_messages
from gear_kinematics.wire.topics import BODY_POSES, LOAD_TOPICS, OUTPUT_STATE

_MESSAGES = 500
_MOST = 8.0  # µs
_BODIES = Bodies(0.05, 2e-5, 0.02, 3e-6, 4e-5, 0.4)  # kg, kg·m², rad


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--rounds', type=int, default=200)
    rounds = parser.parse_args().rounds
    parameters = replace(NodeParameters.load(), preload=3.0, branch_stiffness=(2000.0,))
    messages = state_messages(parameters)
    monitor = PreloadMonitor(parameters)
    braced, heavy = LoadEstimator(parameters), LoadEstimator(replace(parameters, loads=_BODIES))

    def margin(sample: RotorSample) -> None:
        monitor.follow(sample, 0)
        if sample is samples[-1]:
            monitor.report()

    def encoded(sample: RotorSample, rows: Iterable[Row]) -> list[bytes]:
        return [template.encode(sample.stamp, numbers) for _, template, numbers in rows]

    def loads(of: LoadEstimator, sample: RotorSample) -> list[bytes]:
        return encoded(sample, of.rows(of.follow(sample, 0), LOAD_TOPICS))

    jobs: dict[str, Callable[[RotorSample], object]] = {
        'output_state and body_poses': lambda sample: encoded(
            sample, messages.rows(sample, (OUTPUT_STATE, BODY_POSES))
        ),
        'margin of the preload': margin,
        'branch_loads and joint_loads': lambda sample: loads(braced, sample),
        'both, of bodies with mass': lambda sample: loads(heavy, sample),
    }
    samples = [
        RotorSample(k * 1_000_000, split_turns(0.1 * k), 100.0, math.sin(0.01 * k))
        for k in range(_MESSAGES)
    ]
    taken: dict[str, list[float]] = {name: [] for name in jobs}
    for _ in range(rounds):
        for name, job in jobs.items():
            begun = time.process_time()
            for sample in samples:
                job(sample)
            taken[name].append(1e6 * (time.process_time() - begun) / _MESSAGES)
    values = {name: statistics.median(times) for name, times in taken.items()}
    beside = values['output_state and body_poses']
    for name, value in values.items():
        print(f'{name}: {value:.1f} µs a message, {value / beside:.2f} × the first')
    print(f'target: branch_loads and joint_loads at most {_MOST:g} µs')


if __name__ == '__main__':
    main()
