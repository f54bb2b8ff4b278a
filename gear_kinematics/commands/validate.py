"""`gearkin validate`: compare recorded outputs with outputs recomputed from the rotor topic."""

import argparse
from collections.abc import Iterator, Sequence

from gear_kinematics.bag.finding import find_bags
from gear_kinematics.commands import ExitCode, arguments, calibrations
from gear_kinematics.commands.output import (
    Reporter,
    complain,
    message_progress,
    progress,
    warn_of_shared_memory,
)
from gear_kinematics.kinematics import gear_from_mapping
from gear_kinematics.report.document import Verdict
from gear_kinematics.state import parameters
from gear_kinematics.validation.document import document
from gear_kinematics.validation.fleet import (
    Task,
    validate_bag,
    validate_on_cluster,
    validate_on_this_machine,
)
from gear_kinematics.validation.output_topics import Tolerances
from gear_kinematics.validation.report import BagReport

HELP = 'compare recorded outputs with recomputed ones'
_EXIT_CODES = {
    Verdict.PASS: ExitCode.DONE,
    Verdict.FAIL: ExitCode.FAILED,
    Verdict.UNUSABLE: ExitCode.UNUSABLE,
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_config(parser)
    arguments.add_topics(parser)
    calibrations.add_option(parser)
    parser.add_argument('bags', nargs='+', metavar='BAG', help='file, directory or glob')
    angle, position = Tolerances()
    parser.add_argument('--tolerance-angle', type=float, default=angle, metavar='RAD')
    parser.add_argument('--tolerance-position', type=float, default=position, metavar='M')
    parser.add_argument(
        '--allow-offset', action='store_true', help='accept a constant offset, as after homing'
    )
    parser.add_argument(
        '--strict',
        action='store_true',
        help='judge all messages, even where the recorder may have lost some',
    )
    way = parser.add_mutually_exclusive_group()
    way.add_argument(
        '--live', action='store_true', help='validate the outputs of a live node instead'
    )
    arguments.add_fleet(way)
    arguments.add_report_forms(parser, junit=True)


def run(options: argparse.Namespace) -> ExitCode:
    """Validate every bag; the worst verdict gives the exit code."""
    tolerances = Tolerances(options.tolerance_angle, options.tolerance_position)
    if not (tolerances.angle >= 0.0 and tolerances.position >= 0.0):
        raise ValueError('a tolerance must not be negative')
    bags = find_bags(options.bags)
    reporter = Reporter(options, len(bags))
    tasks = []
    for bag in bags:
        config = arguments.config_path(options, bag)
        loaded = parameters.load(config, options.node)
        gear_from_mapping(loaded)  # raises its errors here, not in the report on the bag
        tasks.append(
            Task(
                bag,
                loaded,
                str(config),
                tolerances,
                options.allow_offset,
                options.strict,
                options.rotor_topic,
                options.output_topic,
                options.poses_topic,
                calibrations.load(options, loaded, bag),
                str(calibrations.find(options, loaded, bag) or ''),
                options.debug,
            )
        )
    if options.live:
        warn_of_shared_memory(participants=2)
    order = {str(task.bag): number for number, task in enumerate(tasks)}
    reports = sorted(_reports(options, tasks), key=lambda report: order[report.bag])
    for report in reports:
        if report.error:
            complain(report.error)
    reporter.write(document(reports))
    return max(_EXIT_CODES[report.verdict] for report in reports)


def _reports(options: argparse.Namespace, tasks: Sequence[Task]) -> Iterator[BagReport]:
    if options.scheduler or options.jobs > 1:
        reports = (
            validate_on_cluster(tasks, options.scheduler)
            if options.scheduler
            else validate_on_this_machine(tasks, options.jobs)
        )
        with progress('bags') as bars:
            yield from bars.track(reports, total=len(tasks), description='bags')
        return
    play = None
    if options.live:  # needs ROS, unlike the validation of a recording
        from gear_kinematics.ros.live import live_messages  # noqa: PLC0415

        play = live_messages
    for task in tasks:
        with message_progress(task.bag.name) as report_progress:
            yield validate_bag(task, report_progress, play)
