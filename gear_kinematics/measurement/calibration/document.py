# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reports on a calibration and on its check; docs/calibration.md describes their JSON."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from gear_kinematics.measurement.calibration.check import Judgement
from gear_kinematics.measurement.calibration.fit import Fit, interval_holds
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import number, printable
from gear_kinematics.statistics.uncertainty import COVERAGE


def document(fit: Fit, target: str) -> doc.Document:
    """Return the document on a calibration whose file is `target`."""
    made, errors = fit.calibration, fit.calibration.validation
    if fit.helps:
        what = Observation.ERROR_FALLS
    elif errors.rms_after < errors.rms_before and not interval_holds(made):
        what = Observation.TOO_NARROW
    else:
        what = Observation.NO_CORRECTION
    finding = fit.moved or what(
        before=errors.rms_before,
        after=errors.rms_after,
        inside=100.0 * errors.coverage,
        half_width=made.half_width,
    )
    terms = doc.Table.of_items(
        {
            'term': lambda term: term.name,
            'amplitude [arcmin]': lambda term: plus_minus(term.amplitude, ARC_MINUTES),
            'cycles per rotor turn': lambda term: str(term.cycles or ''),
            'likely cause': lambda term: term.cause,
        },
        fit.terms,
        ('', 'likely cause'),
    )
    sentences = [*map(str, _remarks(fit))]
    section = doc.Section(
        printable(target),
        (terms,),
        doc.Verdict.PASS if fit.helps else doc.Verdict.FAIL,
        (doc.Sentence('finding', str(finding)),),
        tuple(map(printable, sentences)),
        _figure(made.half_width, fit),
    )
    widths = {'half_width': made.half_width, 'outside_half_width': made.outside_half_width}
    data = {
        'schema': 'gear_kinematics/calibration_report',
        'version': 1,
        'coverage': COVERAGE,
        'helps': fit.helps,
        'moved': fit.moved,
        'gear_ratio': str(made.gear_ratio),
        'left_out': asdict(errors) | widths,
        'terms': fit.terms,
        'not_fitted': fit.refused,
        'recordings': [
            asdict(used) | {'delay': delay}
            for used, delay in zip(made.recordings, fit.delays, strict=True)
        ],
        'remarks': sentences,
    }
    return doc.Document('gearkin calibrate', (section,), data)


def _remarks(fit: Fit) -> Iterator[str | Observed]:
    """Yield what the calibration is based on, and what limits it."""
    for recording, delay in zip(fit.recordings, fit.delays, strict=True):
        yield from (f'{recording.name}: {text}' for text in recording.sentences)
        if delay and delay.clear:
            yield Observation.OUTPUT_LATE(recording=recording.name, delay=delay)
    for name, cause in fit.refused.items():
        yield Observation.NOT_FITTED(term=name, cause=cause)


def _figure(half_width: float, result: Fit | Judgement) -> doc.Figure:
    """Draw the errors over the output angle, and the interval, whose half width is in rad."""
    width, angle = half_width * ARC_MINUTES, np.degrees(result.output)
    lines = [
        doc.Line.reduced('before', doc.Pen.FAINT, angle, result.before * ARC_MINUTES),
        doc.Line.reduced('after', doc.Pen.FIRST, angle, result.after * ARC_MINUTES),
    ]
    panel = doc.Panel(
        'error over the output angle, of samples that were not fitted',
        'output angle [°]',
        'measured less expected [arcmin]',
        tuple(lines),
        levels=((-width, ''), (width, '')),
    )
    return doc.Figure((panel,))


def check_document(path: Path, half_width: float, judgements: Sequence[Judgement]) -> doc.Document:
    """Return the document on a check, with a section for each recording.

    The half width of the calibration's interval is in rad.
    """
    data = {
        'schema': 'gear_kinematics/calibration_check',
        'version': 1,
        'calibration': str(path),
        'recordings': judgements,
    }
    return doc.Document(
        f'gearkin calibrate --check {printable(path.name)}',
        tuple(_section(half_width, one) for one in judgements),
        data,
    )


def _section(half_width: float, judged: Judgement) -> doc.Section:
    inside = 100.0 * judged.within_interval
    if judged.fits:
        finding = (Observation.HOLDS if judged.holds else Observation.DOES_NOT_HELP)(
            inside=inside,
            spread=100.0 * judged.within_interval_uncertainty,
            before=judged.rms_before,
            after=judged.rms_after,
        )
    else:
        left, often = judged.left_order or (judged.rms_after, 'rms')
        finding = Observation.NO_LONGER_HOLDS(inside=inside, left=left, often=often)
    delay = plus_minus(judged.delay, 1e3)
    values = (
        ('delay of the output', delay, 'ms'),
        ('with a wider interval', number(100.0 * judged.uncalibrated), '% of samples'),
    )
    cells = [(name, doc.Cell(value, unit=unit)) for name, value, unit in values]
    return doc.Section(
        printable(judged.name),
        (doc.Table.of_values(doc.Layout.LINES, *cells),),
        doc.Verdict.PASS if judged.holds else doc.Verdict.FAIL,
        (doc.Sentence('finding', str(finding)),),
        tuple(map(printable, judged.remarks)),
        _figure(half_width, judged),
    )
