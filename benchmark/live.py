# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the live node costs and how soon it answers, against other nodes, in one run.

    python benchmark/live.py [--outputs output_state ...] [--rates 500 1000 ...] [--seconds 5]
                             [--rounds 5] [--json]

Driver, node and listener are three processes on this machine. The driver sends rotor_state
reliably at a steady rate, the listener takes output_state and body_poses, or one of them, and the
queues of both hold more than ever waits, so that every loss is the node's. Counting starts when
probes have been answered on all topics. The other nodes do the same job as the tutorials teach it:
one in Python and, where rclcpp is installed, one in C++, with the default profile of the
middleware and with that of this node. All have default parameters. What the driver sends goes
straight to a listener as well: what a node adds to the median of that is its own. They take turns,
so that what else the machine does befalls all of them; values and ratios are medians over the
rounds.
"""

import argparse
import json
import math
import statistics
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

from compiled import NotBuiltError, rclcpp_node
from processes import (
    ANNOUNCING,
    NODE,
    PROFILE,
    Program,
    Surroundings,
    private_surroundings,
    program,
)

_OUTPUTS = ('output_state', 'body_poses')
_RATES = (500, 1000, 2000, 5000, 8000)  # Hz
_QUIET = 2.0  # s of silence after which nothing more is to come
_COMPLETE = (1000, 2000, 5000, 8000)  # Hz, at which every message is to be answered
_REFERENCE_RATE = 1000  # Hz, at which cost and latency have targets
_BOUNDS = (  # at that rate: the field, the other node, and the target for the ratio to it
    ('cpu', 'textbook', 0.30),
    ('cpu', 'C++', 1.0),
    ('cpu', 'C++ profile', 1.4),
    ('p50', 'textbook', 0.5),
    ('p99', 'textbook', 0.7),
)


class Run(NamedTuple):
    """One node at one rate. Times in s."""

    sent: int
    answered: int
    """Messages with an answer on each topic."""
    cpu: float
    """Time of the processor that the node takes for each answered message."""
    p50: float
    """Median of the time from sending a message to its last answer."""
    p99: float
    max: float
    start: float
    """From the start of the process to its first answer."""
    memory: int
    """Resident, bytes."""


class Round(NamedTuple):
    """What was measured in turns."""

    runs: dict[str, Run]
    """By node; the first one is this node."""
    empty_start: float
    """s, from the start of the process of an empty node to its first message."""
    direct: float
    """s, median of the time from the driver to a listener, without a node between them."""


class Target(NamedTuple):
    """What is to be reached."""

    what: str
    measured: float
    at_least: float = 0.0
    at_most: float = math.inf

    @property
    def met(self) -> bool:
        """Whether it is."""
        return self.at_least <= self.measured <= self.at_most

    def __str__(self) -> str:
        if self.at_least > 0.0:
            return f'{self.what}: {self.measured:.6g}, at least {self.at_least:g}'
        return f'{self.what}: {self.measured:.3g}, at most {self.at_most:g}'


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        '--outputs', nargs='+', default=_OUTPUTS, choices=_OUTPUTS, help='that are listened to'
    )
    parser.add_argument('--rates', type=int, nargs='+', default=_RATES, metavar='HZ')
    parser.add_argument('--seconds', type=float, default=5.0, help='of each node at each rate')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    rounds: dict[int, list[Round]] = {rate: [] for rate in options.rates}
    listener = _listener(*options.outputs)
    with private_surroundings() as surroundings:
        nodes = _nodes(surroundings)
        for _ in range(options.rounds):
            for rate in options.rates:
                runs = {
                    name: _run(command, listener, rate, options.seconds, around)
                    for name, (command, around) in nodes.items()
                }
                empty_start = _start_of_empty_node(surroundings)
                direct = _direct(rate, options.seconds, surroundings)
                rounds[rate].append(Round(runs, empty_start, direct))
    results = {rate: _summary(rounds[rate]) for rate in options.rates}
    start = _start([one for at_rate in rounds.values() for one in at_rate])
    targets = list(_targets(results, start))
    if options.json:
        judged = [{'what': t.what, 'measured': t.measured, 'met': t.met} for t in targets]
        print(json.dumps({'rates': results, 'start': start, 'targets': judged}, indent=2))
    else:
        _print(results, start, targets)


def _nodes(surroundings: Surroundings) -> dict[str, tuple[Sequence[str], Surroundings]]:
    """Give the command and the surroundings of each node; without rclcpp, say so."""
    nodes: dict[str, tuple[Sequence[str], Surroundings]] = {
        'node': (NODE, surroundings),
        'textbook': (program('textbook_node.py'), surroundings),
    }
    try:
        command = (str(rclcpp_node()),)
    except NotBuiltError as error:
        print(f'no C++ node: {error}', file=sys.stderr)
        return nodes
    return nodes | {
        'C++': (command, surroundings),
        'C++ profile': (command, surroundings.with_profile(PROFILE)),
    }


def _listener(*topics: str) -> tuple[str, ...]:
    """Give the command that runs a listener to topics."""
    arguments = '--ros-args', '-p', f'outputs:=[{",".join(topics)}]'
    return *program('state_listener.py'), *arguments


def _run(
    command: Sequence[str],
    listening: Sequence[str],
    rate: int,
    seconds: float,
    surroundings: Surroundings,
) -> Run:
    with (
        _peers(listening, surroundings) as (driver, listener),
        Program(command, surroundings) as node,
    ):
        start = (listener.report()['heard'] - node.started) / 1e9
        before = node.cpu_time()
        sent, answers = _drive(driver, listener, rate, seconds)
        cpu = (node.cpu_time() - before) / answers['answered']
        return Run(sent=sent, cpu=cpu, start=start, memory=node.memory(), **answers)


def _direct(rate: int, seconds: float, surroundings: Surroundings) -> float:
    """Median time from the driver to a listener, s."""
    with _peers(_listener('rotor_state'), surroundings) as (driver, listener):
        listener.report()
        _, answers = _drive(driver, listener, rate, seconds)
        return float(answers['p50'])


@contextmanager
def _peers(
    listening: Sequence[str], surroundings: Surroundings
) -> Iterator[tuple[Program, Program]]:
    """Run a driver and a listener, which are ready."""
    announcing = surroundings.with_profile(ANNOUNCING)
    with (
        Program(program('rotor_driver.py'), announcing) as driver,
        Program(listening, announcing) as listener,
    ):
        for peer in (driver, listener):
            peer.report()
        yield driver, listener


def _drive(
    driver: Program, listener: Program, rate: int, seconds: float
) -> tuple[int, dict[str, Any]]:
    """Have the driver drive; returns how many messages it sent, and the listener's report."""
    count = max(1, round(rate * seconds))
    listener.tell(count=count, quiet=_QUIET)
    listener.report()
    driver.tell(rate=rate, count=count, allowed=count, counted=False)
    return driver.report()['sent'], listener.report()


