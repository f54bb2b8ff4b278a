# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The reports on a calibration and on its check; docs/calibration.md describes their JSON."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from gear_kinematics.measurement.calibration.check import Judgement
from gear_kinematics.measurement.calibration.fit import LEAST_COVERAGE, Fit
from gear_kinematics.measurement.envelope import envelope
from gear_kinematics.measurement.recording import Array
from gear_kinematics.measurement.wording import (
    ARC_MINUTES,
    PERCENT,
    arc_minutes,
    plain,
    plus_minus,
)
from gear_kinematics.report.document import (
    Cell,
    Document,
    Figure,
    Layout,
    Line,
    Panel,
    Pen,
    Section,
    Sentence,
    Table,
    Verdict,
    number,
    printable,
)
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate

_MILLI = 1e3


def document(fit: Fit, target: str) -> Document:
    """Return the document on a calibration, whose file is the target."""
    made, errors = fit.calibration, fit.calibration.validation
    verdict = Verdict.PASS if fit.helps else Verdict.FAIL
    before, after = map(_arc_minutes, (errors.rms_before, errors.rms_after))
    within = f'{100.0 * errors.coverage:.1f} % of it within the {PERCENT} interval'
    finding = (
        f'The error falls from {before} to {after} arcmin rms on held-out data, {within} of '
        f'± {_arc_minutes(made.half_width)} arcmin. The node takes the file as its parameter '
        'calibration.'
        if fit.helps
        else f'The error falls from {before} to {after} arcmin rms on held-out data, but only '
        f'{within}, which is too narrow. Nothing is written; record more turns of the output, '
        'in both directions.'
        if errors.coverage < LEAST_COVERAGE and errors.rms_after < errors.rms_before
        else f'No correction helps: with the best one the error is {after} arcmin rms instead of '
        f'{before} on held-out data, {within}. Nothing is written.'
    )
    terms = Table.of_items(
        {
            'term': lambda term: term.name,
            'amplitude [arcmin]': lambda term: arc_minutes(term.amplitude),
            'cycles per rotor turn': lambda term: str(term.cycles or ''),
            'likely cause': lambda term: term.cause,
        },
        fit.terms,
        ('', 'likely cause'),
    )
    sentences = list(_remarks(fit))
    section = Section(
        printable(target),
        (terms,),
        verdict,
        (Sentence('finding', finding),),
        tuple(map(printable, sentences)),
        _figure(made.half_width, fit.output, fit.before, fit.after),
    )
    widths = {'half_width': made.half_width, 'outside_half_width': made.outside_half_width}
    data = {
        'schema': 'gear_kinematics/calibration_report',
        'version': 1,
        'coverage': COVERAGE,
        'helps': fit.helps,
        'gear_ratio': str(made.gear_ratio),
        'left_out': plain(errors) | widths,
        'terms': plain(fit.terms),
        'not_fitted': fit.refused,
        'recordings': [plain(r.used) | {'delay': plain(r.delay)} for r in fit.recordings],
        'remarks': sentences,
    }
    return Document('gearkin calibrate', (section,), data, verdict)


def _remarks(fit: Fit) -> Iterator[str]:
    """Yield the basis and the limits of the calibration, in sentences."""
    for r in fit.recordings:
        yield from (f'{r.used.name}: {text}' for text in r.remarks)
        if r.delay and r.delay.clear:
            yield f'{r.used.name}: {_late(r.delay)}'
    for name, cause in fit.refused.items():
        yield f'{name} is not fitted: {cause}.'


def _late(delay: Estimate) -> str:
    return (
        f'the output angles are later than the rotor angles by {plus_minus(delay, _MILLI)} ms, or '
        'the gear winds up in proportion to its speed. This part of the error is left out.'
    )


def _arc_minutes(angle: float) -> str:
    return number(angle * ARC_MINUTES)


def _figure(half_width: float, angle: Array, before: Array, after: Array) -> Figure:
    """Draw errors before and after, rad, over the output angle, rad, with the interval."""
    width = half_width * ARC_MINUTES
    lines = [
        Line(name, pen, *envelope(np.degrees(angle), error * ARC_MINUTES))
        for name, pen, error in (('before', Pen.FAINT, before), ('after', Pen.FIRST, after))
    ]
    panel = Panel(
        'error over the output angle, of samples that were not fitted',
        'output angle [°]',
        'measured less expected [arcmin]',
        tuple(lines),
        levels=((-width, ''), (width, '')),
    )
    return Figure((panel,))


def check_document(path: Path, half_width: float, judgements: Sequence[Judgement]) -> Document:
    """Return the document on a calibration file, with a section for each recording.

    The half width of its interval is in rad.
    """
    data = {
        'schema': 'gear_kinematics/calibration_check',
        'version': 1,
        'calibration': str(path),
        'recordings': plain(judgements),
    }
    return Document(
        f'gearkin calibrate --check {printable(path.name)}',
        tuple(_section(half_width, one) for one in judgements),
        data,
        Verdict.PASS if all(one.holds for one in judgements) else Verdict.FAIL,
    )


def _section(half_width: float, judged: Judgement) -> Section:
    before, after = _arc_minutes(judged.rms_before), _arc_minutes(judged.rms_after)
    inside = 100.0 * judged.within_interval
    spread = 100.0 * judged.within_interval_uncertainty
    if judged.fits:
        finding = (
            f'The calibration {"holds" if judged.holds else "does not help"}: {inside:.1f} ± '
            f'{spread:.1f} % of the measured angles are within the {PERCENT} interval; it changes '
            f'the error from {before} to {after} arcmin rms.'
        )
    else:
        left = f'{after}′ rms'
        if judged.left_order:
            size, often = judged.left_order
            left = f'{_arc_minutes(size)}′ {often}'
        finding = (
            f'The calibration no longer holds: {inside:.1f} % instead of {PERCENT} lie within the '
            f'interval; what is left: {left}. Calibrate the gear again.'
        )
    delay = plus_minus(judged.delay, _MILLI)
    values = (
        ('delay of the output', delay, 'ms'),
        ('wider for what was not calibrated', number(100.0 * judged.uncalibrated), '% of samples'),
    )
    cells = [(name, Cell(value, unit=unit)) for name, value, unit in values]
    return Section(
        printable(judged.name),
        (Table.of_values(Layout.LINES, *cells),),
        Verdict.PASS if judged.holds else Verdict.FAIL,
        (Sentence('finding', finding),),
        tuple(map(printable, judged.remarks)),
        _figure(half_width, judged.output, judged.before, judged.after),
    )
