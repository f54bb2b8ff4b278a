"""The calibration file of a fit."""

from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from gear_kinematics.measurement.calibration.result import Fit
from gear_kinematics.measurement.calibration.terms import OrderTerm, StopTerm, TorqueTerm
from gear_kinematics.measurement.recording import Array
from gear_kinematics.state import calibration_file as file
from gear_kinematics.state.share import version

_MARGIN = 0.1
"""Share of the span of speed and torque beyond which they are not calibrated."""


def to_calibration(fit: Fit) -> file.Calibration:
    """Convert a fit to the content of a calibration file."""
    # The order in the file: orders, stops, compliance.
    kinds = (OrderTerm, StopTerm, TorqueTerm)
    order = sorted(range(len(fit.terms)), key=lambda k: kinds.index(type(fit.terms[k].term)))
    ends = np.cumsum([0, *(term.columns for term, *_ in fit.terms)])
    places = [place for k in order for place in range(ends[k], ends[k + 1])]
    terms = [(term, c.tolist()) for term, c, _ in fit.terms]
    samples = [r.samples for r in fit.recordings]
    timed = all(s.encoders.timed for s in samples)
    torques = [s.torque for s in samples if s.torque is not None]
    return file.Calibration(
        made_by=f'gearkin calibrate {version()}',
        created=datetime.now(UTC).isoformat(timespec='seconds'),
        recordings=tuple(
            file.Recording(
                s.recording.name, s.recording.sha256, len(s.error), s.encoders.duration, zero
            )
            for s, _, _, zero, _ in fit.recordings
        ),
        gear_ratio=fit.ratio,
        ring_teeth=fit.mechanism.ring_teeth if fit.mechanism else None,
        satellite_teeth=fit.mechanism.satellite_teeth if fit.mechanism else None,
        constant=fit.constant,
        orders=tuple(
            file.Order(term.name, term.cycles, *c)
            for term, c in terms
            if isinstance(term, OrderTerm)
        ),
        hysteresis=tuple(
            file.Stop(term.radius, *c) for term, c in terms if isinstance(term, StopTerm)
        ),
        compliance=next(
            (
                file.Compliance(c[0], term.mean)
                for term, c in terms
                if isinstance(term, TorqueTerm)
            ),
            None,
        ),
        covariance=tuple(map(tuple, fit.covariance[np.ix_(places, places)].tolist())),
        half_width=fit.half_width,
        outside_half_width=fit.outside_half_width,
        spans=file.Spans(
            _span([s.speed for s in samples], _MARGIN) if timed else None,
            _span(torques, _MARGIN) if len(torques) == len(samples) else None,
            # Outputs of the recordings count from different whole turns.
            _span([s.output + s.first_output for s in samples], 0.0),
            sum(s.encoders.duration for s in samples),
        ),
        validation=file.Prediction(fit.rms_before, fit.rms_after, fit.coverage),
    )


def _span(columns: Sequence[Array], margin: float) -> tuple[float, float]:
    low = min(float(np.min(column)) for column in columns)
    high = max(float(np.max(column)) for column in columns)
    return low - margin * (high - low), high + margin * (high - low)
