"""`gearkin demo`: play the shipped bag into the live node."""

import argparse
from pathlib import Path

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import Console, warn_of_shared_memory
from gear_kinematics.report.document import Cell, Document, Section, Table, Tone
from gear_kinematics.report.text import render
from gear_kinematics.validation.report import BagReport


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        '--calibration',
        type=Path,
        metavar='FILE',
        help='of the gear, to show and validate the corrected output too',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """Show the outputs live, then the result of the validation."""
    warn_of_shared_memory(participants=2)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros import demo  # noqa: PLC0415

    console = Console()
    report = demo.run(console, options.calibration)
    render(_document(report, demo.TOLERANCE), console)
    return ExitCode.DONE if report.passed else ExitCode.FAILED


def _document(report: BagReport, tolerance: float) -> Document:
    rows = []
    for topic in report.topics:
        missing = Cell(str(topic.missing), Tone.BAD if topic.missing else Tone.PLAIN)
        for field in topic.fields:
            deviation = Cell(
                f'{field.max_error:.1e}', Tone.PLAIN if field.passed else Tone.BAD, field.unit
            )
            name = Cell(f'{topic.topic} {field.name}')
            rows.append((name, Cell(str(field.compared)), missing, deviation))
    columns = '', 'messages', 'missing', 'worst deviation'
    agree = 'all agree' if report.passed else 'they do not agree'
    remark = (
        f'{report.rotor.messages if report.rotor else 0} rotor states, and the outputs of the '
        f'node compared with the matrix method: {agree} to {tolerance:g} rad and {tolerance:g} of '
        'the eccentricity'
    )
    section = Section(
        report.bag, (Table(columns, tuple(rows)),), report.verdict, remarks=(remark,)
    )
    return Document('gearkin demo', (section,))
