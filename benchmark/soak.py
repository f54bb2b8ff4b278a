# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node at work for half an hour: nothing is lost, nothing is wrong, and memory stays flat.

    python benchmark/soak.py [--minutes 30] [--rate 1000] [--json]

A driver sends rotor_state with stamps that it counts, so that it is known what has to come from
the node, which has its default parameters. Every message on output_state, body_poses and
mechanism_joint_states is compared: stamps exactly, numbers to 1e-12 of a radian and of the
eccentricity, see `expected_state`. That a driver is late is no loss. The exit code is 1 if
anything was lost or wrong, or memory was not flat.
"""

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import Any

import numpy as np
from expected_state import (
    Array,
    ExpectedJointStates,
    ExpectedMessages,
    ExpectedOutputState,
    ExpectedPoses,
)
from peer import peer
from processes import NODE, Program, private_surroundings, program
from rotor_driver import counted_number, counted_stamp
from state_listener import Listener, receive_answers

from gear_kinematics.parameters import NodeParameters

TOPICS: Mapping[str, type[ExpectedMessages]] = {
    'output_state': ExpectedOutputState,
    'body_poses': ExpectedPoses,
    'mechanism_joint_states': ExpectedJointStates,
}
"""What is listened to."""
_PERIOD = 0.2  # s, of comparisons and samples
_WINDOW = 1_000  # messages that the driver may be ahead of the answers: half a queue of the node
_QUIET = 30.0  # s of silence after which nothing more is to come
_WARM_UP = 0.25  # of the time: until everything has been used
_PARTS = 10  # of the rest, whose growth is compared
# What the memory may have grown by. 0.3 MB are for the names that CPython's type cache comes to
# hold, slot by slot. In twenty seconds at 1 kHz it leaves room for 34 bytes a message, less than
# any container takes; in half an hour for 0.4.
_GROWTH = 512.0  # kB


class Topic:
    """What came on one topic, held against what had to come."""

    def __init__(self, expected: ExpectedMessages) -> None:
        """Start with nothing."""
        self.lost = 0
        self.wrong = 0
        self._expected = expected
        self.answered = 0
        """The number of the last answered message, and one more."""
        self._count = 0
        self._messages: list[bytes] = []

    def __len__(self) -> int:
        """How many messages came."""
        return self._count

    def add(self, data: bytes) -> None:
        """Take a message."""
        self._count += 1
        self._messages.append(data)

    def compare(self) -> None:
        """Compare what came since the last time. What is wrong is no answer, so it is lost too."""
        if not self._messages:
            return
        stamps, values = self._expected.read(self._messages)
        self._messages.clear()
        numbers = counted_number(stamps)
        right = np.isclose(
            values,
            self._expected.expected(numbers),
            rtol=0.0,
            atol=self._expected.bounds,
            equal_nan=True,
        ).all(axis=1)
        right &= counted_stamp(numbers) == stamps
        for number, is_right in zip(numbers.tolist(), right.tolist(), strict=True):
            if is_right and number >= self.answered:
                self.lost += number - self.answered
                self.answered = number + 1
            else:
                self.wrong += 1

    def close(self, sent: int) -> None:
        """Compare the rest, of so many in all."""
        self.compare()
        self.lost += sent - self.answered


def main() -> int:
    """Run the node and print what became of it; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--minutes', type=float, default=30.0)
    parser.add_argument('--rate', type=float, default=1000.0, metavar='HZ')
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    result = soak(options.minutes, options.rate)
    if options.json:
        print(json.dumps(result, indent=2))
    else:
        _print(result)
    return 0 if result['passed'] else 1


