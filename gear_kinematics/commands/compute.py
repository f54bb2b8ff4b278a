# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin compute`: add the outputs to a bag that has only the rotor topic."""

import argparse
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag import Bag
from gear_kinematics.bag.roles import find_encoder_topic, find_rotor_topic, only_joint, outputs_of
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.parameters.arm import labelled
from gear_kinematics.report.document import printable
from gear_kinematics.validation.compute import ComputeResult, compute
from gear_kinematics.wire.nearest import listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bag', type=Path, metavar='BAG', help='file or folder')
    parser.add_argument('out', type=Path, metavar='OUT', help='folder to create')
    bags.add_rotor(parser)
    bags.add_encoder(parser)
    arguments.add_config(parser, actuator=arguments.ALL)
    arguments.add_ratio(parser)
    bags.add_calibration(parser)
    output = arguments.group(parser, 'output')
    output.add_argument(
        '--topics',
        nargs='*',
        metavar='NAME',
        help='other topics to copy (default: all except further outputs of the node)',
    )
    for name, *choices in ('storage', 'mcap', 'sqlite3'), ('compression', 'none', 'zstd'):
        text = f'{name} of the files (default: {choices[0]})'
        output.add_argument(f'--{name}', choices=choices, default=choices[0], help=text)
    arguments.add_quiet(parser)


def run(options: argparse.Namespace) -> ExitCode:
    configs = arguments.load_configs(options, options.bag)
    arguments.check_of_one(options, configs, 'calibration')
    calibrations = {
        name: bags.load_calibration(options, config, options.bag)
        for name, config in configs.items()
    }
    with (
        bags.naming(options.bag, options.out),
        Bag(options.bag) as bag,
        message_progress(options.bag.name, quiet=options.quiet) as progress,
    ):
        first = next(iter(configs.values())).rotor_joint
        joints = [each.rotor_joint for each in configs.values()]
        rotor = options.rotor_topic or find_rotor_topic(bag, None, *joints)
        taken = first
        if options.joint is None and first and '' in configs:
            taken = only_joint(bag, rotor, first)
            configs = {'': replace(configs[''], rotor_joint=taken)}
        absolute = [each.distinct_encoder_joint for each in configs.values() if each.absolute]
        encoder = ''
        if absolute or options.encoder_topic:
            encoder = find_encoder_topic(bag, rotor, options.encoder_topic, *absolute)
        result = compute(
            bag,
            options.out,
            configs,
            topics=outputs_of(bag, rotor),
            encoder_topic=encoder,
            calibrations=calibrations,
            others=options.topics,
            files=bags.files_of(options, configs, options.bag),
            storage=options.storage,
            compression=options.compression,
            progress=progress,
        )
    if not options.quiet:
        _print_summary(options.out, result)
        if taken != first:
            print(printable(f'{taken}, the only joint on {rotor}, is taken'))
    code = ExitCode.DONE
    for name, read in result.inputs.items():
        if read.mostly_rejected:
            missing = f': {read.missing_joint}' if read.missing_joint else ''
            of = f' for {name}' if name else ''
            complain(f'{options.bag}: most messages on {rotor} were rejected{of}{missing}')
            code = ExitCode.FAILED
    return code


def _print_summary(out: Path, result: ComputeResult) -> None:
    inputs = result.inputs
    # Of an arm, a message without an actuator's joint is one for other actuators.
    states = max(rotor.received - rotor.of_others * ('' in inputs) for rotor in inputs.values())
    rejected = ', '.join(
        labelled(name, f'{cause} {number}')
        for name, rotor in inputs.items()
        for cause, number in rotor.rejected.items()
    )
    print(
        f'{out}: {result.computed} outputs for {states} rotor states'
        + (f' (rejected: {rejected})' if rejected else '')
        + f', {result.copied} other messages copied'
    )
    if result.left_out:
        print(printable(f'left out: {listed(result.left_out)}'))
    for name in inputs:
        for doubt in result.doubts[name]:
            complain(f'{out}: {labelled(name, str(doubt))}')
