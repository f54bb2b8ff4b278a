# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin commission`: the parameters of the node, from recordings of both encoders."""

import argparse
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag.roles import joints_on
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import (
    add_known_ratio,
    add_new_config,
    add_recordings,
    ask_for_one_topic,
    known_ratio,
    say_columns,
    sources,
)
from gear_kinematics.commands.joints import choose_joint
from gear_kinematics.commands.output import (
    Console,
    announce_ros,
    complain,
    message_progress,
    stopped_by_signals,
)
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.measurement.commissioning import analysis
from gear_kinematics.measurement.commissioning.document import document, write_parameters
from gear_kinematics.measurement.formats import is_table, open_bag
from gear_kinematics.measurement.reading import as_recorded, read
from gear_kinematics.measurement.rotor_fields import questions
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm_file import check_new
from gear_kinematics.wire.topics import JOINT_STATE


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recordings(parser, 'rotor', 'output', configured=False)
    recording = arguments.group(parser, 'recording')
    text = 'listen to the drivers while you turn the output by hand as advised; Enter ends it'
    recording.add_argument('--live', action='store_true', help=text)
    recording.add_argument('--encoder-joint', metavar='NAME', help='joint of the output encoder')
    gear = arguments.group(parser, 'gear')
    known = add_known_ratio(parser, 'ratio to confirm, such as -19')
    text = 'judge this parameter file, and write none'
    known.add_argument('--check', type=Path, metavar='FILE', help=text)
    text = (
        'moment of the last recording at which the output angle is 0; a stamp or a time, s '
        "(default: where the output's encoder reads 0)"
    )
    gear.add_argument('--zero-here', type=_moment, metavar='START|END|STAMP', help=text)
    add_new_config(parser)
    arguments.add_verbose(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    path = Path(options.output)
    if not options.check:
        check_new(path, options.actuator, options.joint or '', options.encoder_joint or '')
    if options.live == bool(options.recordings):
        raise ValueError('name recordings, or give --live to listen to the drivers instead')
    written = {} if options.check or path.exists() else {'-o': options.output}
    reporter = Reporter(options, others=written)
    file = None
    if options.check:
        file = NodeParameters.load(options.check, actuator=options.actuator)
        options.joint = options.joint or file.rotor_joint
        options.encoder_joint = options.encoder_joint or file.output_encoder_joint
    request = analysis.Request(
        rotor=analysis.Channel(options.rotor_topic or '', options.joint or ''),
        output=analysis.Channel(options.encoder_topic or '', options.encoder_joint or ''),
        ratio=file.gear.gear_ratio if file else known_ratio(options),
        teeth=options.teeth,
        zero_here=options.zero_here,
        file=file,
    )
    result = _hear(request) if options.live else _read(options, request)
    if result.between and not file:
        command = write_parameters(result, path, options.actuator)
        if options.actuator and not options.quiet:
            complain(f'start the node with {command}')
            ask_for_one_topic(path)
    report = document(result, str(options.check or path))
    return reporter.write(report, [options.check] if file else [])


def _read(options: argparse.Namespace, request: analysis.Request) -> analysis.Commissioning:
    source = replace(sources(options), as_recorded=True, needs_times=True)
    recordings = []
    for path in options.recordings:
        with bags.naming(path):
            request = request if is_table(path) else _chosen(_recorded(path), request)
        rotor, output = request.rotor, request.output
        joints = as_recorded(rotor.joint, output.joint)
        topics = replace(source, rotor_topic=rotor.topic, encoder_topic=output.topic)
        with message_progress(path.name, quiet=options.quiet) as progress:
            recordings.append(read(path, joints, topics, progress, both=True))
    result = analysis.commission(recordings, request)
    asked = dict[str, None]()
    for recording in recordings:
        say_columns(recording, options)
        if heard := recording.rotor_messages:
            known = result.between, request.limits
            found = questions(heard.data, heard.received, request.rotor.joint, *known)
            asked |= dict.fromkeys(map(str, found))
    return replace(result, questions=tuple(asked))


def _recorded(path: Path) -> list[analysis.Channel]:
    with open_bag(path) as bag:
        heard = joints_on(bag, [topic for topic in bag.topics if bag.topics[topic] == JOINT_STATE])
    return [analysis.Channel(topic, joint) for topic, joints in heard.items() for joint in joints]


def _chosen(joints: list[analysis.Channel], request: analysis.Request) -> analysis.Request:
    rotor = choose_joint(joints, request.rotor, 'rotor')
    output = choose_joint([each for each in joints if each != rotor], request.output, 'output')
    return replace(request, rotor=rotor, output=output)


def _hear(request: analysis.Request) -> analysis.Commissioning:
    """Listen to both encoders until all values are known, or the user ends it."""
    announce_ros(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.watch.commissioning import LiveCommissioning  # noqa: PLC0415
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import guide, list_drivers  # noqa: PLC0415

    console, drivers = Console(stderr=True), listen()
    list_drivers(drivers, console)
    joints = [analysis.Channel(d.topic, joint) for d in drivers for joint in d.joints]
    request = _chosen(joints, request)
    live = LiveCommissioning(request)
    with stopped_by_signals() as stopped:
        guide(live, console, stopped)
        if stopped():
            raise KeyboardInterrupt
    return live.result()


def _moment(text: str) -> float | str:
    try:
        return text if text in {'START', 'END'} else arguments.between(0.0, 1e12)(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f'must be START, END or a number, not {text}') from error
