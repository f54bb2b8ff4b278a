# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin record`: records what the running nodes receive and publish."""

import argparse
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from shlex import quote

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import Console, announce_ros, stopped_by_signals
from gear_kinematics.parameters import NODE, NodeParameters
from gear_kinematics.report.document import counted, hertz
from gear_kinematics.wire.nearest import listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('out', type=Path, metavar='OUT', help='folder to create')
    arguments.add_config(
        parser,
        default='those of the running nodes; a copy is kept in OUT for validate',
        chosen=f'record this node alone, such as /left/{NODE}, and take its parameters '
        'from FILE (default: all nodes)',
        actuator=arguments.ALL,
    )
    parser.set_defaults(calibration=None)


def run(options: argparse.Namespace) -> ExitCode:
    """Record until interrupted; ValueError if nothing was heard."""
    if options.actuator and not options.config:
        raise ValueError('--actuator chooses in --config FILE: running arms are recorded whole')
    configs = arguments.load_configs(options) if options.config else {}
    files = bags.files_of(options, configs, None) if configs else {}
    announce_ros(participants=1)
    # These need ROS, unlike most commands, and the last one rosbags.
    from gear_kinematics.ros.live import replay_node  # noqa: PLC0415
    from gear_kinematics.watch.gear import parameters_of  # noqa: PLC0415
    from gear_kinematics.watch.recorder import Recorder  # noqa: PLC0415
    from gear_kinematics.watch.text import show_recording  # noqa: PLC0415, isort: skip
    from gear_kinematics.bag.writing import BagWriter  # noqa: PLC0415, an extra

    with stopped_by_signals() as stopped, BagWriter(options.out) as bag:
        # At the end, a node that was homed would have another zero than its first outputs.
        answers: dict[str, Future[Mapping[str, NodeParameters]]] = {}
        with (
            replay_node('') as node,
            replay_node('', 'gear_kinematics_asking') as asking,
            ThreadPoolExecutor(1) as thread,
        ):

            def ask(gear: str) -> None:
                answers[gear] = thread.submit(parameters_of, asking, gear, runs=True)

            loads = any(each.preload for each in configs.values())
            found = (lambda _: None) if files else ask
            recorder = Recorder(node, bag, options.node, loads=loads, found=found)
            show_recording(recorder, Console(), stopped)
            recorder.end(lambda: print('waiting for the outputs of the last inputs', flush=True))
            gears = sorted(recorder.gears)
            running = {
                gear: answers[gear].result() or parameters_of(node, gear)
                for gear in sorted(answers)
            }
            files = files or kept(options, running)
        for name, content in files.items():
            bag.add_file(name, content)
        heard = recorder.heard
        missing = listed(sorted(recorder.inputs - heard.keys()))
        if not recorder.inputs & heard.keys():
            bag.keeps = False
            none = recorder.absent or 'no gear_state_publisher runs with this ROS_DOMAIN_ID'
            why = f'no driver was heard on {missing}' if missing else none
            raise ValueError(f'nothing was recorded: {why}')
    print(f'{options.out}: {counted(sum(p.count for p in heard.values()), "message")}')
    for topic, polled in sorted(heard.items()):
        rate = f', {hertz(polled.mean_rate)}' * (polled.count > 2)  # noqa: PLR2004, two may come at once
        lost = f', {polled.lost} lost on the way' * bool(polled.lost)
        print(f'    {topic}: {counted(polled.count, "message")}{rate}{lost}')
    if any(polled.lost for polled in heard.values()):
        print('the computer is too busy to record every message')
    if missing:
        print(f'nothing came on {missing}')
    given = '' if files else ' --config FILE, with the parameter file of the node'
    for gear in gears:
        chosen = f' --node {gear}' * (len(gears) > 1)
        print(f'prove it: gearkin validate {quote(str(options.out))}{chosen}{given}')
    return ExitCode.DONE


def kept(
    options: argparse.Namespace, running: Mapping[str, Mapping[str, NodeParameters]]
) -> dict[str, bytes]:
    """Return the parameters of running nodes, by their full names, as files to keep beside a bag.

    Several nodes share the parameter file. One that has not answered is left out.
    """
    files: dict[str, bytes] = {}
    for gear, configs in running.items():
        with suppress(OSError):  # the calibration may be on another computer
            own = bags.files_of(options, configs, None, gear * (len(running) > 1))
            files |= {name: files.get(name, b'') + own[name] for name in own if configs}
    return files
