# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin loads`: a check that the preload held in recordings, and the loads of every joint."""

import argparse
import math
import sys
from importlib import import_module
from pathlib import Path

from gear_kinematics.bag.finding import find_bags
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import add_columns, sources
from gear_kinematics.commands.output import complain
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.measurement.formats import is_table
from gear_kinematics.measurement.loads.document import WORK, document
from gear_kinematics.measurement.loads.recorded import LoadTask
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.report.document import printable
from gear_kinematics.wire.nearest import listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', nargs='+', metavar='RECORDING', help='file, directory or glob')
    bags.add_rotor(parser)
    arguments.add_config(parser, actuator=arguments.ALL)
    add_columns(parser, 'rotor', 'output', 'angle', 'torque')
    gear = arguments.group(parser, 'gear')
    for name, unit, bounds, text in (
        ('cam-rating', 'N', (1.0, 1e8), "dynamic load rating C of a cam's bearing; adds its life"),
        ('slot-friction', 'MU', (1e-4, 1.0), 'friction coefficient of the slots; adds their loss'),
    ):
        number = arguments.between(*bounds)
        gear.add_argument(f'--{name}', type=number, default=math.nan, metavar=unit, help=text)
    way = arguments.group(parser, 'several recordings').add_mutually_exclusive_group()
    bags.add_jobs(way)
    add_report_forms(parser)
    arguments.add_verbose(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Report the loads of every recording; the exit code is 1 if a branch was out of mesh."""
    import_module('rainflow')  # before hours of work
    found = find_bags(options.bags)
    reporter = Reporter(options, len(found.bags))
    tasks = [
        LoadTask(
            bag,
            config,
            options.rotor_topic,
            options.joint is None and not config.actuator,
            options.cam_rating,
            options.slot_friction,
            by_default=arguments.config_path(options, bag) == default_config(),
            sources=sources(options),
            debug=options.debug,
        )
        for bag in found.bags
        for config in _configs(options, bag)
    ]
    arguments.check_of_one(options, {task.parameters.actuator for task in tasks}, 'plot')
    results = bags.results(options, WORK, tasks, 'recordings')
    reports = [results[bags.key(task)] for task in tasks]
    faults = [*found.faults.values(), *(report.error for report in reports if report.error)]
    for fault in dict.fromkeys(faults):  # one of all actuators is said once
        complain(fault)
    for table in filter(None, (report.taken for report in reports)):
        print(printable(table), file=sys.stderr)
    code, joined = ExitCode.DONE, document(reports)
    if joined.sections:
        code = reporter.write(joined, (arguments.config_path(options, task.bag) for task in tasks))
    return ExitCode.UNUSABLE if faults else code


def _configs(options: argparse.Namespace, bag: Path) -> list[NodeParameters]:
    """Return the parameters of actuators with known bodies; name others of an arm on stderr."""
    if is_table(bag):
        return [arguments.load_config(options, bag)]
    configs = [*arguments.load_configs(options, bag).values()]
    known = [config for config in configs if not config.gear_ratio]
    if known and (others := [each.actuator for each in configs if each.gear_ratio]):
        complain(f'{bag}: no loads of {listed(others)}, for which only the ratio is known')
    return known or configs[:1]