def soak(minutes: float, rate: float) -> dict[str, Any]:
    """Let the node answer a driver for so many minutes, and say what became of it."""
    mechanism = NodeParameters.load().mechanism
    topics = {name: Topic(expected(mechanism)) for name, expected in TOPICS.items()}
    count = round(60.0 * minutes * rate)
    with ExitStack() as stack:
        surroundings = stack.enter_context(private_surroundings())
        os.environ.update(surroundings.environment)
        own = stack.enter_context(peer('soak', surroundings.arguments))
        callbacks = {name: topic.add for name, topic in topics.items()}
        listener = stack.enter_context(Listener(own, callbacks))
        driver = stack.enter_context(Program(program('rotor_driver.py'), surroundings))
        driver.report()
        node = stack.enter_context(Program(NODE, surroundings))
        listener.wait_until_heard()
        driver.tell(rate=rate, count=count, allowed=_WINDOW, counted=True)
        samples = _follow(driver, node, listener, [*topics.values()])
        driven = driver.report()
        receive_answers(listener, [*topics.values()], count=count, quiet=_QUIET)
    for topic in topics.values():
        topic.close(count)
    return judge(driven, topics, samples)


def _follow(driver: Program, node: Program, listener: Listener, topics: Sequence[Topic]) -> Array:
    """Compare what comes until the driver reports; gives the samples for `judge`."""
    samples = []
    answered, deadline = 0, time.monotonic() + _QUIET
    while not driver.reports():
        samples.append((time.monotonic() / 60.0, node.memory() / 1024.0, node.cpu_time()))
        listener.receive(_PERIOD)
        for topic in topics:
            topic.compare()
        if (reached := min(topic.answered for topic in topics)) > answered:
            answered, deadline = reached, time.monotonic() + _QUIET
            driver.tell(allowed=answered + _WINDOW)
        elif time.monotonic() > deadline:
            raise RuntimeError(f'nothing answered for {_QUIET:g} s:\n{node.log()}')
    return np.array(samples)


def judge(
    driven: Mapping[str, Any], topics: Mapping[str, Topic], samples: Array
) -> dict[str, Any]:
    """Sum up.

    Args:
        driven: the driver's report.
        topics: what was compared, by name.
        samples: (n, 3) of the time (min), the node's memory (kB) and its time on processors (s).

    Returns:
        What is printed; `flat` tells whether memory was, and `passed` whether all is well.
    """
    settled = samples[round(_WARM_UP * len(samples)) :]
    edges = np.linspace(0, len(settled) - 1, _PARTS + 1).round().astype(int)
    minutes, memory, cpu_time = settled[edges].T
    growth = np.diff(memory) / np.diff(minutes)
    # The scatter between the parts tells what goes on from what happened once: while the machine
    # is busy queues get longer, and keep their memory.
    growth_error = np.std(growth, ddof=1) / math.sqrt(_PARTS)
    flat = (np.mean(growth) - 3.0 * growth_error) * (minutes[-1] - minutes[0]) <= _GROWTH
    cpu = 100.0 * np.diff(cpu_time) / np.diff(60.0 * minutes)
    (cpu_slope, _), covariance = np.polyfit(minutes[1:], cpu, 1, cov=True)
    lost = {name: topic.lost for name, topic in topics.items()}
    wrong = {name: topic.wrong for name, topic in topics.items()}
    return {
        **driven,
        'lost': lost,
        'wrong': wrong,
        'memory': _line(memory, np.mean(growth), growth_error),
        'cpu': _line(cpu, cpu_slope, np.sqrt(covariance[0, 0])),
        'flat': bool(flat),
        'passed': bool(flat) and not any([*lost.values(), *wrong.values()]),
    }


def _line(values: Array, slope: float, error: float) -> dict[str, float]:
    """The mean of values, their slope for a minute and its standard error."""
    return {'mean': float(np.mean(values)), 'slope': float(slope), 'error': float(error)}


def _print(result: Mapping[str, Any]) -> None:
    print(f'{result["sent"]} messages sent, at {result["rate"]:.1f} Hz')
    for name, lost in result['lost'].items():
        print(f'{name}: {lost} lost, {result["wrong"][name]} wrong')
    for name, unit in (('memory', 'kB'), ('cpu', '%')):
        mean, slope, error = result[name].values()
        print(f'{name}: {mean:.5g} {unit}, {slope:+.3g} ± {error:.2g} {unit}/min')
    print(f'memory is {"flat" if result["flat"] else "NOT flat"}')


if __name__ == '__main__':
    sys.exit(main())
