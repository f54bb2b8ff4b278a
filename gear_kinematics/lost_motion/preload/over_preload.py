"""The section of a report on recordings at several settings of the preload."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gear_kinematics.lost_motion.preload.advice import FEWEST, Advice, advise, without
from gear_kinematics.lost_motion.preload.curves import FIGURES, PreloadFigure, drawing, shown
from gear_kinematics.lost_motion.preload.model import Reading, Span
from gear_kinematics.lost_motion.preload.settings import Scale
from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.common import basis, chosen, doubts, highest_range
from gear_kinematics.lost_motion.several.compared import Compared
from gear_kinematics.lost_motion.static.hysteresis import Figures, Stiffness
from gear_kinematics.lost_motion.static.play import Cause
from gear_kinematics.lost_motion.wording import PERCENT, plus_minus, torque
from gear_kinematics.report.document import (
    Cell,
    Layout,
    Section,
    Table,
    Tone,
    number,
    printable,
)
from gear_kinematics.state.uncertainty import Estimate


@dataclass(frozen=True, slots=True)
class _LeftOut:
    """A figure of a recording, and its prediction from those at other settings."""

    reading: Reading
    figure: PreloadFigure
    predicted: Estimate | None

    @property
    def within(self) -> bool | None:
        """Whether the measured value is within ± of the predicted one; None if unknown."""
        predicted, measured = self.predicted, self.figure.measured(self.reading)
        if predicted is None or predicted.uncertainty is None:
            return None
        if measured:
            return abs(measured.value - predicted.value) <= predicted.uncertainty
        if self.figure.measured is FIGURES[0].measured and self.reading.limit is not None:
            return predicted.value - predicted.uncertainty <= self.reading.limit
        return None


def over_preload(
    reports: Sequence[LostMotionReport],
    settings: Sequence[float],
    scale: Scale,
    load: float,
) -> Compared:
    """Advise a preload by recordings at several settings.

    Args:
        reports: as `at_common_torque` returns them.
        settings: of the reports, as `settings_of` returns them with `scale`.
        scale: of the settings.
        load: N·m, under which there must be no play.

    Raises:
        ValueError: if there are too few settings, or figures.
    """
    common = basis(reports)
    if common is None:
        raise ValueError('--preloads needs torque ramps')
    small, loaded = chosen(reports, common.small), chosen(reports, common.loaded)
    low, high = highest_range(loaded, common.reach)
    readings = [
        reading_of(report.recording.name, setting, figures, _over(large, low, high))
        for report, setting, figures, large in zip(reports, settings, small, loaded, strict=True)
        if figures and large
    ]
    count = len({reading.setting for reading in readings})
    if count < FEWEST:
        raise ValueError(
            f'--preloads needs ramps of about one amplitude at {FEWEST} settings, not at {count}'
        )
    frictions = [reading.friction.value for reading in readings if reading.friction]
    drag = float(np.mean(frictions)) if frictions else 0.0
    # On the gear is the torque less the friction.
    advice = advise(readings, scale.play, (max(low - drag, 0.0), max(high - drag, 0.0)))
    left_out = list(_left_out(advice))
    sentence = told(advice, scale, load)
    remarks = [
        f'{sentence}.',
        *_cautions(advice, scale, load),
        *_checked(left_out),
        *doubts(reports, common),
    ]
    section = Section(
        'preload',
        (_head(advice, scale, load), _table(left_out, scale)),
        remarks=tuple(map(printable, remarks)),
        figure=drawing(advice, scale, load),
    )
    data = {'preload': _data(advice, scale, load, left_out)}
    return Compared(section, printable(sentence), data)


def reading_of(name: str, setting: float, small: Figures, spring: Stiffness | None) -> Reading:
    """Take from the small ramps of a recording what the advice needs, and the stiffness."""
    model = small.play_model
    # A soft middle bounds the play, but does not tell that there may be none.
    bounded = model if model and model.cause == Cause.ZERO else None
    return Reading(
        name,
        setting,
        model.play if model else None,
        bounded.limit if bounded else None,
        small.friction,
        spring.positive if spring else None,
        spring.negative if spring else None,
    )


def _over(figures: Figures, low: float, high: float) -> Stiffness | None:
    """The stiffness over a range of torque."""
    return next((s for s in figures.stiffness if (s.low, s.high) == (low, high)), None)


def told(advice: Advice, scale: Scale, load: float) -> str:
    """Say in a sentence from which setting on there is no play, and what it costs."""
    under = f'under {torque(load)} N·m' if load else 'without a load'
    span = advice.least(load)
    if span is None:
        return f'{_bounds(advice, scale)}; no ±: {advice.play.cause or "no stiffness is known"}'
    if span.vague:
        least = shown(span.low, scale)
        return f'there is play {under} up to the setting {least} at least; the scatter hides more'
    price = advice.price(load)
    cost = ''
    if price and price.uncertainty:
        cost = ', at what cost in friction is too uncertain to tell'
        if abs(price.value) > price.uncertainty:
            cost = f', for {plus_minus(price)} N·m more friction'
    return f'no play {under} from the setting {_spanned(span, scale)} on{cost}'


def _bounds(advice: Advice, scale: Scale) -> str:
    above, up_to = advice.play.greatest_with, advice.play.least_without
    if above is None and up_to is None:
        return 'where the play ends is not known'
    if above is None:
        return f'no play shows from the setting {shown(up_to, scale)} on, the least that counts'
    if up_to is None:
        return f'there is play up to the setting {shown(above, scale)}'
    return f'the play ends between the settings {shown(above, scale)} and {shown(up_to, scale)}'


def _spanned(span: Span, scale: Scale) -> str:
    edges = [edge / scale.size for edge in (span.low, span.value, span.high)]
    digits = max(0, 2 - math.floor(math.log10(edges[2] - edges[0]))) if span.high > span.low else 6
    low, value, high = (f'{edge:.{digits}f}' for edge in edges)
    unit = f' {scale.unit}' if scale.unit else ''
    return f'{value}{unit} ({PERCENT}: {low} to {high})'


def _cautions(advice: Advice, scale: Scale, load: float) -> Iterator[str]:
    settings = [reading.setting for reading in advice.readings]
    span = advice.least(load)
    if span and not span.vague and not min(settings) <= span.value <= max(settings):
        between = f'{shown(min(settings), scale)} to {shown(max(settings), scale)}'
        yield f'This setting is extrapolated beyond those that were measured ({between}).'
    if advice.cause:
        yield f'The stiffness is not predicted: {advice.cause}.'
    yield (
        f'Each ± contains the value with a probability of {PERCENT}, by the scatter of the '
        'recordings about the model of two braced branches.'
    )


def _checked(left_out: Sequence[_LeftOut]) -> Iterator[str]:
    parts = []
    for figure in FIGURES:
        judged = [item.within for item in left_out if item.figure is figure]
        known = [within for within in judged if within is not None]
        if known:
            parts.append(f'{figure.name} {sum(known)} of {len(known)}')
    if parts:
        yield f'Each setting was predicted from the others. Within ±: {", ".join(parts)}.'
    else:
        yield 'No setting can be predicted from the others: there are too few.'


def _left_out(advice: Advice) -> Iterator[_LeftOut]:
    others = {s: without(advice, s) for s in {r.setting for r in advice.readings}}
    for reading in sorted(advice.readings, key=lambda r: r.setting):
        other = others[reading.setting]
        for figure in FIGURES:
            predicted = figure.predicted(other, reading.setting) if other else None
            yield _LeftOut(reading, figure, predicted)


def _head(advice: Advice, scale: Scale, load: float) -> Table:
    span, end, price = advice.least(load), advice.least(0.0), advice.price(load)
    return Table.of_values(
        Layout.INLINE,
        ('settings', str(len({reading.setting for reading in advice.readings}))),
        (
            'play ends at',
            _spanned(end, scale) if end and not end.vague else _bounds(advice, scale),
        ),
        ('load', f'{torque(load)} N·m'),
        ('least setting', _known(span, scale)),
        ('price', f'{plus_minus(price)} N·m of friction' if price and _known(span, scale) else ''),
    )


def _known(span: Span | None, scale: Scale) -> str:
    """Format a setting and its interval; empty where that is unknown or vague."""
    return _spanned(span, scale) if span and not span.vague else ''


def _table(left_out: Sequence[_LeftOut], scale: Scale) -> Table:
    return Table.of_items(
        {
            'setting': lambda item: printable(
                f'{shown(item.reading.setting, scale)}, {item.reading.name}: {item.figure.name}'
            ),
            'measured': _measured,
            'predicted without it': lambda item: Cell(
                plus_minus(item.predicted, item.figure.scale)
                if item.predicted and item.predicted.uncertainty
                else '',
                unit=item.figure.unit,
            ),
            'within ±': lambda item: {
                True: Cell('yes'),
                False: Cell('no', Tone.NOTABLE),
                None: Cell(''),
            }[item.within],
        },
        left_out,
        ('', 'within ±'),
    )


def _measured(item: _LeftOut) -> Cell:
    value, figure = item.figure.measured(item.reading), item.figure
    if value:
        return Cell(plus_minus(value, figure.scale), unit=figure.unit)
    if figure is FIGURES[0] and item.reading.limit is not None:
        return Cell(f'below {number(item.reading.limit * figure.scale)}', unit=figure.unit)
    return Cell('')


def _data(
    advice: Advice, scale: Scale, load: float, left_out: Sequence[_LeftOut]
) -> Mapping[str, Any]:
    return {
        'unit': scale.unit or None,
        'ring_turns': scale.play is not None,
        'load': load,
        'least': advice.least(load),
        'price': advice.price(load),
        'cause': advice.play.cause or None,
        'model': {
            'scale': advice.scale,
            'loads': advice.loads,
            'play': advice.play,
            'branches': advice.branches,
            'friction': advice.friction,
        },
        'readings': advice.readings,
        'left_out': [
            {
                'recording': item.reading.name,
                'figure': item.figure.name,
                'predicted': item.predicted,
                'within': item.within,
            }
            for item in left_out
        ],
    }
