"""The reports on a calibration and on its check; docs/calibration.md describes their JSON."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from gear_kinematics.measurement.calibration.check import Judgement
from gear_kinematics.measurement.calibration.result import Fit
from gear_kinematics.measurement.calibration.terms import OrderTerm, StopTerm, output_cycles
from gear_kinematics.measurement.curves import envelope, marks, peaks
from gear_kinematics.measurement.ratio import ratio_remarks
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
from gear_kinematics.state.uncertainty import COVERAGE

_MILLI = 1e3
_DECADES = 3
"""Decades of a spectrum below its greatest amplitude."""
_PENS = {'before': Pen.FAINT, 'after': Pen.FIRST}
_TIME = {True: 'time [s]', False: 'sample'}
"""The x axis of a recording with and without times."""


def document(fit: Fit, target: str) -> Document:
    """Return the document on a calibration, whose file is the target."""
    verdict = Verdict.PASS if fit.helps else Verdict.FAIL
    before, after = _arc_minutes(fit.rms_before), _arc_minutes(fit.rms_after)
    finding = (
        f'The error falls from {before} to {after} arcmin rms in what was left out of the fit.'
        if fit.helps
        else f'No correction helps: with the best one the error is {after} arcmin rms instead of '
        f'{before} in what was left out of the fit, no more than by chance. Nothing is written.'
    )
    section = Section(
        printable(target),
        tuple(_tables(fit)),
        verdict,
        (Finding('finding', finding),),
        tuple(map(printable, remarks(fit))),
        Figure(tuple(_panels(fit)), columns=2),
        picture_first=True,
    )
    orders = ('cycles', OrderTerm), ('radius', StopTerm)
    left_out = ('rms_before', 'rms_after', 'half_width', 'outside_half_width', 'coverage')
    data = {
        'schema': 'gear_kinematics/calibration_report',
        'version': 1,
        'coverage': COVERAGE,
        'helps': fit.helps,
        'gear_ratio': str(fit.ratio),
        'fitted_ratio': plain(fit.fitted_ratio),
        'left_out': {name: getattr(fit, name) for name in left_out},
        'terms': [
            {
                'name': f.term.name,
                **{
                    name: plain(getattr(f.term, name)) if isinstance(f.term, kind) else None
                    for name, kind in orders
                },
                'amplitude': plain(f.amplitude),
                'cause': f.term.cause,
            }
            for f in fit.terms
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
        'remarks': list(remarks(fit)),
    }
    return Document('gearkin calibrate', (section,), data, verdict)


def remarks(fit: Fit) -> Iterator[str]:
    """Yield the basis and the limits of the calibration, in sentences."""
    for r in fit.recordings:
        recording = r.samples.recording
        yield from (f'{recording.name}: {text}' for text in recording.sentences)
    if fit.fitted_ratio:
        yield from ratio_remarks(fit.fitted_ratio)
    for name, cause in fit.refused.items():
        yield f'{name} is not fitted: {cause}.'
    timed = all(r.samples.encoders.timed for r in fit.recordings)
    for samples, *_, delay in fit.recordings:
        if delay and delay.clear:
            yield (
                f'{samples.recording.name}: the output angles are later than the rotor angles by '
                f'{plus_minus(delay, _MILLI)} ms, or the gear winds up in proportion to its '
                'speed. This part of the error is left out, and not corrected.'
            )
        elif delay is None and timed:
            yield (
                f'{samples.recording.name}: a delay of the output angles is not told from '
                'hysteresis; this takes three strokes or more.'
            )
    if not timed:
        yield (
            'Time was not recorded: the interval does not depend on the speed, and a delay '
            'between the encoders is not told from hysteresis.'
        )
    yield (
        f'The interval of ± {_arc_minutes(fit.half_width)} arcmin contains {PERCENT} of the '
        'measured angles of another recording, relative to its zero and less its delay. Each ± '
        f'contains the value with a probability of {PERCENT}, by leaving out one part of the '
        'recordings after the other.'
    )


def _arc_minutes(angle: float) -> str:
    return number(angle * ARC_MINUTES)


def _tables(fit: Fit) -> Iterator[Table]:
    teeth = fit.mechanism and f'{fit.mechanism.ring_teeth}/{fit.mechanism.satellite_teeth}'
    samples = sum(len(r.after) for r in fit.recordings)
    head = ('gear ratio', str(fit.ratio)), ('teeth', teeth or ''), ('samples', str(samples))
    yield Table.of_values(Layout.INLINE, *head)
    angles = {
        'rms before': fit.rms_before,
        'rms after': fit.rms_after,
        'half width of the interval': fit.half_width,
        'half width outside the calibrated range': fit.outside_half_width,
    }
    values = [(name, _arc_minutes(angle), 'arcmin') for name, angle in angles.items()]
    values.append(('coverage of the interval', number(100.0 * fit.coverage), '%'))
    rows = tuple((Cell(name, unit=unit), Cell(value, unit=unit)) for name, value, unit in values)
    yield Table(('left out of the fit', 'value'), rows)
    cycles = [f.term.cycles if isinstance(f.term, OrderTerm) else None for f in fit.terms]
    output = output_cycles(fit.ratio)
    yield Table.of_items(
        {
            'term': lambda row: row[0].term.name,
            'amplitude [arcmin]': lambda row: arc_minutes(row[0].amplitude),
            'cycles per rotor turn': lambda row: str(row[1] or ''),
            'per output turn': lambda row: str(row[1] / output) if row[1] else '',
            'likely cause': lambda row: row[0].term.cause,
        },
        zip(fit.terms, cycles, strict=True),
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
    used = [(r.samples, r.samples.used) for r in fit.recordings]
    ends = np.cumsum([0.0, *(s.seconds[-1] for s, _ in used)])
    time = np.concatenate([s.seconds[at] + end for (s, at), end in zip(used, ends, strict=False)])
    angle = np.concatenate([s.output[at] + s.first_output for s, at in used])
    errors = {name: np.concatenate([getattr(r, name) for r in fit.recordings]) for name in _PENS}
    timed = all(s.encoders.timed for s, _ in used)
    yield from _error_panels(time, angle, errors, fit.half_width, timed=timed)
    spectra = [(s, *line) for s, line in zip(fit.spectra, _PENS.items(), strict=True) if s]
    lines = []
    for spectrum, name, pen in spectra:
        shown = spectrum.cycles >= spectrum.resolution
        curve = peaks(spectrum.cycles[shown], spectrum.amplitude[shown] * ARC_MINUTES)
        lines.append(Line(name, pen, *curve))
    if lines:
        orders = [f.term for f in fit.terms if isinstance(f.term, OrderTerm)]
        yield Panel(
            'spectrum',
            'order: cycles in a turn of the rotor',
            'amplitude [arcmin]',
            tuple(lines),
            marks=tuple(marks((float(order.cycles), order.name) for order in orders)),
            scale='log',
            low=max(float(line.y.max()) for line in lines) / 10.0**_DECADES,
        )


def _error_panels(
    time: Array, angle: Array, errors: Mapping[str, Array], half_width: float, *, timed: bool
) -> Iterator[Panel]:
    """Draw errors, rad, over time and output angle, rad, with the interval."""
    width = half_width * ARC_MINUTES
    for title, label, at in (
        ('error of samples left out', _TIME[timed], time),
        ('error over the output angle', 'output angle [°]', np.degrees(angle)),
    ):
        yield Panel(
            title,
            label,
            'measured less computed [arcmin]',
            tuple(
                Line(name, pen, *envelope(at, errors[name] * ARC_MINUTES))
                for name, pen in _PENS.items()
            ),
            levels=((-width, ''), (width, '')),
        )


def check_document(path: Path, judgements: Sequence[Judgement]) -> Document:
    """Return the document on a calibration file, with a section for each recording."""
    recordings = [
        {
            'name': j.recording.name,
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
    ]
    schema = {'schema': 'gear_kinematics/calibration_check', 'version': 1}
    return Document(
        f'gearkin calibrate --check {printable(path.name)}',
        tuple(map(_section, judgements)),
        {**schema, 'calibration': str(path), 'recordings': recordings},
        Verdict.PASS if all(j.holds for j in judgements) else Verdict.FAIL,
        Table.of_items(
            {
                'recording': lambda j: printable(j.recording.name),
                'rms before [arcmin]': lambda j: _arc_minutes(j.rms_before),
                'rms after [arcmin]': lambda j: _arc_minutes(j.rms_after),
                'within the interval [%]': lambda j: number(100.0 * (1.0 - j.fit.outside)),
            },
            judgements,
        ),
    )


def _section(judgement: Judgement) -> Section:
    before, after = _arc_minutes(judgement.rms_before), _arc_minutes(judgement.rms_after)
    inside, spread = 100.0 * (1.0 - judgement.fit.outside), judgement.fit.outside_uncertainty
    shown = f'{inside:.1f} ± {100.0 * spread:.1f} %'
    finding = (
        f'The correction changes the error from {before} to {after} arcmin rms; {shown} of the '
        f'measured angles are within the {PERCENT} interval.'
    )
    if not judgement.fit.fits:
        finding += ' That is too few by more than chance: the interval does not hold.'
    errors = {'before': judgement.before, 'after': judgement.after}
    width = float(np.median(judgement.half_width))
    late = ' and '.join(map(_arc_minutes, judgement.with_delay)) if judgement.delay else ''
    values = (
        ('rms before', before, 'arcmin'),
        ('rms after', after, 'arcmin'),
        ('the same with the delay', late, 'arcmin'),
        ('delay of the output', plus_minus(judgement.delay, _MILLI), 'ms'),
        ('median half width of the interval', _arc_minutes(width), 'arcmin'),
        ('within the interval', shown, ''),
        (
            'wider for what was not calibrated',
            number(100.0 * judgement.uncalibrated),
            '% of the samples',
        ),
        ('samples', str(judgement.fit.samples), ''),
    )
    cells = [(name, Cell(value, unit=unit)) for name, value, unit in values]
    panels = _error_panels(
        judgement.seconds, judgement.output, errors, width, timed=judgement.timed
    )
    return Section(
        printable(judgement.recording.name),
        (Table.of_values(Layout.LINES, *cells),),
        Verdict.PASS if judgement.holds else Verdict.FAIL,
        (Finding('finding', finding),),
        tuple(map(printable, judgement.recording.sentences)),
        Figure(tuple(panels)),
    )
