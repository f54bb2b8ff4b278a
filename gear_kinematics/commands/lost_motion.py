"""`gearkin lost-motion`: hysteresis, stiffness, play and transmission error from recordings."""

import argparse
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gear_kinematics.bag.errors import unexpected
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import Reporter, complain, message_progress
from gear_kinematics.kinematics import Gear, gear_from_mapping
from gear_kinematics.lost_motion import (
    LostMotionReport,
    Recording,
    measure,
    read_bag,
    read_csv,
)
from gear_kinematics.lost_motion.document import document
from gear_kinematics.lost_motion.hysteresis import STIFFNESS_SHARES
from gear_kinematics.lost_motion.motion import MotionError
from gear_kinematics.lost_motion.ramps import RampError
from gear_kinematics.lost_motion.ratio import fit_ratio

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
        help='at the output (default: the amplitude of the largest ramps)',
    )
    parser.add_argument(
        '--stiffness-torques',
        type=arguments.positive,
        nargs='+',
        metavar='N·m',
        help=f'limits of ranges of stiffness (default: {shares} %% of the rated torque)',
    )
    arguments.add_columns(parser, 'angle', 'torque', 'rotor', 'output')
    arguments.add_encoder_topics(parser)
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
    arguments.add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Measure every recording, even if others are unusable."""
    reporter = Reporter(options, len(options.recordings))
    reports = []
    for path in options.recordings:
        try:
            reports.append(_measure(path, options))
        except (RampError, MotionError) as error:
            complain(f'{path}: {error}')
        except (ValueError, OSError) as error:
            complain(error)
        except Exception as error:  # noqa: BLE001, the other recordings are worth reporting
            complain(f'{path}: {unexpected(error, debug=options.debug)}')
    damage = [report.recording.error for report in reports if report.recording.error]
    for text in damage:
        complain(text)
    if reports:
        reporter.write(document(reports))
    complete = len(reports) == len(options.recordings) and not damage
    return ExitCode.DONE if complete else ExitCode.UNUSABLE


def _measure(path: Path, options: argparse.Namespace) -> LostMotionReport:
    config = arguments.load_config(options, path)
    if options.max_gap is not None:
        config['transmission_error_max_gap'] = options.max_gap
    if options.travel is not None:
        config['transmission_error_travel'] = math.radians(options.travel)
    gear, fitted = gear_from_mapping(config), None
    recording = _read(path, options, config, gear)
    if options.fit_ratio:
        if not recording.motion:
            raise MotionError('--fit-ratio needs the angles of rotor and output')
        fitted = fit_ratio(recording.motion, gear.gear_ratio)
        if fitted.ratio != gear.gear_ratio:
            gear = fitted.ratio
            recording = _read(path, options, config | {'gear_ratio': str(gear)}, gear)
    corners = options.stiffness_torques and tuple(sorted(options.stiffness_torques))
    return measure(recording, gear, options.rated_torque, corners, fitted, options.delay)


def _read(
    path: Path, options: argparse.Namespace, config: Mapping[str, Any], gear: Gear
) -> Recording:
    if arguments.is_csv(path):
        return read_csv(
            path,
            gear,
            arguments.columns(options),
            config['transmission_error_travel'],
            options.counts,
            options.output_counts,
        )
    with message_progress(path.name) as report_progress:
        return read_bag(
            path,
            config,
            options.rotor_topic,
            options.encoder_topic,
            options.counts,
            options.output_counts,
            report_progress,
        )
