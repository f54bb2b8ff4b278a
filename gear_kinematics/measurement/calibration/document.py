# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The reports on a calibration and on its check; docs/calibration.md describes their JSON."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from gear_kinematics.correction.uncertainty import COVERAGE
from gear_kinematics.measurement.calibration.check import Judgement, left_order
from gear_kinematics.measurement.calibration.result import Fit
from gear_kinematics.measurement.calibration.terms import output_cycles
from gear_kinematics.measurement.curves import spectrum_panel
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
    Finding,
    Layout,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Verdict,
    number,
    printable,
)

_MILLI = 1e3
_PENS = {'before': Pen.FAINT, 'after': Pen.FIRST}


def document(fit: Fit, target: str) -> Document:
    """Return the document on a calibration, whose file is the target."""
    made = fit.calibration
    verdict = Verdict.PASS if fit.helps else Verdict.FAIL
    before, after = map(_arc_minutes, (made.validation.rms_before, made.validation.rms_after))
    finding = (
        f'The error falls from {before} to {after} arcmin rms in what was left out of the fit. '
        'The node takes the file as its parameter calibration.'
        if fit.helps
        else f'No correction helps: with the best one the error is {after} arcmin rms instead of '
        f'{before} in what was left out of the fit, no more than by chance. Nothing is written.'
    )
    sentences = list(remarks(fit))
    section = Section(
        printable(target),
        tuple(_tables(fit)),
        verdict,
        (Finding('finding', finding),),
        tuple(map(printable, sentences)),
        Figure(tuple(_panels(fit)), columns=2),
    )
    widths = {'half_width': made.half_width, 'outside_half_width': made.outside_half_width}
    data = {
        'schema': 'gear_kinematics/calibration_report',
        'version': 1,
        'coverage': COVERAGE,
        'helps': fit.helps,
        'gear_ratio': str(made.gear_ratio),
        'left_out': plain(made.validation) | widths,
        'terms': [
            {
                'name': term.name,
                'cycles': plain(term.cycles or None),
                'radius': getattr(entry, 'radius', None),
                'amplitude': plain(amplitude),
                'cause': term.cause,
            }
            for term, entry, amplitude in fit.terms
        ],
        'not_fitted': fit.refused,
        'recordings': [
            {
                'name': r.samples.recording.name,
                'sha256': r.samples.recording.sha256,
                'samples': len(r.after),
                'duration': r.samples.encoders.duration,
                'zero': r.zero,
                'delay': plain(r.delay),
            }
            for r in fit.recordings
        ],
        'remarks': sentences,
    }
    return Document('gearkin calibrate', (section,), data, verdict)


def remarks(fit: Fit) -> Iterator[str]:
    """Yield the basis and the limits of the calibration, in sentences."""
    timed = fit.calibration.spans.speed is not None
    for r in fit.recordings:
        recording = r.samples.recording
        yield from (f'{recording.name}: {text}' for text in recording.sentences)
    for name, cause in fit.refused.items():
        yield f'{name} is not fitted: {cause}.'
    for r in fit.recordings:
        name = r.samples.recording.name
        if r.delay and r.delay.clear:
            yield (
                f'{name}: the output angles are later than the rotor angles by '
                f'{plus_minus(r.delay, _MILLI)} ms, or the gear winds up in proportion to its '
                'speed. This part of the error is left out, and not corrected.'
            )
        elif r.delay is None and timed:
            yield (
                f'{name}: a delay of the output angles is not told from hysteresis; this takes '
                'three strokes or more.'
            )
    if not timed:
        yield (
            'Time was not recorded: the interval does not depend on the speed, and a delay '
            'between the encoders is not told from hysteresis.'
        )
    yield (
        f'The interval of ± {_arc_minutes(fit.calibration.half_width)} arcmin contains {PERCENT} '
        'of the measured angles of another recording, relative to its zero and less its delay. '
        f'Each ± contains the value with a probability of {PERCENT}, by leaving out one part of '
        'the recordings after the other.'
    )


def _arc_minutes(angle: float) -> str:
    return number(angle * ARC_MINUTES)


def _tables(fit: Fit) -> Iterator[Table]:
    made, errors = fit.calibration, fit.calibration.validation
    teeth = f'{made.ring_teeth}/{made.satellite_teeth}' if made.ring_teeth else ''
    samples = str(sum(len(r.after) for r in fit.recordings))
    head = ('gear ratio', str(made.gear_ratio)), ('teeth', teeth), ('samples', samples)
    yield Table.of_values(Layout.INLINE, *head)
    rows = (
        ('rms before', errors.rms_before),
        ('rms after', errors.rms_after),
        ('half width of the interval', made.half_width),
        ('half width outside the calibrated range', made.outside_half_width),
    )
    shown = [(name, _arc_minutes(value), 'arcmin') for name, value in rows]
    shown.append(('coverage of the interval', number(100.0 * errors.coverage), '%'))
    yield Table(
        ('left out of the fit', 'value'),
        tuple((Cell(name, unit=unit), Cell(value, unit=unit)) for name, value, unit in shown),
    )
    output = output_cycles(made.gear_ratio)
    yield Table.of_items(
        {
            'term': lambda f: f.term.name,
            'amplitude [arcmin]': lambda f: arc_minutes(f.amplitude),
            'cycles per rotor turn': lambda f: str(f.term.cycles or ''),
            'per output turn': lambda f: str(f.term.cycles / output) if f.term.cycles else '',
            'likely cause': lambda f: f.term.cause,
        },
        fit.terms,
        ('', 'likely cause'),
    )
    yield Table.of_items(
        {
            'recording': lambda r: printable(r.samples.recording.name),
            'samples': lambda r: str(len(r.after)),
            'duration [s]': lambda r: number(r.samples.encoders.duration, 4),
            'zero [rad]': lambda r: number(r.zero, 6),
            'delay [ms]': lambda r: plus_minus(r.delay, _MILLI),
        },
        fit.recordings,
    )


