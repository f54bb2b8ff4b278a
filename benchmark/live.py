"""What the live node costs and how soon it answers, against a textbook rclpy node, in one run.

    python benchmark/live.py [--rates 500 1000 ...] [--seconds 5] [--rounds 5] [--json]

Driver, node and listener are three processes on this machine. The driver sends rotor_state
reliably at a steady rate, the listener takes output_state and body_poses, and the queues of both
hold more than ever waits, so that every loss is the node's. Counting starts when probes have been
answered on both topics. The nodes have their default parameters. They take turns, so that what
else the machine does befalls all of them; values and ratios are medians over the rounds.
"""

import argparse
import json
import math
import statistics
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import Any, NamedTuple

from processes import NODE, Program, Surroundings, private_surroundings, program

_RATES = (500, 1000, 2000, 5000, 8000)  # Hz
_QUIET = 2.0  # s of silence after which nothing more is to come
_REFERENCE_RATE = 1000  # Hz, at which cost and latency have targets


class Run(NamedTuple):
    """One node at one rate. Times in s."""

    sent: int
    answered: int
    """Messages with an answer on both topics."""
    cpu: float
    """Of the node, for each answered message."""
    p50: float
    """Of the time from sending a message to its last answer."""
    p99: float
    max: float
    start: float
    """From the start of the process to its first answer."""
    memory: int
    """Resident, bytes."""


class Round(NamedTuple):
    """What was measured in turns."""

    node: Run
    textbook: Run
    empty_start: float
    """s, from the start of the process of an empty node to its first message."""


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
    parser.add_argument('--rates', type=int, nargs='+', default=_RATES, metavar='HZ')
    parser.add_argument('--seconds', type=float, default=5.0, help='of each node at each rate')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    rounds: dict[int, list[Round]] = {rate: [] for rate in options.rates}
    with private_surroundings() as surroundings:
        for _ in range(options.rounds):
            for rate in options.rates:
                rounds[rate].append(_round(rate, options.seconds, surroundings))
    results = {rate: _summary(rounds[rate]) for rate in options.rates}
    start = _start([one for at_rate in rounds.values() for one in at_rate])
    targets = list(_targets(results, start))
    if options.json:
        judged = [{'what': t.what, 'measured': t.measured, 'met': t.met} for t in targets]
        print(json.dumps({'rates': results, 'start': start, 'targets': judged}, indent=2))
    else:
        _print(results, start, targets)


def _round(rate: int, seconds: float, surroundings: Surroundings) -> Round:
    return Round(
        _run(NODE, rate, seconds, surroundings),
        _run(program('textbook_node.py'), rate, seconds, surroundings),
        _start_of_empty_node(surroundings),
    )


def _run(command: Sequence[str], rate: int, seconds: float, surroundings: Surroundings) -> Run:
    count = max(1, round(rate * seconds))
    with ExitStack() as programs:
        driver, listener = (
            programs.enter_context(Program(program(name), surroundings))
            for name in ('rotor_driver.py', 'state_listener.py')
        )
        for peer in (driver, listener):
            peer.report()
        node = programs.enter_context(Program(command, surroundings))
        start = (listener.report()['heard'] - node.started) / 1e9
        listener.tell(count=count, quiet=_QUIET)
        listener.report()
        before = node.cpu_time()
        driver.tell(rate=rate, count=count, allowed=count, counted=False)
        sent, answers = driver.report()['sent'], listener.report()
        cpu = (node.cpu_time() - before) / answers['answered']
        return Run(sent=sent, cpu=cpu, start=start, memory=node.memory(), **answers)


def _start_of_empty_node(surroundings: Surroundings) -> float:
    with Program(program('rotor_driver.py'), surroundings) as driver:
        driver.report()
        with Program(program('empty_node.py'), surroundings) as node:
            return (node.report()['heard'] - node.started) / 1e9


def _summary(rounds: Sequence[Round]) -> dict[str, dict[str, float]]:
    """Medians by field, for both nodes and for their ratio; what was delivered, in all."""
    nodes, textbooks, _ = zip(*rounds, strict=True)
    summary = {}
    for name, runs in (('node', nodes), ('textbook', textbooks)):
        delivered = sum(run.answered for run in runs) / sum(run.sent for run in runs)
        summary[name] = {field: _median(runs, field) for field in Run._fields[2:]}
        summary[name]['delivered'] = delivered
    summary['ratio'] = {
        field: statistics.median(
            getattr(node, field) / getattr(textbook, field) for node, textbook, _ in rounds
        )
        for field in Run._fields[2:]
    }
    return summary


def _median(runs: Sequence[Run], field: str) -> float:
    return statistics.median(getattr(run, field) for run in runs)


def _start(rounds: Sequence[Round]) -> dict[str, float]:
    return {
        'node': statistics.median(one.node.start for one in rounds),
        'textbook': statistics.median(one.textbook.start for one in rounds),
        'empty': statistics.median(one.empty_start for one in rounds),
        'ratio': statistics.median(one.node.start / one.empty_start for one in rounds),
    }


def _targets(results: dict[int, dict[str, Any]], start: dict[str, float]) -> Iterator[Target]:
    if _REFERENCE_RATE in results:
        ratio = results[_REFERENCE_RATE]['ratio']
        for field, bound in (('cpu', 0.33), ('p50', 0.65), ('p99', 0.7)):
            what = f'{field} at {_REFERENCE_RATE} Hz, x textbook'
            yield Target(what, ratio[field], at_most=bound)
    for rate, bound in ((1000, 1.0), (2000, 1.0), (5000, 1.0), (8000, 0.999)):
        if rate in results:
            delivered = results[rate]['node']['delivered']
            yield Target(f'delivered at {rate} Hz', delivered, at_least=bound)
    yield Target('start-up, x empty node', start['ratio'], at_most=1.5)


def _print(
    results: dict[int, dict[str, Any]], start: dict[str, float], targets: Sequence[Target]
) -> None:
    print(f'{"":20}{"node":>10}{"textbook":>10}{"ratio":>8}')
    for rate, result in results.items():
        node, textbook, ratio = (result[name] for name in ('node', 'textbook', 'ratio'))
        for field, factor, unit in (
            ('cpu', 1e6, 'µs'),
            ('p50', 1e6, 'µs'),
            ('p99', 1e6, 'µs'),
            ('max', 1e6, 'µs'),
            ('delivered', 100.0, '%'),
            ('memory', 1e-6, 'MB'),
        ):
            line = f'{rate:5} Hz {field:9} {unit:2}{factor * node[field]:10.6g}'
            line += f'{factor * textbook[field]:10.6g}'
            print(line + (f'{ratio[field]:8.2f}' if field in ratio else ''))
    print('start-up: ', ', '.join(f'{name} {value:.3g}' for name, value in start.items()))
    for target in targets:
        print(f'{"met" if target.met else "NOT MET":8}{target}')


if __name__ == '__main__':
    main()
