# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin info`: list the contents of recordings."""

import argparse
from collections.abc import Iterator, Mapping

from rich.text import Text

from gear_kinematics.bag import Bag
from gear_kinematics.bag.finding import find_bags
from gear_kinematics.bag.roles import described
from gear_kinematics.bag.summary import Summary, summarise
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import Console, complain, message_progress
from gear_kinematics.measurement.rotor_fields import recorded_questions
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import counted, number, printable

_DIGITS = 4
_JOINTS = 4  # in the line


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bags', nargs='+', metavar='BAG', help='file, directory or glob')
    bags.add_rotor(parser, configured=False)
    arguments.add_config(
        parser,
        default='actuator.yaml beside a recording; its joints are examined',
        actuator='examine only the joint of this actuator in FILE (default: all)',
    )
    arguments.add_quiet(parser)
    arguments.add_verbose(parser, 'also list every topic with its type')


def run(options: argparse.Namespace) -> ExitCode:
    """Print a line on each recording, even if others cannot be read."""
    found = find_bags(options.bags)
    faults = list(found.faults.values())
    joints: dict[str, NodeParameters | None] = {options.joint: None} if options.joint else {}
    if options.config:
        configs = arguments.load_configs(options).values()
        joints = {config.rotor_joint: config for config in configs}
    for path in found.bags:
        try:
            with (
                bags.naming(path),
                Bag(path) as bag,
                message_progress(path.name, quiet=options.quiet) as progress,
            ):
                examined = joints or bags.joints_beside(path, options)
                summary = summarise(bag, options.rotor_topic, [*examined], progress)
                asked = [*_questions(bag, summary, examined)]
        except (ValueError, OSError) as error:
            faults.append(str(error))
            continue
        if summary.damage:
            faults.append(summary.damage)
        if not options.quiet:
            _print_summary(str(path), summary, asked, verbose=options.verbose)
    for fault in faults:
        complain(fault)
    return ExitCode.UNUSABLE if faults else ExitCode.DONE


def _questions(
    bag: Bag, summary: Summary, joints: Mapping[str, NodeParameters | None]
) -> Iterator[str]:
    """Yield what seems wrong in messages of the given joints, or else of a topic's only joint."""
    for topic in summary.topics:
        asked = joints or dict.fromkeys(topic.joints * (len(topic.joints) == 1))
        if topic.part != 'rotor' or not asked:
            continue
        for joint, question in recorded_questions(bag, topic.name, asked):
            name = f'{topic.name}: {joint}' if len(joints) > 1 else topic.name
            yield f'{name}: {question}'


def _print_summary(name: str, summary: Summary, asked: list[str], *, verbose: bool) -> None:
    console = Console()
    parts = [printable(part) for part in (*_parts(summary, verbose=verbose), *asked)]
    text = ('\n  ' if verbose else '; ').join(parts)
    console.print(Text(f'{printable(name)}: {text}'), soft_wrap=not console.is_terminal)


def _parts(summary: Summary, *, verbose: bool) -> Iterator[str]:
    messages = sum(topic.messages for topic in summary.topics)
    yield f'{summary.duration:.2f} s, {messages} messages'
    known = [topic for topic in summary.topics if topic.part]
    shown = summary.topics if verbose else known
    for topic in shown:
        often = counted(topic.messages, 'message')
        if topic.rate and topic.mean_rate:
            rate = f'{number(topic.rate, _DIGITS)} Hz'
            mean = f'{number(topic.mean_rate, _DIGITS)} Hz on average'
            of = f' of {topic.followed}' if topic.of_others else ''
            bursts = 10 * topic.gaps > topic.messages
            often = (
                f'{rate}, {mean}{of}, {often}' if verbose else f'{mean if bursts else rate}{of}'
            )
        joints = described(topic.joints, most=_JOINTS)
        kind = f' {topic.type},' if verbose else ''
        yield f'{topic.part} {topic.name}{joints}{kind} {often}'.lstrip()
        if topic.of_others:
            verb = 'is' if topic.of_others == 1 else 'are'
            these = counted(topic.of_others, 'message')
            yield f'{these} on {topic.name} {verb} of other joints'
        if topic.malformed:
            of = f'{topic.malformed} of {counted(topic.messages, "message")} on {topic.name}'
            way = 'rosbags-convert --dst-typestore ros2_jazzy converts bags of ROS 1'
            yield f'{of} cannot be read as JointState of ROS 2; {way}'
    if summary.unclear:
        yield summary.unclear
    if others := len(summary.topics) - len(shown):
        yield counted(others, 'other topic')
    gaps = [topic for topic in known if topic.gaps]
    for topic in gaps:
        yield f'{counted(topic.gaps, "gap")} on {topic.name}, up to {topic.longest_gap:.3g} s'
    if any(topic.messages > topic.malformed for topic in known) and not gaps:
        yield 'no gaps'
