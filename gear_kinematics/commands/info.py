# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin info`: what is in recordings."""

import argparse
from collections.abc import Callable, Iterator, Mapping

from rich.text import Text

from gear_kinematics.bag import Bag
from gear_kinematics.bag.finding import find_bags
from gear_kinematics.bag.roles import described
from gear_kinematics.bag.summary import Summary, TopicSummary, summarise
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import Console, complain, message_progress
from gear_kinematics.report.document import (
    Cell,
    Document,
    Section,
    Table,
    counted,
    number,
    printable,
)
from gear_kinematics.report.text import render
from gear_kinematics.wire.nearest import listed

_DIGITS = 4
_JOINTS = 4  # in the line


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('bags', nargs='+', metavar='BAG', help='file, directory or glob')
    bags.add_rotor(parser, configured=False)
    arguments.add_quiet(parser)
    arguments.add_verbose(parser, 'also list every topic with its type')


def run(options: argparse.Namespace) -> ExitCode:
    """Print a line on each recording, even if others cannot be read."""
    found = find_bags(options.bags)
    faults = list(found.faults.values())
    for path in found.bags:
        try:
            with Bag(path) as bag, message_progress(path.name, quiet=options.quiet) as progress:
                summary = summarise(bag, options.rotor_topic, options.joint or '', progress)
        except (ValueError, OSError) as error:
            faults.append(str(error))
            continue
        if summary.damage:
            faults.append(summary.damage)
        if not options.quiet:
            _print_summary(str(path), summary, verbose=options.verbose)
    for fault in faults:
        complain(fault)
    return ExitCode.UNUSABLE if faults else ExitCode.DONE


def _print_summary(name: str, summary: Summary, *, verbose: bool) -> None:
    console = Console()
    line = Text(printable(f'{name}: {"; ".join(_parts_of_line(summary))}'))
    console.print(line, soft_wrap=not console.is_terminal)
    if verbose:
        table = Table.of_items(_TOPIC, summary.topics, words=('', 'part', 'joints', 'type'))
        render(Document('gearkin info', (Section(printable(name), (table,)),)), console)


def _parts_of_line(summary: Summary) -> Iterator[str]:
    yield f'{summary.duration:.2f} s, {summary.messages} messages'
    known = [topic for topic in summary.topics if topic.part not in {'', 'node'}]
    for topic in known:
        joints = described(topic.joints, most=_JOINTS)
        yield f'{topic.part} {topic.name}{joints} {_rate(topic)}'
    if summary.unclear:
        yield summary.unclear
    if others := len(summary.topics) - len(known):
        yield counted(others, 'other topic')
    gaps = [topic for topic in known if topic.gaps]
    for topic in gaps:
        yield f'{counted(topic.gaps, "gap")} on {topic.name}, up to {topic.longest_gap:.3g} s'
    if known and not gaps:
        yield 'no gaps'


def _rate(topic: TopicSummary) -> str:
    if topic.rate is None:
        return counted(topic.messages, 'message')
    return f'{number(topic.rate, _DIGITS)} Hz'


_TOPIC: Mapping[str, Callable[[TopicSummary], str | Cell]] = {
    'topic': lambda topic: printable(topic.name),
    'part': lambda topic: topic.part,
    'messages': lambda topic: str(topic.messages),
    'rate': lambda topic: Cell(number(topic.rate, _DIGITS) if topic.rate else '', unit='Hz'),
    'gaps': lambda topic: str(topic.gaps),
    'longest': lambda topic: Cell(number(topic.longest_gap) if topic.gaps else '', unit='s'),
    'joints': lambda topic: listed(topic.joints),
    'type': lambda topic: printable(topic.type.rpartition('/')[2]),
}
"""Columns of the table of topics."""
