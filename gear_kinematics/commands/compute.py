"""`gearkin compute`: add the outputs to a bag that has only the rotor topic."""

import argparse
from pathlib import Path

from gear_kinematics.bag import Bag, TopicError, listed
from gear_kinematics.bag.roles import Topics, find_rotor_topic
from gear_kinematics.commands import ExitCode, arguments, calibrations
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.report.document import printable
from gear_kinematics.state.compute import compute

HELP = 'write a bag with the outputs for a recorded rotor topic'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_config(parser)
    arguments.add_topics(parser)
    calibrations.add_option(parser)
    parser.add_argument('bag', type=Path, metavar='BAG')
    parser.add_argument('out', type=Path, metavar='OUT', help='folder to create')
    parser.add_argument(
        '--topics', nargs='*', metavar='NAME', help='other topics to copy (default: all)'
    )
    parser.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap')
    parser.add_argument('--compression', choices=('none', 'zstd'), default='none')


def run(options: argparse.Namespace) -> ExitCode:
    """Write the bag and print the number of its messages."""
    config = arguments.load_config(options, options.bag)
    with Bag(options.bag) as bag, message_progress(options.bag.name) as progress:
        rotor = options.rotor_topic or find_rotor_topic(bag)
        beside = Topics.beside(rotor)
        try:
            result = compute(
                bag,
                options.out,
                config,
                rotor_topic=rotor,
                output_topic=options.output_topic or beside.output,
                poses_topic=options.poses_topic or beside.poses,
                calibration=calibrations.load(options, config, options.bag),
                topics=options.topics,
                storage=options.storage,
                compression=options.compression,
                progress=progress,
            )
        except TopicError as error:
            raise TopicError(f'{error}; --topics says which topics to copy') from error
    rejected = ', '.join(f'{cause} {number}' for cause, number in result.rejected.items())
    print(
        f'{options.out}: {result.computed} outputs for {result.received} rotor states'
        + (f' (rejected: {rejected})' if rejected else '')
        + f', {result.copied} other messages copied'
    )
    if result.left_out:
        print(printable(f'left out: {listed(result.left_out)}'))
    if result.undefined:
        print(printable(f'copied without a definition of the type: {listed(result.undefined)}'))
    if result.mostly_rejected:
        complain(f'{options.bag}: most messages on {rotor} were rejected')
        return ExitCode.FAILED
    return ExitCode.DONE
