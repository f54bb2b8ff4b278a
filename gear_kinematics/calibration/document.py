"""The report on a calibration as a document; docs/calibration.md describes its JSON."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from gear_kinematics.calibration.curves import panels
from gear_kinematics.calibration.result import Fit, Fitted, Residuals
from gear_kinematics.calibration.terms import OrderTerm, StopTerm, output_cycles
from gear_kinematics.lost_motion.document import plain
from gear_kinematics.lost_motion.remarks import ratio_remarks
from gear_kinematics.lost_motion.wording import (
    ARC_MINUTES,
    PERCENT,
    arc_minutes,
    plus_minus,
)
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
from gear_kinematics.state.uncertainty import COVERAGE

SCHEMA = 'gear_kinematics/calibration_report'
VERSION = 1
_MILLI = 1e3
_COLUMNS = 2
"""Panels side by side."""


def document(fit: Fit, target: str) -> Document:
    """Return the document on a calibration.

    Args:
        fit: the calibration.
        target: name of its file.
    """
    verdict = Verdict.PASS if fit.helps else Verdict.FAIL
    before, after = (number(rms * ARC_MINUTES) for rms in (fit.rms_before, fit.rms_after))
    finding = (
        f'The error falls from {before} to {after} arcmin rms in what was left out of the fit.'
        if fit.helps
        else f'No correction helps: with the best one the error is {after} arcmin rms instead of '
        f'{before} in what was left out of the fit, no more than by chance. Nothing is written.'
    )
    section = Section(
        printable(target),
        (_head(fit), _accuracy(fit), _terms(fit), _recordings(fit)),
        verdict,
        (Finding('finding', finding),),
        tuple(map(printable, remarks(fit))),
        Figure(tuple(panels(fit)), columns=_COLUMNS),
        picture_first=True,
    )
    return Document('gearkin calibrate', (section,), _data(fit), verdict)


def remarks(fit: Fit) -> Iterator[str]:
    """Yield the basis and the limits of the calibration, in sentences."""
    for r in fit.recordings:
        for remark in r.samples.recording.remarks:
            yield f'{r.samples.recording.name}: {remark}.'
    if fit.fitted_ratio:
        yield from ratio_remarks(fit.fitted_ratio)
    for name, cause in fit.refused.items():
        yield f'{name} is not fitted: {cause}.'
    for r in fit.recordings:
        delay = r.delay
        if r.delayed:
            yield (
                f'{r.samples.recording.name}: the stamps of the output are later than its angles '
                f'by {plus_minus(delay, _MILLI)} ms, or the gear winds up in proportion to its '
                'speed. This part of the error is left out, and not corrected.'
            )
        elif delay is None and r.samples.recording.separate:
            yield (
                f'{r.samples.recording.name}: a delay of the stamps of the output is not told '
                'from hysteresis; this takes three strokes or more.'
            )
    if not all(r.samples.recording.timed for r in fit.recordings):
        yield 'Time was not recorded: the interval does not depend on the speed.'
    yield (
        f'The interval of ± {number(fit.half_width * ARC_MINUTES)} arcmin contains {PERCENT} of '
        'the measured angles, relative to the zero of their recording. Each ± contains the value '
        f'with a probability of {PERCENT}, by leaving out one part of the recordings after the '
        'other.'
    )


def _head(fit: Fit) -> Table:
    samples = sum(len(r.after) for r in fit.recordings)
    teeth = fit.mechanism and f'{fit.mechanism.ring_teeth}/{fit.mechanism.satellite_teeth}'
    return Table.of_values(
        Layout.INLINE,
        ('gear ratio', str(fit.ratio)),
        ('teeth', teeth or ''),
        ('samples', str(samples)),
    )


def _accuracy(fit: Fit) -> Table:
    """Return the error of what was left out."""
    values = (
        ('rms before', fit.rms_before),
        ('rms after', fit.rms_after),
        ('half width of the interval', fit.half_width),
        ('half width outside the calibrated range', fit.outside_half_width),
    )
    rows = [
        (Cell(label, unit='arcmin'), Cell(number(value * ARC_MINUTES), unit='arcmin'))
        for label, value in values
    ]
    coverage = Cell(number(100.0 * fit.coverage), unit='%')
    rows.append((Cell('coverage of the interval', unit='%'), coverage))
    return Table(('left out of the fit', 'value'), tuple(rows))


def _terms(fit: Fit) -> Table:
    output = output_cycles(fit.ratio)

    def cycles(fitted: Fitted, unit: Fraction) -> str:
        return str(fitted.term.cycles / unit) if isinstance(fitted.term, OrderTerm) else ''

    return Table.of_items(
        {
            'term': lambda f: f.term.name,
            'amplitude [arcmin]': lambda f: arc_minutes(f.amplitude),
            'cycles per rotor turn': lambda f: cycles(f, Fraction(1)),
            'per output turn': lambda f: cycles(f, output),
            'likely cause': lambda f: f.term.cause,
        },
        fit.terms,
        ('', 'likely cause'),
    )


def _recordings(fit: Fit) -> Table:
    return Table.of_items(
        {
            'recording': lambda r: printable(r.samples.recording.name),
            'samples': lambda r: str(len(r.after)),
            'duration [s]': lambda r: number(r.samples.recording.duration, 4),
            'zero [rad]': lambda r: number(r.zero, 6),
            'delay [ms]': lambda r: plus_minus(r.delay, _MILLI),
        },
        fit.recordings,
    )


def _data(fit: Fit) -> dict[str, Any]:
    return {
        'schema': SCHEMA,
        'version': VERSION,
        'coverage': COVERAGE,
        'helps': fit.helps,
        'gear_ratio': str(fit.ratio),
        'fitted_ratio': plain(fit.fitted_ratio),
        'left_out': {
            'rms_before': fit.rms_before,
            'rms_after': fit.rms_after,
            'half_width': fit.half_width,
            'outside_half_width': fit.outside_half_width,
            'coverage': fit.coverage,
        },
        'terms': [_term(fitted) for fitted in fit.terms],
        'not_fitted': fit.refused,
        'recordings': [_recording(r) for r in fit.recordings],
        'remarks': list(remarks(fit)),
    }


def _term(fitted: Fitted) -> dict[str, Any]:
    term = fitted.term
    return {
        'name': term.name,
        'cycles': str(term.cycles) if isinstance(term, OrderTerm) else None,
        'radius': term.radius if isinstance(term, StopTerm) else None,
        'amplitude': plain(fitted.amplitude),
        'cause': term.cause,
    }


def _recording(residuals: Residuals) -> dict[str, Any]:
    recording = residuals.samples.recording
    return {
        'name': recording.name,
        'sha256': recording.sha256,
        'samples': len(residuals.after),
        'duration': recording.duration,
        'zero': residuals.zero,
        'delay': plain(residuals.delay),
    }
