# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin compute`: add the outputs to a bag that has only the rotor topic."""

import argparse
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag import Bag
from gear_kinematics.bag.roles import (
    find_encoder_topic,
    find_rotor_topic,
    only_joint,
    outputs_of,
)
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.report.document import printable
from gear_kinematics.validation.compute import ComputeResult, compute
from gear_kinematics.wire.nearest import listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('bag', type=Path, metavar='BAG')
    parser.add_argument('out', type=Path, metavar='OUT', help='folder to create')
    bags.add_rotor(parser)
    arguments.add_config(parser)
    bags.add_calibration(parser)
    output = arguments.group(parser, 'output')
    output.add_argument(
        '--topics', nargs='*', metavar='NAME', help='other topics to copy (default: all)'
    )
    output.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap')
    output.add_argument('--compression', choices=('none', 'zstd'), default='none')
    arguments.add_quiet(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Write the bag and its parameters, and print the number of its messages."""
    config = arguments.load_config(options, options.bag)
    calibration = bags.load_calibration(options, config, options.bag)
    with (
        bags.naming(options.bag, options.out),
        Bag(options.bag) as bag,
        message_progress(options.bag.name, quiet=options.quiet) as progress,
    ):
        rotor = options.rotor_topic or find_rotor_topic(bag, joint=config.rotor_joint)
        taken = config.rotor_joint
        if options.joint is None and taken:
            taken = only_joint(bag, rotor, taken)
        used = replace(config, rotor_joint=taken)
        result = compute(
            bag,
            options.out,
            used,
            topics=outputs_of(bag, rotor),
            encoder_topic=find_encoder_topic(bag, rotor) if config.absolute else '',
            calibration=calibration,
            others=options.topics,
            files=bags.files_of(options, used, options.bag),
            storage=options.storage,
            compression=options.compression,
            progress=progress,
        )
    if not options.quiet:
        _print_summary(options.out, result)
        if taken != config.rotor_joint:
            print(printable(f'{taken}, the only joint on {rotor}, is taken'))
    if result.rotor_input.mostly_rejected:
        missing = result.rotor_input.missing_joint
        joints = f': {missing}' if missing else ''
        complain(f'{options.bag}: most messages on {rotor} were rejected{joints}')
        return ExitCode.FAILED
    return ExitCode.DONE


def _print_summary(out: Path, result: ComputeResult) -> None:
    rotor = result.rotor_input
    rejected = ', '.join(f'{cause} {number}' for cause, number in rotor.rejected.items())
    print(
        f'{out}: {result.computed} outputs for {rotor.received - rotor.of_others} rotor states'
        + (f' (rejected: {rejected})' if rejected else '')
        + f', {result.copied} other messages copied'
    )
    if result.left_out:
        print(printable(f'left out: {listed(result.left_out)}'))
    doubts = (
        rotor.plausibility.jumped,
        rotor.velocity_field.meaning,
        'the effort is 0 throughout the motion, and left out' if rotor.effort_field.absent else '',
        '' if rotor.referenced else 'the turns of the rotor are not known at the end',
    )
    for doubt in filter(None, doubts):
        complain(f'{out}: {doubt}')
