# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin commission`: the parameters of the node, from recordings of both encoders."""

import argparse
import math
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import add_recordings, ratio_text, sources
from gear_kinematics.commands.files import write_text
from gear_kinematics.commands.guided import add_live, read_live
from gear_kinematics.commands.output import message_progress
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.commissioning import Request, actuator_file, commission
from gear_kinematics.measurement.commissioning.check import judge
from gear_kinematics.measurement.commissioning.document import check_document, document
from gear_kinematics.measurement.commissioning.reading import Read, read_positions
from gear_kinematics.measurement.ratio import ENCODER_ERROR
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.parameters.new_config import write_new


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_recordings(parser, 'rotor', 'output', 'time', configured=False)
    add_live(parser)
    arguments.group(parser, 'recording').add_argument(
        '--encoder-joint', metavar='NAME', help='of the output (default: the only one)'
    )
    gear = arguments.group(parser, 'gear')
    known = gear.add_mutually_exclusive_group()
    known.add_argument(
        '--ratio',
        type=ratio_text,
        metavar='I',
        help='confirm this exact ratio, such as -19',
    )
    known.add_argument(
        '--teeth', type=_teeth, metavar='ZK/ZS', help='confirm the teeth of ring gear/satellite'
    )
    gear.add_argument(
        '--encoder-error',
        type=arguments.between(1e-3, 90.0),
        default=math.degrees(ENCODER_ERROR),
        metavar='DEG',
        help='that each encoder may have, once a turn (default: %(default)g)',
    )
    gear.add_argument(
        '--zero-here',
        type=_moment,
        metavar='START|END|S',
        help='the output angle is 0 then, in the last recording: s from its start, or since 1970 '
        "(default: at 0 of the output's encoder)",
    )
    output = arguments.group(parser, 'output')
    output.add_argument(
        '-o',
        '--output',
        default=default_config().name,
        metavar='FILE',
        help='the parameter file; - is stdout (default: %(default)s); replaces nothing',
    )
    output.add_argument(
        '--check', type=Path, metavar='FILE', help='judge this parameter file, and write none'
    )
    arguments.add_verbose(parser, 'print tables and remarks in a pipe, too')
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Write a parameter file, or judge one."""
    path = Path(options.output)
    others = {} if options.check else {'-o': options.output}
    if others and options.output != '-' and (path.exists() or path.is_symlink()):
        raise ValueError(f'{path}: exists already; give another name with -o')
    reporter = Reporter(options, others=others, brief=not options.verbose)
    file = NodeParameters.load(options.check) if options.check else None
    if options.live:
        known = Request(ratio=_ratio(options), encoder_error=math.radians(options.encoder_error))
        read = [read_live(options, known)]
    else:
        read = [_read(options, recording) for recording in options.recordings]
    if not read:
        raise ValueError('name recordings, or --live')
    if len({each[2:] for each in read}) > 1:
        raise ValueError('the recordings have different topics or joints: are they of one gear?')
    request = Request(
        rotor=read[0][2],
        output=read[0][3],
        ratio=_ratio(options),
        teeth=options.teeth,
        zero_here=options.zero_here,
        encoder_error=math.radians(options.encoder_error),
    )
    result = commission([each[:2] for each in read], request)
    if file:
        judgements = list(judge(result, file))
        reporter.write(check_document(result, str(options.check), judgements), [options.check])
        failed = any(each.holds is False for each in judgements)
        return ExitCode.FAILED if failed else ExitCode.DONE
    if not result.fault:
        text = actuator_file(result, path.name if options.output != '-' else default_config().name)
        write_text('-', text) if options.output == '-' else write_new(path, text)
    reporter.write(document(result, options.output))
    return ExitCode.FAILED if result.fault else ExitCode.DONE


def _read(options: argparse.Namespace, path: Path) -> Read:
    joints = options.joint, options.encoder_joint
    with bags.naming(path), message_progress(path.name, quiet=options.quiet) as progress:
        return read_positions(path, sources(options), joints, progress)


def _ratio(options: argparse.Namespace) -> GearRatio | None:
    if options.teeth:
        ring, satellite = options.teeth
        return GearRatio(-satellite, ring - satellite)
    return GearRatio.parse(options.ratio) if options.ratio else None


def _teeth(text: str) -> tuple[int, int]:
    ring, _, satellite = text.partition('/')
    if not (ring.isdecimal() and satellite.isdecimal() and 0 < int(satellite) < int(ring)):
        raise argparse.ArgumentTypeError(f'must be such as 80/76, not {text}')
    return int(ring), int(satellite)


def _moment(text: str) -> float | str:
    try:
        return text if text in {'START', 'END'} else arguments.finite(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f'must be START, END or a number, not {text}') from error
