# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin calibrate`: a calibration file from recordings of both encoders."""

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.encoders import add_recordings, say_columns, sources
from gear_kinematics.commands.files import write_text
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.measurement.calibration import fit, judge
from gear_kinematics.measurement.calibration.document import check_document, document
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import Recording, RecordingError
from gear_kinematics.parameters import NodeParameters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_recordings(parser, 'rotor', 'output', 'torque')
    output = arguments.group(parser, 'output')
    text = 'calibration to write (default: %(default)s); it replaces only a calibration'
    output.add_argument('-o', '--output', default='calibration.yaml', metavar='FILE', help=text)
    text = 'judge this calibration by other recordings, and write none'
    output.add_argument('--check', type=Path, metavar='FILE', help=text)
    arguments.add_verbose(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Calibrate with all recordings together, or judge a calibration by each."""
    others = {} if options.check else {'-o': options.output}
    sections = len(options.recordings) if options.check else 1
    reporter = Reporter(options, sections, others)
    # All recordings are of one gear, so one configuration applies to all.
    config = arguments.load_config(options, options.recordings[0])
    if options.check:
        return _check(options, config, reporter)
    gear = config.gear
    recordings = list(_read(options, config))
    if len(recordings) < len(options.recordings):
        return ExitCode.UNUSABLE
    mechanism = gear if isinstance(gear, Mechanism) else None
    result = fit(recordings, gear.gear_ratio, mechanism)
    for recording in recordings:
        say_columns(recording, options)
    if result.helps:
        write_text(options.output, result.calibration.text())
    return reporter.write(
        document(result, options.output), [arguments.config_path(options, options.recordings[0])]
    )


def _check(options: argparse.Namespace, config: NodeParameters, reporter: Reporter) -> ExitCode:
    calibration = Calibration.load(options.check)
    config = replace(config, gear_ratio=str(calibration.gear_ratio))
    judgements = []
    for recording in _read(options, config):
        try:
            judgements.append(judge(recording, calibration))
            say_columns(recording, options)
        except RecordingError as error:
            complain(error)
    code = ExitCode.DONE
    if judgements:
        report = check_document(options.check, calibration.half_width, judgements)
        code = reporter.write(report, [arguments.config_path(options, options.recordings[0])])
    return code if len(judgements) == len(options.recordings) else ExitCode.UNUSABLE


def _read(options: argparse.Namespace, config: NodeParameters) -> Iterator[Recording]:
    """Read the recordings, and report those that cannot be read."""
    for path in options.recordings:
        try:
            with bags.naming(path), message_progress(path.name, quiet=options.quiet) as progress:
                yield read(path, config, sources(options), progress, both=True)
        except (ValueError, OSError) as error:
            complain(error)
