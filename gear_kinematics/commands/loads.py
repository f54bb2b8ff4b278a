# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin loads`: whether the preload held over recordings, and what every joint carried."""

import argparse
from importlib import import_module
from pathlib import Path

from gear_kinematics.bag.finding import find_bags
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.measurement.loads.analysis import (
    WORK,
    LoadHistory,
    Outcome,
    Task,
    compute_loads,
)
from gear_kinematics.measurement.loads.document import document
from gear_kinematics.report.document import Verdict


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('bags', nargs='+', metavar='RECORDING', help='file, directory or glob')
    bags.add_rotor(parser)
    arguments.add_config(parser)
    gear = arguments.group(parser, 'gear')
    gear.add_argument(
        '--cam-rating',
        type=arguments.positive,
        metavar='N',
        help="basic dynamic load rating C of a cam's ball bearing, for its L10 life",
    )
    gear.add_argument(
        '--slot-friction',
        type=arguments.positive,
        metavar='MU',
        help='coefficient of friction of the slots, for an estimate of their loss',
    )
    bags.add_jobs(arguments.group(parser, 'several recordings'))
    add_report_forms(parser)
    arguments.add_verbose(parser, 'print tables and remarks in a pipe, too')


def run(options: argparse.Namespace) -> ExitCode:
    """Compute the loads of every recording; the exit code is 1 if a branch was out of mesh."""
    import_module('rainflow')  # before hours of work
    found = find_bags(options.bags)
    for fault in found.faults.values():
        complain(fault)
    failed = bool(found.faults)
    reporter = Reporter(options, len(found.bags), brief=not options.verbose)
    tasks: list[Task] = []
    for bag in found.bags:
        try:
            tasks.append(
                Task(
                    bag,
                    arguments.load_config(options, bag),
                    options.rotor_topic,
                    options.joint is None,
                    options.slot_friction,
                    options.debug,
                )
            )
        except (ValueError, OSError) as error:
            complain(error)
            failed = True

    def compute(task: Task) -> Outcome:
        with message_progress(task.path.name, quiet=options.quiet) as report_progress:
            return compute_loads(task, report_progress)

    histories: dict[Path, LoadHistory] = {}
    for task, outcome in bags.results(options, WORK, tasks, 'recordings', compute):
        if outcome.error:
            complain(outcome.error)
            failed = True
        if outcome.history:
            histories[task.path] = outcome.history
    if not histories:
        return ExitCode.UNUSABLE
    ordered = [histories[bag] for bag in found.bags if bag in histories]
    report = document(ordered, options.cam_rating)
    reporter.write(report, (arguments.config_path(options, bag) for bag in histories))
    if failed:
        return ExitCode.UNUSABLE
    return ExitCode.FAILED if report.verdict == Verdict.FAIL else ExitCode.DONE
