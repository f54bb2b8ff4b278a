"""The program `gearkin`: arguments, printing and exit codes; no mathematics."""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from gear_kinematics import parameters
from gear_kinematics.description import urdf
from gear_kinematics.kinematics import Mechanism, loop_closure, vernier

_DONE, _FAILED, _UNUSABLE = 0, 1, 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; returns the exit code: 0 done, 1 a check failed, 2 unusable input."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except (ValueError, OSError, RuntimeError) as error:
        print(f'gearkin: {error}', file=sys.stderr)
        return _UNUSABLE
    except KeyboardInterrupt:
        return _FAILED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='gearkin', description=__doc__)
    commands = parser.add_subparsers(title='commands', required=True, metavar='COMMAND')
    config = argparse.ArgumentParser(add_help=False)
    config.add_argument(
        '--config',
        type=Path,
        metavar='FILE',
        help='parameters of the node as YAML (default: config/actuator.yaml)',
    )

    demo = commands.add_parser('demo', help='the shipped bag through the live node, validated')
    demo.set_defaults(run=_demo)

    describe = commands.add_parser(
        'describe', parents=[config], help='what a tooth pair implies: ratio, mobility, vernier'
    )
    describe.add_argument('--ring-teeth', type=int, metavar='ZK')
    describe.add_argument('--satellite-teeth', type=int, metavar='ZS')
    describe.add_argument('--eccentricity', type=float, metavar='M')
    describe.add_argument('--json', action='store_true', help='for programs')
    describe.set_defaults(run=_describe)

    urdf_command = commands.add_parser('urdf', parents=[config], help='the URDF on stdout')
    urdf_command.set_defaults(run=_urdf)
    return parser


def _load(options: argparse.Namespace) -> dict[str, Any]:
    return parameters.load(options.config or parameters.default_config())


def _demo(_options: argparse.Namespace) -> int:
    # Needs ROS, which the other commands do without.
    from gear_kinematics import demo  # noqa: PLC0415

    return _DONE if demo.run(Console()).passed else _FAILED


def _urdf(options: argparse.Namespace) -> int:
    config = _load(options)
    names = {name: config[name] for name in ('module', 'output_joint', 'frame_prefix')}
    print(urdf(Mechanism.from_mapping(config), **names), end='')
    return _DONE


def _describe(options: argparse.Namespace) -> int:
    config = _load(options)
    for name in ('ring_teeth', 'satellite_teeth', 'eccentricity'):
        if (given := getattr(options, name)) is not None:
            config[name] = given
    facts = _facts(Mechanism.from_mapping(config))
    if options.json:
        print(json.dumps({name: value for name, value, _ in facts}, indent=2))
        return _DONE
    table = Table('', 'value', 'unit', box=None, show_header=False)
    for name, value, unit in facts:
        table.add_row(name.replace('_', ' '), str(value), unit)
    Console().print(table)
    return _DONE


def _facts(mechanism: Mechanism) -> list[tuple[str, Any, str]]:
    """Name, value and unit of what follows from the mechanism alone."""
    zk = mechanism.ring_teeth
    return [
        ('ring_teeth', zk, ''),
        ('satellite_teeth', mechanism.satellite_teeth, ''),
        ('eccentricity', mechanism.eccentricity, 'm'),
        ('branches', [branch.name for branch in mechanism.branches], ''),
        ('gear_ratio', str(mechanism.gear_ratio), ''),
        ('mobility_by_counting', loop_closure.mobility_by_counting(mechanism), ''),
        ('mobility_by_rank', loop_closure.mobility_by_rank(mechanism), ''),
        ('redundant_constraints', loop_closure.redundant_constraints(mechanism), ''),
        ('ring_rolling_radius', mechanism.ring_rolling_radius, 'm'),
        ('satellite_rolling_radius', mechanism.satellite_rolling_radius, 'm'),
        ('oldham_petals', mechanism.oldham_petals, ''),
        ('vernier_combinations', vernier.combinations(zk), ''),
        ('vernier_distinct_positions', vernier.distinct_positions(zk), ''),
        ('vernier_ring_body_positions', vernier.ring_body_positions(zk), ''),
        ('vernier_step', vernier.step(zk), 'rad'),
    ]
