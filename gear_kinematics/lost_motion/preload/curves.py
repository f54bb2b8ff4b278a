"""The figures of a gear over its preload, and their panels."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from gear_kinematics.lost_motion.preload.advice import Advice, stiffness_of
from gear_kinematics.lost_motion.preload.model import Array, Reading
from gear_kinematics.lost_motion.preload.settings import Scale
from gear_kinematics.lost_motion.wording import ARC_MINUTES, PERCENT
from gear_kinematics.report.document import Figure, Line, Panel, Pen, number
from gear_kinematics.state.uncertainty import Estimate

_POINTS = 120
"""Settings at which the model is drawn."""
_MARGIN = 0.1
"""By which the drawing goes beyond the settings, as a share of their range."""


@dataclass(frozen=True, slots=True)
class PreloadFigure:
    """A figure over the preload."""

    name: str
    unit: str
    scale: float
    """Of the unit, per SI unit."""
    measured: Callable[[Reading], Estimate | None]
    predicted: Callable[[Advice, float], Estimate | None]


FIGURES = (
    PreloadFigure('backlash', 'arcmin', ARC_MINUTES, lambda r: r.play, Advice.predicted_play),
    PreloadFigure('friction', 'N·m', 1.0, lambda r: r.friction, Advice.predicted_friction),
    PreloadFigure('stiffness', 'N·m/rad', 1.0, stiffness_of, Advice.predicted_stiffness),
)


def shown(setting: float | None, scale: Scale) -> str:
    """Format a setting in its unit."""
    if setting is None:
        return ''
    unit = f' {scale.unit}' if scale.unit else ''
    return f'{number(setting / scale.size, 4)}{unit}'


def drawing(advice: Advice, scale: Scale, load: float) -> Figure:
    """Draw each figure over the settings: measured, by the model, and the least setting."""
    settings = np.array([reading.setting for reading in advice.readings])
    span = advice.least(load)
    ends = [settings.min(), settings.max()]
    margin = _MARGIN * (ends[1] - ends[0])
    x = np.linspace(max(ends[0] - margin, 0.0), ends[1] + margin, _POINTS)
    marks = ((span.value / scale.size, 'least setting'),) if span and not span.vague else ()
    label = f'setting [{scale.unit}]' if scale.unit else 'setting'
    return Figure(
        tuple(
            Panel(
                f'{figure.name} over the preload',
                label,
                f'{figure.name} [{figure.unit}]',
                tuple(_lines(advice, figure, x, scale)),
                marks=marks,
            )
            for figure in FIGURES
        ),
    )


def _lines(advice: Advice, figure: PreloadFigure, x: Array, scale: Scale) -> Iterator[Line]:
    found = [(s, figure.predicted(advice, s)) for s in x.tolist()]
    known = [(s, p) for s, p in found if p and p.uncertainty is not None]
    if known:
        at = np.array([s for s, _ in known]) / scale.size
        value = np.array([p.value for _, p in known]) * figure.scale
        spread = np.array([p.uncertainty for _, p in known], dtype=np.float64) * figure.scale
        for edge in (value - spread, value + spread):
            least = 0.0 if figure is FIGURES[0] else -np.inf
            yield Line(f'± of a recording ({PERCENT})', Pen.FAINT, at, np.maximum(edge, least))
        yield Line('model', Pen.MODEL, at, value)
    measured = [(r.setting, v) for r in advice.readings if (v := figure.measured(r))]
    yield Line(
        'measured',
        Pen.FIRST,
        np.array([s for s, _ in measured]) / scale.size,
        np.array([v.value for _, v in measured]) * figure.scale,
        points=True,
        error=np.array([v.uncertainty or np.nan for _, v in measured]) * figure.scale,
    )
    bounds = [r for r in advice.readings if r.play is None and r.limit is not None]
    if figure is FIGURES[0] and bounds:
        yield Line(
            'upper bound',
            Pen.SECOND,
            np.array([r.setting for r in bounds]) / scale.size,
            np.array([r.limit for r in bounds], dtype=np.float64) * figure.scale,
            points=True,
        )