def _start_of_empty_node(surroundings: Surroundings) -> float:
    with Program(program('rotor_driver.py'), surroundings.with_profile(ANNOUNCING)) as driver:
        driver.report()
        with Program(program('empty_node.py'), surroundings) as node:
            return (node.report()['heard'] - node.started) / 1e9


def _summary(rounds: Sequence[Round]) -> dict[str, dict[str, Any]]:
    """Medians by field, for each node and for the ratios to the others; what was delivered."""
    summary: dict[str, dict[str, Any]] = {}
    this, *others = rounds[0].runs
    for name in (this, *others):
        runs = [one.runs[name] for one in rounds]
        summary[name] = {
            field: statistics.median(getattr(run, field) for run in runs)
            for field in Run._fields[2:]
        }
        summary[name]['added'] = statistics.median(
            one.runs[name].p50 - one.direct for one in rounds
        )
        summary[name]['delivered'] = sum(r.answered for r in runs) / sum(r.sent for r in runs)
    summary['ratio'] = {
        other: {
            field: statistics.median(
                getattr(one.runs[this], field) / getattr(one.runs[other], field) for one in rounds
            )
            for field in Run._fields[2:]
        }
        | {'added': summary[this]['added'] / summary[other]['added']}
        for other in others
    }
    return summary


def _start(rounds: Sequence[Round]) -> dict[str, float]:
    starts = {
        name: statistics.median(one.runs[name].start for one in rounds) for name in rounds[0].runs
    }
    return starts | {
        'empty': statistics.median(one.empty_start for one in rounds),
        'ratio': statistics.median(one.runs['node'].start / one.empty_start for one in rounds),
    }


def _targets(results: dict[int, dict[str, Any]], start: dict[str, float]) -> Iterator[Target]:
    if _REFERENCE_RATE in results:
        ratio = results[_REFERENCE_RATE]['ratio']
        for field, other, bound in _BOUNDS:
            if other in ratio:
                what = f'{field} at {_REFERENCE_RATE} Hz, x {other}'
                yield Target(what, ratio[other][field], at_most=bound)
    for rate in _COMPLETE:
        if rate in results:
            delivered = results[rate]['node']['delivered']
            yield Target(f'delivered at {rate} Hz', delivered, at_least=1.0)
    yield Target('start-up, x empty node', start['ratio'], at_most=1.5)


def _print(
    results: dict[int, dict[str, Any]], start: dict[str, float], targets: Sequence[Target]
) -> None:
    others = [*next(iter(results.values()))['ratio']]
    print(f'{"":20}{"node":>10}' + ''.join(f'{name:>14}{"ratio":>8}' for name in others))
    for rate, result in results.items():
        for field, factor, unit in (
            ('cpu', 1e6, 'µs'),
            ('p50', 1e6, 'µs'),
            ('added', 1e6, 'µs'),
            ('p99', 1e6, 'µs'),
            ('max', 1e6, 'µs'),
            ('delivered', 100.0, '%'),
            ('memory', 1e-6, 'MB'),
        ):
            line = f'{rate:5} Hz {field:9} {unit:2}{factor * result["node"][field]:10.6g}'
            for name in others:
                ratio = result['ratio'][name].get(field)
                line += f'{factor * result[name][field]:14.6g}'
                line += f'{ratio:8.2f}' if ratio is not None else f'{"":8}'
            print(line)
    print('start-up: ', ', '.join(f'{name} {value:.3g}' for name, value in start.items()))
    for target in targets:
        print(f'{"met" if target.met else "NOT MET":8}{target}')


if __name__ == '__main__':
    main()
