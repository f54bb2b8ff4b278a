# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What one node for an arm costs, against a node for each gear and a textbook node, in one run.

    python benchmark/arm.py [--joints 7] [--rate 1000] [--seconds 5] [--rounds 5] [--poses]
                            [--kinds arm gears 'one gear' textbook echo]
                            [--baseline FOLDER] [--json]

A driver sends all joints in one message at a steady rate, and a listener takes output_state, with
--poses body_poses of each gear as well. The arm is one gear_state_publisher with `actuators`; the
gears are one gear_state_publisher each; one more gear_state_publisher alone gives the latency to
compare with; the textbook node does the job of the arm in rclpy; the echo is a node that publishes
the bytes that it takes, which costs what no node can save. With --baseline, the gears and
the one gear are nodes of the checkout of another version. All take turns, so that what else the
machine does befalls all of them. CPU time is that of all nodes together for each message of the
driver, and memory is PSS, in which a page that processes share counts once. Values and ratios
are medians over the rounds.
"""

import argparse
import json
import statistics
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from processes import ANNOUNCING, NODE, Program, Surroundings, private_surroundings, program

_QUIET = 2.0  # s of silence after which nothing more is to come
_BOUNDS = (  # the field, the other nodes, the target for the ratio to them, and that with --poses
    ('cpu', 'gears', 0.15, 0.3),
    ('memory', 'gears', 0.2, 0.2),
    ('p99', 'one gear', 1.0, None),
)


class Run(NamedTuple):
    """The nodes of one kind. Times in s."""

    delivered: float
    """Share of the driver's messages with an answer on each topic."""
    cpu: float
    """Time of the processor that all nodes take for each message."""
    p50: float
    """Median of the time from sending a message to its last answer."""
    p99: float
    memory: int
    """PSS of all nodes, bytes."""


class Kind(NamedTuple):
    """Nodes that are measured: their commands with arguments, and the topics they are heard on."""

    nodes: list[tuple[tuple[str, ...], list[str]]]
    topics: list[str]
    folder: Path | None = None
    """The checkout whose nodes these are, if it is not this one."""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--joints', type=int, default=7)
    parser.add_argument('--rate', type=int, default=1000, metavar='HZ')
    parser.add_argument('--seconds', type=float, default=5.0, help='of each kind of node')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--kinds', nargs='+', metavar='KIND', help='those to measure')
    parser.add_argument('--poses', action='store_true', help='listen to body_poses, too')
    parser.add_argument('--baseline', type=Path, metavar='FOLDER', help='of another version')
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    with private_surroundings() as surroundings:
        kinds = _kinds(surroundings, options)
        chosen = {name: kinds[name] for name in options.kinds or kinds}
        rounds = [
            {name: _run(kind, options, surroundings) for name, kind in chosen.items()}
            for _ in range(options.rounds)
        ]
    summary = _summary(rounds)
    if options.json:
        print(json.dumps(summary, indent=2))
        return
    for name, values in summary['kinds'].items():
        print(
            f'{name:10} cpu {1e6 * values["cpu"]:7.1f} µs  p50 {1e6 * values["p50"]:8.1f} µs  '
            f'p99 {1e6 * values["p99"]:9.1f} µs  memory {1e-6 * values["memory"]:6.1f} MB  '
            f'delivered {100 * values["delivered"]:.4g} %'
        )
    for field, other, *bounds in _BOUNDS:
        if (bound := bounds[options.poses]) is not None and other in summary['ratios']:
            ratio = summary['ratios'][other][field]
            met = 'met' if ratio <= bound else 'NOT MET'
            print(f'{met:8}{field}, x {other}: {ratio:.3g}, at most {bound:g}')
    for other in {'textbook', 'echo'} & summary['ratios'].keys():
        print(f'        cpu, x {other}: {summary["ratios"][other]["cpu"]:.3g}')


def _kinds(surroundings: Surroundings, options: argparse.Namespace) -> dict[str, Kind]:
    """Give what is measured; the first is the arm."""
    names, poses = [f'j{number}' for number in range(options.joints)], options.poses
    namespace = surroundings.arguments[-1].removeprefix('__ns:=')
    actuators = ['-p', f'actuators:=[{",".join(names)}]']
    of_arm = ['output_state', *(f'{name}/body_poses' for name in names if poses)]
    outputs = 'output_state', *(('body_poses',) if poses else ())
    gears = [
        (NODE, [
            *('-r', f'__ns:={namespace}/{name}', '-r', f'rotor_state:={namespace}/rotor_state'),
            *('-p', f'rotor_joint:={name}'),
        ])
        for name in names
    ]  # fmt: skip
    of_gears = [f'{name}/{topic}' for name in names for topic in outputs]
    return {
        'arm': Kind([(NODE, actuators)], of_arm),
        'gears': Kind(gears, of_gears, options.baseline),
        'one gear': Kind(gears[:1], of_gears[: len(outputs)], options.baseline),
        'textbook': Kind([(program('textbook_arm.py'), actuators)], of_arm),
        'echo': Kind([(program('echo_node.py'), [])], of_arm[:1]),
    }


def _run(kind: Kind, options: argparse.Namespace, surroundings: Surroundings) -> Run:
    announcing = surroundings.with_profile(ANNOUNCING)
    names = ','.join(f'j{number}' for number in range(options.joints))

    def given(around: Surroundings, arguments: list[str]) -> Surroundings:
        first, *rest = around.arguments  # of two rules for a name, the first one counts
        return around._replace(arguments=[first, *arguments, *rest])

    with ExitStack() as stack:
        start = stack.enter_context
        driver = start(
            Program(program('rotor_driver.py'), given(announcing, ['-p', f'joints:=[{names}]']))
        )
        heard = given(announcing, ['-p', f'outputs:=[{",".join(kind.topics)}]'])
        listener = start(Program(program('state_listener.py'), heard))
        for peer in (driver, listener):
            peer.report()
        nodes = [
            start(Program(command, given(surroundings, arguments), kind.folder))
            for command, arguments in kind.nodes
        ]
        listener.report()
        before = sum(node.cpu_time() for node in nodes)
        count = max(1, round(options.rate * options.seconds))
        listener.tell(count=count, quiet=_QUIET)
        listener.report()
        driver.tell(rate=options.rate, count=count, allowed=count, counted=False)
        driver.report()
        answers = listener.report()
        cpu = (sum(node.cpu_time() for node in nodes) - before) / count
        memory = sum(node.own_memory() for node in nodes)
        return Run(answers['answered'] / count, cpu, answers['p50'], answers['p99'], memory)


def _summary(rounds: list[dict[str, Run]]) -> dict[str, dict[str, dict[str, Any]]]:
    """Medians by field: of each kind, and of the ratios of the arm to the others."""
    this, *others = rounds[0]

    def medians(ratio_to: str, name: str) -> dict[str, float]:
        return {
            field: statistics.median(
                getattr(one[name], field) / (getattr(one[ratio_to], field) if ratio_to else 1)
                for one in rounds
            )
            for field in Run._fields
        }

    return {
        'kinds': {name: medians('', name) for name in rounds[0]},
        'ratios': {other: medians(other, this) for other in others},
    }


if __name__ == '__main__':
    main()
