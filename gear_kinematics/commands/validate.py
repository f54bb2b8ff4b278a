# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin validate`: compare recorded outputs with outputs recomputed from the rotor topic."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from gear_kinematics.bag.finding import find_bags
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import announce_ros, complain
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.parameters import NODE
from gear_kinematics.validation.document import document
from gear_kinematics.validation.report import BagReport, unusable
from gear_kinematics.validation.task import QUANTITIES, Task, Tolerances
from gear_kinematics.validation.validate_bag import WORK, of_arm, validate_bag


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', nargs='+', metavar='BAG', help='file, directory or glob')
    bags.add_rotor(parser)
    bags.add_encoder(parser)
    bags.add_outputs(parser)
    arguments.add_config(
        parser,
        chosen='node to select in a file for several nodes and, with its namespace, in a '
        f'recording of several, such as /left/{NODE} (default: %(default)s)',
        actuator=arguments.ALL,
    )
    arguments.add_ratio(parser)
    bags.add_calibration(parser)
    limits = arguments.group(parser, 'limits')
    for unit, quantity in QUANTITIES.items():
        limits.add_argument(
            f'--tolerance-{quantity}',
            type=arguments.between(0.0, 1e6),
            default=Tolerances().of(unit),
            metavar=unit.upper().replace('·M', '·m'),
            help=f'greatest accepted error of each {quantity} (default: %(default)g)',
        )
    text = (
        'judge all messages, even where the recorder may have lost some, and fail a node '
        'that was homed'
    )
    limits.add_argument('--strict', action='store_true', help=text)
    text = 'compare with the matrix method as well, by code that the node does not run'
    limits.add_argument('--independent', action='store_true', help=text)
    sources = arguments.group(parser, 'several recordings').add_mutually_exclusive_group()
    text = 'play the recorded inputs to a live node, and validate its outputs instead'
    sources.add_argument('--live', action='store_true', help=text)
    bags.add_jobs(sources)
    add_report_forms(parser, junit=True)
    arguments.add_verbose(parser, 'print all counts and errors, not only findings')


def run(options: argparse.Namespace) -> ExitCode:
    tolerances = Tolerances(
        **{name: getattr(options, f'tolerance_{name}') for name in Tolerances._fields}
    )
    found = find_bags(options.bags)
    faults = dict(found.faults)
    reporter = Reporter(options, len(found.bags) + len(faults))
    tasks: list[Task] = []
    for bag in found.bags:
        try:
            tasks.append(_task(bag, tolerances, options))
        except (ValueError, OSError) as error:  # from files in its folder, or from options
            faults[bag] = str(error)
    if not tasks:
        complain('; '.join(dict.fromkeys(faults.values())))
    for task in tasks:
        arguments.check_of_one(options, [t.parameters.actuator for t in task.actuators], 'plot')
    if options.live and tasks:
        announce_ros(participants=2)
    judged = {path: unusable(path, fault) for path, fault in faults.items()}
    judged |= _validated(options, tasks)
    reports = [judged[path] for path in (*found.bags, *found.faults)]
    for report in reports if tasks else ():
        if report.error:
            complain(
                report.error if report.bag in report.error else f'{report.bag}: {report.error}'
            )
    configs = (Path(task.config) for task in tasks)
    return reporter.write(document(reports), configs, printed=bool(tasks))


def _task(bag: Path, tolerances: Tolerances, options: argparse.Namespace) -> Task:
    configs, node = arguments.load_configs(options, bag), options.node
    arguments.check_of_one(options, configs, 'calibration', 'poses_topic', 'live')
    if options.live:  # by a node of this gear alone
        (config,) = configs.values()
        configs = {'': replace(config, actuator='', actuators=())}
    tasks = [
        Task(
            bag,
            replace(config, calibration=str(bags.calibration_path(options, config, bag) or '')),
            config=str(arguments.config_path(options, bag)),
            tolerances=tolerances,
            strict=options.strict,
            independent=options.independent,
            only_joint=options.joint is None,
            rotor_topic=options.rotor_topic,
            output_topic=options.output_topic,
            poses_topic=options.poses_topic,
            encoder_topic=options.encoder_topic,
            namespace=f'/{node.strip("/")}'.rpartition('/')[0] if '/' in node else None,
            calibration=bags.load_calibration(options, config, bag),
            debug=options.debug,
        )
        for config in configs.values()
    ]
    return of_arm(tasks)


def _validated(options: argparse.Namespace, tasks: Sequence[Task]) -> dict[Path, BagReport]:
    work = WORK
    if options.live:  # needs ROS, unlike the validation of a recording
        from gear_kinematics.ros.live import live_messages  # noqa: PLC0415

        work = replace(work, run=partial(validate_bag, play=live_messages))
    reports = bags.results(options, work, tasks, 'bags')
    return {bag: replace(report, bag=str(bag)) for (bag, _), report in reports.items()}  # as given
