"""`gearkin describe`: what follows from the mechanism and the module of its teeth."""

import argparse
import json
from typing import Any

from rich.console import Console
from rich.table import Table

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.arguments import add_mechanism, add_sizes, mechanism, module
from gear_kinematics.kinematics import Mechanism, loop_closure, vernier
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair

Fact = tuple[str, Any, str]
"""Name, value (None: there is none) and unit."""
HELP = 'what a tooth pair implies: ratio, mobility, vernier, interference of the teeth'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say which arguments the command takes."""
    add_mechanism(parser)
    add_sizes(parser)
    parser.add_argument('--json', action='store_true', help='for programs')


def run(options: argparse.Namespace) -> ExitCode:
    """Print the facts."""
    described = mechanism(options)
    facts = [*_facts(described), *_tooth_facts(described, module(options))]
    if options.json:
        print(json.dumps({name: value for name, value, _ in facts}, indent=2))
        return ExitCode.DONE
    table = Table('', 'value', 'unit', box=None, show_header=False)
    for name, value, unit in facts:
        if value is None:
            continue
        table.add_row(name.replace('_', ' '), str(value), unit)
    Console().print(table)
    return ExitCode.DONE


def _facts(mechanism: Mechanism) -> list[Fact]:
    """What follows from the mechanism alone."""
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


def _tooth_facts(mechanism: Mechanism, module: float) -> list[Fact]:
    """What follows for involute teeth of a module."""
    try:
        pair, interference = tooth_pair(mechanism, module), None
    except InterferenceError as error:
        pair, interference = None, str(error)
    return [
        ('module', module, 'm'),
        ('working_pressure_angle', pair and pair.working_pressure_angle, 'rad'),
        ('ring_profile_shift', pair and pair.ring_profile_shift, 'modules'),
        ('addendum', pair and pair.addendum, 'modules'),
        ('satellite_tip_radius', pair and pair.satellite_tip_radius, 'm'),
        ('ring_tip_radius', pair and pair.ring_tip_radius, 'm'),
        ('tip_clearance', pair and pair.tip_clearance, 'rad'),
        ('contact_ratio', pair and pair.contact_ratio, ''),
        ('interference', interference, ''),
    ]