def _panels(fit: Fit) -> Iterator[Panel]:
    """Yield the error before and after the correction, over time, output angle and orders."""
    end, parts = 0.0, []
    for s, before, after, *_ in fit.recordings:
        parts.append((end + s.seconds[s.used], s.output[s.used], before, after))
        end += s.seconds[-1]
    columns = map(np.concatenate, zip(*parts, strict=True))
    made = fit.calibration
    yield from _error_panels(made.half_width, *columns, timed=made.spans.speed is not None)
    spectra = [
        (name, pen, spectrum.cycles[shown], spectrum.amplitude[shown])
        for (name, pen), spectrum in zip(_PENS.items(), fit.spectra, strict=True)
        if spectrum
        for shown in [spectrum.cycles >= spectrum.resolution]
    ]
    orders = [(float(f.term.cycles), f.term.name) for f in fit.terms if f.term.cycles]
    yield from spectrum_panel('rotor', spectra, orders, decades=3)


def _error_panels(
    half_width: float, time: Array, angle: Array, *errors: Array, timed: bool
) -> Iterator[Panel]:
    """Draw errors before and after, rad, over time and output angle, with the interval."""
    width = half_width * ARC_MINUTES
    for title, label, at in (
        ('error of samples left out', 'time [s]' if timed else 'sample', time),
        ('error over the output angle', 'output angle [°]', np.degrees(angle)),
    ):
        yield Panel(
            title,
            label,
            'measured less computed [arcmin]',
            tuple(
                Line(name, pen, *envelope(at, error * ARC_MINUTES))
                for (name, pen), error in zip(_PENS.items(), errors, strict=True)
            ),
            levels=((-width, ''), (width, '')),
        )


def check_document(path: Path, judgements: Sequence[Judgement]) -> Document:
    """Return the document on a calibration file, with a section for each recording."""
    data = {
        'schema': 'gear_kinematics/calibration_check',
        'version': 1,
        'calibration': str(path),
        'recordings': [
            {
                'name': j.samples.recording.name,
                'holds': j.holds,
                'rms_before': j.rms_before,
                'rms_after': j.rms_after,
                'rms_before_with_delay': j.with_delay[0],
                'rms_after_with_delay': j.with_delay[1],
                'delay': plain(j.delay),
                'within_interval': 1.0 - j.fit.outside,
                'within_interval_uncertainty': j.fit.outside_uncertainty,
                'uncalibrated': j.uncalibrated,
                'samples': j.fit.samples,
            }
            for j in judgements
        ],
    }
    return Document(
        f'gearkin calibrate --check {printable(path.name)}',
        tuple(map(_section, judgements)),
        data,
        Verdict.PASS if all(j.holds for j in judgements) else Verdict.FAIL,
        Table.of_items(
            {
                'recording': lambda j: printable(j.samples.recording.name),
                'rms before [arcmin]': lambda j: _arc_minutes(j.rms_before),
                'rms after [arcmin]': lambda j: _arc_minutes(j.rms_after),
                'within the interval [%]': lambda j: number(100.0 * (1.0 - j.fit.outside)),
            },
            judgements,
        ),
    )


def _section(j: Judgement) -> Section:
    before, after = _arc_minutes(j.rms_before), _arc_minutes(j.rms_after)
    inside, spread = 100.0 * (1.0 - j.fit.outside), 100.0 * j.fit.outside_uncertainty
    shown = f'{inside:.1f} ± {spread:.1f} %'
    if not j.fit.fits:
        left = f'{after}′ rms'
        if found := left_order(j.samples, j.after):
            left = f'{_arc_minutes(found[0])}′ {found[1]}'
        finding = (
            f'The calibration no longer holds: {inside:.1f} % instead of {PERCENT} lie within the '
            f'interval; what is left: {left}. Calibrate the gear again.'
        )
    else:
        finding = (
            f'The calibration {"holds" if j.holds else "does not help"}: {shown} of the measured '
            f'angles are within the {PERCENT} interval; it changes the error from {before} to '
            f'{after} arcmin rms.'
        )
    width = float(np.median(j.half_width))
    late = ' and '.join(map(_arc_minutes, j.with_delay)) if j.delay else ''
    uncalibrated = number(100.0 * j.uncalibrated)
    values = (
        ('rms before', before, 'arcmin'),
        ('rms after', after, 'arcmin'),
        ('the same with the delay', late, 'arcmin'),
        ('delay of the output', plus_minus(j.delay, _MILLI), 'ms'),
        ('median half width of the interval', _arc_minutes(width), 'arcmin'),
        ('within the interval', shown, ''),
        ('wider for what was not calibrated', uncalibrated, '% of the samples'),
        ('samples', str(j.fit.samples), ''),
    )
    cells = [(name, Cell(value, unit=unit)) for name, value, unit in values]
    of = j.samples
    panels = _error_panels(
        width, of.seconds, of.output, j.before, j.after, timed=of.encoders.timed
    )
    return Section(
        printable(j.samples.recording.name),
        (Table.of_values(Layout.LINES, *cells),),
        Verdict.PASS if j.holds else Verdict.FAIL,
        (Finding('finding', finding),),
        tuple(map(printable, j.samples.recording.sentences)),
        Figure(tuple(panels)),
    )
