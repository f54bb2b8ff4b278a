# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin lost-motion`: hysteresis, stiffness, play and transmission error from recordings."""

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag.errors import unexpected
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.encoders import add_recordings, say_columns, sources
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.measurement.answer import Limits
from gear_kinematics.measurement.changes import at_common_torque, grouped
from gear_kinematics.measurement.compare import compared
from gear_kinematics.measurement.document import Comparison, document
from gear_kinematics.measurement.lost_motion import LostMotion, measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.wording import ARC_MINUTES


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recordings(parser, 'angle', 'torque', 'rotor', 'output')
    gear = arguments.group(parser, 'gear')
    text = 'rated torque at the output (default: the amplitude of the largest ramps)'
    torque, stiffness = arguments.between(1e-6, 1e6), arguments.between(1e-3, 1e12)
    gear.add_argument('--rated-torque', type=torque, metavar='N·m', help=text)
    limits = parser.add_argument_group(
        'limits', 'exit code 1 if a limit is exceeded, or cannot be shown to hold'
    )
    for name in ('hysteresis', 'lost-motion', 'backlash'):
        text = f'greatest {name.replace("-", " ")}'
        limits.add_argument(f'--max-{name}', type=_arc_minutes, metavar='ARCMIN', help=text)
    limits.add_argument(
        '--min-stiffness', type=stiffness, metavar='N·m/rad', help='least stiffness'
    )
    several = parser.add_argument_group('several recordings')
    text = 'glob of the names of a group of recordings to compare (repeat the option for each)'
    several.add_argument('--group', action='append', metavar='PATTERN', help=text)
    add_report_forms(parser, junit=True)
    arguments.add_verbose(parser)


def _arc_minutes(text: str) -> float:
    return arguments.between(1e-6, 21_600.0)(text) / ARC_MINUTES


def run(options: argparse.Namespace) -> ExitCode:
    """Measure every recording, even if others are unusable, and compare them."""
    names = _names(options.recordings)
    if options.group:
        grouped(names, options.group)  # its error, before any work
    limits = Limits(
        options.max_hysteresis,
        options.max_lost_motion,
        options.max_backlash,
        options.min_stiffness,
    )
    reporter = Reporter(options, len(names), compared=True)
    reports, failed = [], False
    for path, name in zip(options.recordings, names, strict=True):
        try:
            reports.append(_measured(path, name, options))
        except (ValueError, OSError) as error:
            failed = True
            cause = str(error)
            complain(cause if str(path) in cause else f'{path}: {cause}')
    for report in reports:
        if report.recording.damage:
            failed = True
            complain(report.recording.damage)
        if report.wrong_ratio:  # which makes its section unusable
            complain(f'{report.name}: {report.wrong_ratio.sentence}')
    code = ExitCode.DONE
    if reports:
        configs = (arguments.config_path(options, path) for path in options.recordings)
        code = reporter.write(document(*_compared(reports, options), limits), configs)
    return ExitCode.UNUSABLE if failed else code


def _names(paths: Sequence[Path]) -> list[str]:
    """Name recordings by file name, or by path if several files have the same name."""
    known = Counter(path.name for path in paths)
    return [path.name if known[path.name] == 1 else str(path) for path in paths]


def _measured(path: Path, name: str, options: argparse.Namespace) -> LostMotion:
    """Measure a recording; raises ValueError or OSError if that is impossible."""
    config = arguments.load_config(options, path)
    with message_progress(name, quiet=options.quiet) as report_progress:
        try:
            recording = read(path, config, sources(options), report_progress)
            found = measure(replace(recording, name=name), config, options.rated_torque)
            say_columns(found.recording, options)
        except (ValueError, OSError, ImportError):
            raise
        except Exception as error:  # the other recordings are worth reporting
            raise ValueError(unexpected(error, debug=options.debug)) from error
        return found


def _compared(
    reports: Sequence[LostMotion], options: argparse.Namespace
) -> tuple[Sequence[LostMotion], Comparison | None]:
    """Return the reports, at a common torque if they are compared, and the comparison."""
    groups, apart = None, []
    if options.group:
        patterns = options.group
        try:
            groups = grouped([report.name for report in reports], patterns)
        except ValueError as error:  # what was measured is worth reporting
            complain(f'{error} among the usable recordings; nothing is compared')
            return reports, None
        members = {number for group in groups for number in group.members}
        apart = [report for number, report in enumerate(reports) if number not in members]
        reports = [reports[number] for number in sorted(members)]
        groups = grouped([report.name for report in reports], patterns)
        for report in apart:
            complain(f'{report.name}: is of no group, and not compared')
    if len(reports) == 1:
        return reports, None
    reports = at_common_torque(reports)
    found = compared(reports, groups)
    return [*reports, *apart], found
