"""`gearkin lost-motion`: hysteresis, stiffness, play and transmission error from recordings."""

import argparse
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import Reporter, complain, message_progress
from gear_kinematics.kinematics import gear_from_mapping
from gear_kinematics.lost_motion import LostMotionReport
from gear_kinematics.lost_motion.document import document
from gear_kinematics.lost_motion.preload.over_preload import over_preload
from gear_kinematics.lost_motion.preload.settings import settings_of
from gear_kinematics.lost_motion.recorded.encoder_step import UNITS
from gear_kinematics.lost_motion.recorded.times import common_times
from gear_kinematics.lost_motion.several.common import at_common_torque
from gear_kinematics.lost_motion.several.compared import Compared, compared
from gear_kinematics.lost_motion.several.comparison import at_positions, grouped
from gear_kinematics.lost_motion.several.over_time import over_time
from gear_kinematics.lost_motion.several.positions import DEFAULT_PATTERN, over_positions
from gear_kinematics.lost_motion.static.hysteresis import STIFFNESS_SHARES
from gear_kinematics.lost_motion.task import WORK, Outcome, Task, measure_recording

HELP = 'lost motion, stiffness, play and transmission error from recordings'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    shares = ' and '.join(f'{100.0 * share:g}' for share in STIFFNESS_SHARES)
    parser.add_argument('recordings', nargs='+', type=Path, metavar='BAG|CSV')
    arguments.add_config(parser)
    arguments.add_ratio(parser)
    parser.add_argument(
        '--rated-torque',
        type=arguments.positive,
        metavar='N·m',
        help='at the output (default: the amplitude of the largest ramps, of several recordings '
        'the least)',
    )
    parser.add_argument(
        '--stiffness-torques',
        type=arguments.positive,
        nargs='+',
        metavar='N·m',
        help=f'limits of ranges of stiffness (default: {shares} %% of the rated torque)',
    )
    arguments.add_columns(parser, 'angle', 'torque', 'rotor', 'output', 'time')
    bags.add_encoders(parser)
    encoders = parser.add_argument_group('encoders')
    encoders.add_argument(
        '--counts',
        type=arguments.count,
        metavar='N',
        help='steps per turn of the rotor, or of the angle column (default: from the readings)',
    )
    encoders.add_argument(
        '--output-counts',
        type=arguments.count,
        metavar='N',
        help='the same of the output encoder',
    )
    encoders.add_argument(
        '--travel',
        type=arguments.positive,
        metavar='DEG',
        help='of the output that confirms a reversal (default: transmission_error_travel)',
    )
    encoders.add_argument(
        '--delay',
        type=arguments.finite,
        metavar='S',
        help='by which the stamps of the output encoder are late, s, or rows of a CSV (default: '
        'estimated; 0: none)',
    )
    several = parser.add_argument_group('several recordings')
    ways = several.add_mutually_exclusive_group()
    ways.add_argument(
        '--group',
        action='append',
        metavar='PATTERN',
        help='compare groups of recordings: a glob for each of them (repeat the option), or a '
        'regular expression with one group in parentheses',
    )
    several.add_argument(
        '--positions',
        nargs='?',
        const=DEFAULT_PATTERN,
        metavar='PATTERN',
        help='combine recordings at several positions of the output, by the text in parentheses '
        'of a regular expression in their names (default: position_1 ...)',
    )
    several.add_argument(
        '--preloads',
        nargs='?',
        const='',
        metavar='PATTERN',
        help='advise a preload by recordings at three settings or more, by a regular expression '
        'in their names: one group in parentheses, or three for pins (default: preload_1 ... or '
        'pins_0_78_1 ...)',
    )
    several.add_argument(
        '--preload-unit',
        choices=tuple(UNITS),
        help='of settings that are turns of a ring gear (default: plain numbers)',
    )
    several.add_argument(
        '--load',
        type=arguments.positive,
        metavar='N·m',
        help='under which there must be no play (default: none)',
    )
    ways.add_argument('--trend', action='store_true', help='find since when the gear has changed')
    arguments.add_fleet(several.add_mutually_exclusive_group())
    arguments.add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Measure every recording, even if others are unusable, and compare them."""
    if options.preloads is None and (options.load or options.preload_unit):
        raise ValueError(f'--{"load" if options.load else "preload-unit"} needs --preloads')
    reporter = Reporter(options, len(options.recordings), compared=True)
    outcomes = list(_outcomes(options))
    usable = [outcome for outcome in outcomes if outcome.report]
    damage = [outcome.report.recording.error for outcome in usable if outcome.report]
    for text in (*(outcome.error for outcome in outcomes), *damage):
        if text:
            complain(text)
    if usable:
        configs = (arguments.config_path(options, path) for path in options.recordings)
        reporter.write(document(*_compared(usable, options)), configs)
    complete = len(usable) == len(outcomes) and not any(damage)
    return ExitCode.DONE if complete else ExitCode.UNUSABLE


def _outcomes(options: argparse.Namespace) -> Iterator[Outcome]:
    """Measure the recordings, in processes or on a cluster if so told, in their order."""
    paths = options.recordings
    known = Counter(path.name for path in paths)
    found: dict[int, Outcome] = {}
    tasks: list[Task] = []
    for number, path in enumerate(paths):
        name = path.name if known[path.name] == 1 else str(path)
        try:
            tasks.append(_task(number, path, name, options))
        except (ValueError, OSError) as error:
            found[number] = Outcome(None, str(error))
    found |= {task.number: outcome for task, outcome in _measured(tasks, options)}
    return (found[number] for number in range(len(paths)))


def _measured(
    tasks: Sequence[Task], options: argparse.Namespace
) -> Iterator[tuple[Task, Outcome]]:
    if options.scheduler or options.jobs > 1:
        yield from bags.distributed(options, WORK, tasks, 'recordings')
        return
    for task in tasks:
        with message_progress(task.name, quiet=options.quiet) as report_progress:
            yield task, measure_recording(task, report_progress)


def _compared(
    usable: Sequence[Outcome], options: argparse.Namespace
) -> tuple[list[LostMotionReport], list[Compared]]:
    """Return the reports, those that are compared at a common torque, and what they tell."""
    reports = [outcome.report for outcome in usable if outcome.report]
    torques = options.rated_torque, options.stiffness_torques
    if options.trend:
        if options.positions or options.preloads is not None:
            wrong = 'positions' if options.positions else 'preloads'
            raise ValueError(f'--{wrong} cannot be combined with --trend')
        times, source = common_times([outcome.times for outcome in usable if outcome.times])
        order = sorted(range(len(reports)), key=times.__getitem__)
        reports = at_common_torque([reports[number] for number in order], *torques)
        return reports, [over_time(reports, [times[number] for number in order], source)]
    groups, apart = None, []
    if options.group:
        groups, others = grouped([report.recording.name for report in reports], options.group)
        for report in others:
            complain(f'{reports[report].recording.name}: is of no group, and not compared')
        apart = [reports[number] for number in others]
        reports = [report for number, report in enumerate(reports) if number not in others]
    found: list[Compared] = []
    reports = at_common_torque(reports, *torques)
    if options.positions:
        names = [report.recording.name for report in reports]
        gears, positions = at_positions(names, options.positions)
        groups = groups or gears
        found.append(over_positions(reports, groups, positions))
    if options.preloads is not None:
        found.append(_over_preload(reports, options))
    elif comparison := compared(reports, groups):
        found.append(comparison)
    if options.plot and not found and len(usable) > 1:
        raise ValueError('--plot: the recordings have no figure in common')
    return [*reports, *apart], found


def _over_preload(reports: Sequence[LostMotionReport], options: argparse.Namespace) -> Compared:
    gear = gear_from_mapping(arguments.load_config(options, options.recordings[0]))
    names = [report.recording.name for report in reports]
    settings, scale = settings_of(names, options.preloads, options.preload_unit, gear)
    return over_preload(reports, settings, scale, options.load or 0.0)


def _task(number: int, path: Path, name: str, options: argparse.Namespace) -> Task:
    config = arguments.load_config(options, path)
    if options.travel is not None:
        config['transmission_error_travel'] = math.radians(options.travel)
    return Task(
        number,
        path,
        name,
        config,
        arguments.columns(options),
        options.rotor_topic,
        options.encoder_topic,
        options.counts,
        options.output_counts,
        options.rated_torque,
        options.stiffness_torques and tuple(sorted(options.stiffness_torques)),
        options.fit_ratio,
        options.delay,
        options.debug,
    )
