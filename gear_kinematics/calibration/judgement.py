"""Judges a calibration by recordings that it was not made from."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gear_kinematics.calibration.curves import error_panel
from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.recording import Recording
from gear_kinematics.lost_motion.wording import ARC_MINUTES, PERCENT
from gear_kinematics.report.document import (
    Cell,
    Document,
    Figure,
    Finding,
    Layout,
    Section,
    Table,
    Verdict,
    number,
    printable,
)
from gear_kinematics.state.calibrated_output import CalibrationFit
from gear_kinematics.state.calibration_file import Calibration
from gear_kinematics.state.correction import Corrector

SCHEMA = 'gear_kinematics/calibration_check'
VERSION = 1


@dataclass(frozen=True, eq=False, slots=True)
class Judgement:
    """A calibration compared with a recording; arrays are (n,), of the measured angles."""

    recording: Recording
    output: Array
    """Ideal output angle, rad."""
    before: Array
    """Measured minus ideal output angle less its mean, rad."""
    after: Array
    """Measured minus corrected output angle less its mean, rad."""
    half_width: Array
    """rad, of the interval."""
    uncalibrated: float
    """Share of samples in conditions that were not calibrated, or with an unknown history."""
    fit: CalibrationFit

    @property
    def rms_before(self) -> float:
        """rad."""
        return float(np.std(self.before))

    @property
    def rms_after(self) -> float:
        """rad."""
        return float(np.std(self.after))

    @property
    def holds(self) -> bool:
        """Whether the error is less with the correction, and within its interval."""
        return self.rms_after < self.rms_before and self.fit.fits


def judge(recording: Recording, calibration: Calibration) -> Judgement:
    """Correct the output of a recording as the node does, and compare it with the measured one."""
    rotor, ratio = recording.rotor, calibration.gear_ratio
    if not recording.timed:
        calibration = replace(calibration, spans=replace(calibration.spans, speed=None))
    count = len(rotor.turns)
    unknown, unbroken = np.full(count, np.nan), np.zeros(count, np.int64)
    correction = Corrector(calibration).correct_batch(
        rotor.stamp,
        rotor.turns,
        rotor.angle,
        unknown,
        unknown if rotor.effort is None else rotor.effort,
        unbroken if rotor.stretch is None else rotor.stretch,
    )
    error = recording.error(ratio)
    residual = error - recording.at_measured(correction.deviation)
    half_width = recording.at_measured(correction.half_width)
    return Judgement(
        recording,
        recording.at_measured(recording.ideal(ratio)),
        error - error.mean(),
        residual - residual.mean(),
        half_width,
        float(np.mean(half_width > calibration.half_width)),
        CalibrationFit.of(error, residual, half_width),
    )


def document(path: Path, judgements: Sequence[Judgement]) -> Document:
    """Return the document on a calibration file, with a section for each recording."""
    sections = tuple(map(_section, judgements))
    return Document(
        f'gearkin calibrate --check {printable(path.name)}',
        sections,
        {
            'schema': SCHEMA,
            'version': VERSION,
            'calibration': str(path),
            'recordings': [
                {
                    'name': judgement.recording.name,
                    'holds': judgement.holds,
                    'rms_before': judgement.rms_before,
                    'rms_after': judgement.rms_after,
                    'within_interval': 1.0 - judgement.fit.outside,
                    'uncalibrated': judgement.uncalibrated,
                    'samples': judgement.fit.samples,
                }
                for judgement in judgements
            ],
        },
        Verdict.PASS if all(judgement.holds for judgement in judgements) else Verdict.FAIL,
        Table.of_items(
            {
                'recording': lambda j: printable(j.recording.name),
                'rms before [arcmin]': lambda j: number(j.rms_before * ARC_MINUTES),
                'rms after [arcmin]': lambda j: number(j.rms_after * ARC_MINUTES),
                'within the interval [%]': lambda j: number(100.0 * (1.0 - j.fit.outside)),
            },
            judgements,
        ),
    )


def _section(judgement: Judgement) -> Section:
    recording = judgement.recording
    before, after = (
        number(rms * ARC_MINUTES) for rms in (judgement.rms_before, judgement.rms_after)
    )
    inside = f'{number(100.0 * (1.0 - judgement.fit.outside))} %'
    finding = (
        f'The correction changes the error from {before} to {after} arcmin rms; {inside} of the '
        f'measured angles are within the {PERCENT} interval.'
    )
    lines = {'before': judgement.before, 'after': judgement.after}
    time = 'time [s]' if recording.timed else 'sample'
    width = float(np.median(judgement.half_width))
    interval = number(width * ARC_MINUTES)
    return Section(
        printable(recording.name),
        (
            Table.of_values(
                Layout.LINES,
                ('rms before', Cell(before, unit='arcmin')),
                ('rms after', Cell(after, unit='arcmin')),
                (
                    'median half width of the interval',
                    Cell(interval, unit='arcmin'),
                ),
                ('within the interval', inside),
                (
                    'wider for what was not calibrated',
                    Cell(number(100.0 * judgement.uncalibrated), unit='% of the samples'),
                ),
                ('samples', str(judgement.fit.samples)),
            ),
        ),
        Verdict.PASS if judgement.holds else Verdict.FAIL,
        (Finding('finding', finding),),
        tuple(printable(f'{remark}.') for remark in recording.remarks),
        Figure(
            (
                error_panel('error', time, recording.seconds, lines, width),
                error_panel(
                    'error over the output angle',
                    'output angle [°]',
                    np.degrees(judgement.output),
                    lines,
                    width,
                ),
            )
        ),
    )
