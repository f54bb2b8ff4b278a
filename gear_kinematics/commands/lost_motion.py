# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin lost-motion`: hysteresis, stiffness, play and transmission error from recordings."""

import argparse
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import add_recordings, sources
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.measurement import names as naming
from gear_kinematics.measurement.answer import Limits
from gear_kinematics.measurement.compare.quantities import at_common_torque
from gear_kinematics.measurement.compare.section import compared, over_time
from gear_kinematics.measurement.document import Comparison, document
from gear_kinematics.measurement.encoder_step import UNITS
from gear_kinematics.measurement.figures import STIFFNESS_SHARES
from gear_kinematics.measurement.lost_motion import (
    WORK,
    LostMotion,
    Outcome,
    Request,
    Task,
    measure_recording,
)
from gear_kinematics.measurement.preload.section import over_preload
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import Verdict


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    shares = ' and '.join(f'{100.0 * share:g}' for share in STIFFNESS_SHARES)
    add_recordings(parser, 'angle', 'torque', 'rotor', 'output', 'time')
    arguments.group(parser, 'recording').add_argument(
        '--delay',
        type=arguments.finite,
        metavar='S',
        help='by which the stamps of the output encoder are late, s, or rows of a CSV without '
        'times (default: estimated; 0: none)',
    )
    gear = arguments.group(parser, 'gear')
    gear.add_argument(
        '--rated-torque',
        type=arguments.positive,
        metavar='N·m',
        help='at the output (default: the amplitude of the largest ramps, of several recordings '
        'the least)',
    )
    gear.add_argument(
        '--stiffness-torques',
        type=arguments.positive,
        nargs='+',
        metavar='N·m',
        help=f'limits of ranges of stiffness (default: {shares} %% of the rated torque)',
    )
    limits = parser.add_argument_group(
        'limits', 'exit code 1 where one is exceeded, or cannot be shown to hold'
    )
    for name in ('hysteresis', 'lost-motion', 'backlash'):
        limits.add_argument(f'--max-{name}', type=_arc_minutes, metavar='ARCMIN')
    limits.add_argument('--min-stiffness', type=arguments.positive, metavar='N·m/rad')
    several = parser.add_argument_group('several recordings')
    ways = several.add_mutually_exclusive_group()
    ways.add_argument(
        '--group',
        action='append',
        metavar='PATTERN',
        help='compare groups of recordings: a glob for each of them (repeat the option), or a '
        'regular expression with one group in parentheses',
    )
    ways.add_argument('--trend', action='store_true', help='find since when the gear has changed')
    several.add_argument(
        '--positions',
        nargs='?',
        const=naming.POSITION,
        metavar='PATTERN',
        help='pair recordings of gears at the same position of the output, by the text in '
        'parentheses of a regular expression in their names (default: position_1 ...)',
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
    bags.add_fleet(several.add_mutually_exclusive_group())
    add_report_forms(parser, junit=True)
    arguments.add_verbose(parser, 'print tables and remarks in a pipe, too')


def _arc_minutes(text: str) -> float:
    return arguments.positive(text) / ARC_MINUTES


def run(options: argparse.Namespace) -> ExitCode:
    """Measure every recording, even if others are unusable, and compare them."""
    _check(options)
    limits = Limits(
        options.max_hysteresis,
        options.max_lost_motion,
        options.max_backlash,
        options.min_stiffness,
    )
    reporter = Reporter(options, len(options.recordings), compared=True, brief=not options.verbose)
    outcomes = _outcomes(options)
    reports = [outcome.report for outcome in outcomes if outcome.report]
    damage = [report.recording.damage for report in reports]
    for text in (*(outcome.error for outcome in outcomes), *damage):
        if text:
            complain(text)
    verdict = None
    if reports:
        configs = (arguments.config_path(options, path) for path in options.recordings)
        found = document(*_compared(reports, options), limits)
        verdict = found.verdict
        reporter.write(found, configs)
    if len(reports) < len(outcomes) or any(damage):
        return ExitCode.UNUSABLE
    return ExitCode.FAILED if verdict == Verdict.FAIL else ExitCode.DONE


def _check(options: argparse.Namespace) -> None:
    """Refuse options that exclude each other, and patterns that are none, before any work."""
    if options.preloads is None and (options.load or options.preload_unit):
        raise ValueError(f'--{"load" if options.load else "preload-unit"} needs --preloads')
    given = [name for name in ('positions', 'preloads') if getattr(options, name) is not None]
    if given and (options.trend or len(given) > 1):
        other = 'trend' if options.trend else 'preloads'
        raise ValueError(f'--{given[0]} cannot be combined with --{other}')
    names = _names(options.recordings)
    if options.group:
        _, others = naming.grouped(names, options.group)
        names = [name for number, name in enumerate(names) if number not in others]
    if options.positions is not None:
        gears, _ = naming.positions_of(names, options.positions)
        if not options.group and len(gears) == 1:
            raise ValueError('--positions: these are of one gear; tell its states with --group')
    if options.preloads is not None:
        gear = arguments.load_config(options, options.recordings[0]).gear
        naming.settings_of(names, options.preloads, options.preload_unit, gear)


def _names(paths: Sequence[Path]) -> list[str]:
    """Name recordings by their files, or by their paths where those are the same."""
    known = Counter(path.name for path in paths)
    return [path.name if known[path.name] == 1 else str(path) for path in paths]


def _outcomes(options: argparse.Namespace) -> list[Outcome]:
    """Measure the recordings; returns the outcomes in their order."""
    paths = options.recordings
    found: dict[int, Outcome] = {}
    tasks: list[Task] = []
    for number, (path, name) in enumerate(zip(paths, _names(paths), strict=True)):
        try:
            tasks.append(_task(number, path, name, options))
        except (ValueError, OSError) as error:
            found[number] = Outcome(None, str(error))

    def measure(task: Task) -> Outcome:
        with message_progress(task.name, quiet=options.quiet) as report_progress:
            return measure_recording(task, report_progress)

    for task, outcome in bags.results(options, WORK, tasks, 'recordings', measure):
        found[task.number] = outcome
    return [found[number] for number in range(len(paths))]


def _compared(
    reports: Sequence[LostMotion], options: argparse.Namespace
) -> tuple[list[LostMotion], list[Comparison]]:
    """Return the reports, those that are compared at a common torque, and what they tell."""
    torques = options.rated_torque, options.stiffness_torques
    if options.trend:
        times, source = naming.common_times([report.recording for report in reports])
        order = sorted(range(len(reports)), key=times.__getitem__)
        ordered = at_common_torque([reports[number] for number in order], *torques)
        return ordered, [over_time(ordered, [times[number] for number in order], source)]
    if len(reports) == 1 and options.preloads is None:
        return [*reports], []
    groups, apart = None, []
    if options.group:
        groups, others = naming.grouped([report.name for report in reports], options.group)
        for number in others:
            complain(f'{reports[number].name}: is of no group, and not compared')
        apart = [reports[number] for number in others]
        reports = [report for number, report in enumerate(reports) if number not in others]
    reports = at_common_torque(reports, *torques)
    found: list[Comparison] = []
    positions = None
    if options.positions is not None:
        names = [report.name for report in reports]
        gears, positions = naming.positions_of(names, options.positions)
        groups = groups or gears
    if options.preloads is not None:
        gear = arguments.load_config(options, options.recordings[0]).gear
        settings, scale = naming.settings_of(
            [report.name for report in reports], options.preloads, options.preload_unit, gear
        )
        found.append(over_preload(reports, settings, scale, options.load))
    else:
        found += filter(None, [compared(reports, groups, positions)])
    if options.plot and not found:
        raise ValueError('--plot: the recordings have no figure in common')
    return [*reports, *apart], found


def _task(number: int, path: Path, name: str, options: argparse.Namespace) -> Task:
    config = arguments.load_config(options, path)
    corners = options.stiffness_torques and tuple(sorted(options.stiffness_torques))
    return Task(
        number,
        path,
        name,
        config,
        Request(options.rated_torque, corners, options.delay),
        sources(options),
        options.debug,
    )
