# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin commission`: the parameters of the node, from recordings of both encoders."""

import argparse
import sys
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import add_recordings, ratio_text, sources
from gear_kinematics.commands.joints import choose_joint
from gear_kinematics.commands.output import (
    Console,
    complain,
    message_progress,
    warn_of_shared_memory,
)
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.commissioning import Channel, Request, actuator_file, commission
from gear_kinematics.measurement.commissioning.check import judge
from gear_kinematics.measurement.commissioning.document import check_document, document
from gear_kinematics.measurement.commissioning.reading import read_positions
from gear_kinematics.measurement.recording import Encoders, Recording
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.parameters.new_config import write_new
from gear_kinematics.report.document import printable

_Heard = tuple[list[tuple[Recording, Encoders]], Request]
"""Recordings, and the request with the joints that were heard."""
_WAIT = 4.0  # s; a driver may find this listener only when it announces itself, every 3 s


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_recordings(parser, 'rotor', 'output', configured=False)
    recording = arguments.group(parser, 'recording')
    recording.add_argument(
        '--live',
        action='store_true',
        help='hear the drivers now, and guide through turning the output by hand; Enter ends it',
    )
    recording.add_argument(
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
    known.add_argument(
        '--check', type=Path, metavar='FILE', help='judge this parameter file, and write none'
    )
    gear.add_argument(
        '--zero-here',
        type=_moment,
        metavar='START|END|STAMP',
        help='the output angle is 0 then, in the last recording; a stamp or time of it, s '
        "(default: at 0 of the output's encoder)",
    )
    output = arguments.group(parser, 'output')
    output.add_argument(
        '-o',
        '--output',
        default=default_config().name,
        metavar='FILE',
        help='the parameter file (default: %(default)s); replaces nothing',
    )
    arguments.add_verbose(parser, 'print tables and remarks in a pipe, too')
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Write a parameter file, or judge one."""
    path = Path(options.output)
    if not options.check and (path.exists() or path.is_symlink()):
        raise ValueError(f'{path}: exists already; give another name with -o')
    if options.live == bool(options.recordings):
        raise ValueError('name recordings, or --live, which hears the drivers instead')
    others = {} if options.check else {'-o': options.output}
    reporter = Reporter(options, others=others, brief=not options.verbose)
    file = NodeParameters.load(options.check) if options.check else None
    request = Request(
        ratio=file.gear.gear_ratio if file else _ratio(options),
        teeth=options.teeth,
        zero_here=options.zero_here,
    )
    if file:
        options.joint = options.joint or file.rotor_joint
        options.encoder_joint = options.encoder_joint or file.output_encoder_joint
    recordings, request = (_hear if options.live else _read)(options, request)
    result = commission(recordings, request)
    if file:
        judgements = list(judge(result, file))
        reporter.write(check_document(result, str(options.check), judgements), [options.check])
        failed = any(each.holds is False for each in judgements)
        return ExitCode.FAILED if failed else ExitCode.DONE
    if not result.fault:
        write_new(path, actuator_file(result, path.name))
    elif options.quiet:  # where no report says it
        complain(result.fault)
    reporter.write(document(result, options.output))
    return ExitCode.FAILED if result.fault else ExitCode.DONE


def _read(options: argparse.Namespace, request: Request) -> _Heard:
    """Read the recordings."""
    joints = options.joint, options.encoder_joint
    recordings, channels = [], set()
    for path in options.recordings:
        with bags.naming(path), message_progress(path.name, quiet=options.quiet) as progress:
            read = read_positions(path, sources(options), joints, progress)
        recordings.append(read[:2])
        channels.add(read[2:])
    if len(channels) > 1:
        raise ValueError('the recordings have different topics or joints: are they of one gear?')
    [(rotor, output)] = channels
    return recordings, replace(request, rotor=rotor, output=output)


def _hear(options: argparse.Namespace, request: Request) -> _Heard:
    """Hear both encoders until they tell what is needed, or the user ends it.

    Raises:
        KeyboardInterrupt: on SIGINT or SIGTERM.
        ValueError: if there is nothing to hear.
    """
    warn_of_shared_memory(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.ros.live import replay_node  # noqa: PLC0415
    from gear_kinematics.ros.replay import stopped_by_signals  # noqa: PLC0415
    from gear_kinematics.watch.commissioning import LiveCommissioning  # noqa: PLC0415
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import guide, list_drivers  # noqa: PLC0415

    console, drivers = Console(stderr=True), listen(_WAIT)
    list_drivers(drivers, console)
    given = options.rotor_topic, options.joint
    rotor = choose_joint(drivers, given, 'rotor', '--rotor-topic and --joint')
    given = options.encoder_topic, options.encoder_joint
    output = choose_joint(drivers, given, 'output', '--encoder-topic and --encoder-joint', rotor)
    chosen = 'rotor: {1} on {0}; output: {3} on {2}'.format(*rotor, *output)
    print(printable(chosen), file=sys.stderr)
    request = replace(request, rotor=Channel(*rotor), output=Channel(*output))
    with stopped_by_signals() as stopped, replay_node('') as node:
        live = LiveCommissioning(node, request, once=True)
        with closing(live):
            guide(live, console, stopped)
        if stopped():
            raise KeyboardInterrupt
        live.finish()
    if not live.collected:
        raise ValueError(live.fault)
    return [live.collected], live.request


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
