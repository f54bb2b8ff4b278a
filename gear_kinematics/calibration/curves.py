"""The panels of a report on a calibration, in arc minutes."""

from collections.abc import Iterator, Mapping

import numpy as np

from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.result import Fit
from gear_kinematics.calibration.terms import OrderTerm
from gear_kinematics.lost_motion.curves import envelope, marks, peaks
from gear_kinematics.lost_motion.wording import ARC_MINUTES
from gear_kinematics.report.document import Line, Panel, Pen

_WAYS = (('before', Pen.FAINT), ('after', Pen.FIRST))
_DECADES = 3
"""Decades of a spectrum below its greatest amplitude."""


def panels(fit: Fit) -> Iterator[Panel]:
    """Yield the error before and after the correction, over time, output angle and orders."""
    used = [(r, r.samples.used) for r in fit.recordings]
    timed = all(r.samples.recording.timed for r in fit.recordings)
    ends = np.cumsum([0.0, *(r.samples.seconds[-1] for r in fit.recordings)])
    time = [r.samples.seconds[rows] + end for (r, rows), end in zip(used, ends, strict=False)]
    angle = [np.degrees(r.samples.output[rows] + r.samples.first_output) for r, rows in used]
    yield _error(fit, 'error of samples left out', 'time [s]' if timed else 'sample', time)
    yield _error(fit, 'error over the output angle', 'output angle [°]', angle)
    lines = []
    for spectrum, (name, pen) in zip(fit.spectra, _WAYS, strict=True):
        if spectrum:
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


def _error(fit: Fit, title: str, label: str, places: list[Array]) -> Panel:
    errors = {
        name: np.concatenate([getattr(r, name) for r in fit.recordings]) for name, _ in _WAYS
    }
    return error_panel(title, label, np.concatenate(places), errors, fit.half_width)


def error_panel(
    title: str, label: str, at: Array, errors: Mapping[str, Array], half_width: float
) -> Panel:
    """Draw the error before and after the correction, with the interval.

    Args:
        title: of the panel.
        label: of the x axis.
        at: (n,), places on the x axis.
        errors: `before` and `after`, (n,), rad.
        half_width: of the interval, rad.
    """
    width = half_width * ARC_MINUTES
    return Panel(
        title,
        label,
        'measured less computed [arcmin]',
        tuple(Line(name, pen, *envelope(at, errors[name] * ARC_MINUTES)) for name, pen in _WAYS),
        levels=((-width, ''), (width, '')),
    )
