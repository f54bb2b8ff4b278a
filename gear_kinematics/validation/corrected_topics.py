"""Compares the topics of the corrected output with recomputed ones, sample by sample.

The hysteresis depends on the motion before the recording. What another history would change is
accepted, until the output has travelled far enough; see `Correction.unknown_history`.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.calibration_file import Calibration
from gear_kinematics.state.correction import Corrector
from gear_kinematics.state.rotor_input import RotorSamples
from gear_kinematics.validation.diagnosis import UnseenTurns
from gear_kinematics.validation.matching import Columns, OutputTopic
from gear_kinematics.validation.output_topics import FieldErrors, Solver, Tolerances, ideal_angle
from gear_kinematics.validation.recorder import HOLE
from gear_kinematics.validation.report import FieldReport
from gear_kinematics.wire.batches import FIELDS, decode_joint_states
from gear_kinematics.wire.topics import CORRECTED_INTERVAL, CORRECTED_STATE

Array = NDArray[Any]


class RecomputedCorrection:
    """The correction at the samples of a recording; after a hole, the history is unknown."""

    def __init__(self, calibration: Calibration) -> None:
        self._corrector = Corrector(calibration)
        self._last: int | None = None
        self._holes = 0

    def columns(self, samples: RotorSamples) -> Columns:
        """Compute the correction at the next samples, as columns (n,) by field."""
        stamp = samples.stamp
        first = stamp[:1] if self._last is None else self._last
        period = np.diff(stamp, prepend=first)
        after_hole = period > HOLE * np.median(period[period > 0]) if period.any() else period > 0
        holes = self._holes + np.cumsum(after_hole)
        if len(stamp):
            self._last, self._holes = int(stamp[-1]), int(holes[-1])
        correction = self._corrector.correct_batch(*samples[:5], samples.stretch + holes)
        return correction._asdict()


class CorrectedTopic(OutputTopic):
    """A topic of the corrected output; samples have the columns of `RecomputedCorrection`."""

    units: ClassVar[Mapping[str, str]]
    """Units of the fields by their names."""

    def __init__(
        self,
        joint: str,
        gear: Gear,
        tolerances: Tolerances,
        solver: Solver,
        unseen: UnseenTurns | None,
    ) -> None:
        super().__init__(unseen)
        self._gear = gear
        self._solver = solver
        self.joint = joint
        self.offset = 0.0
        """Known offset of the recorded angle, rad."""
        self._errors = [
            FieldErrors(name, unit, tolerances.angle) for name, unit in self.units.items()
        ]

    def _fields(self) -> tuple[FieldReport, ...]:
        return tuple(errors.report() for errors in self._errors)

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._states = decode_joint_states(messages, self.joint)
        return self._states.stamp, self._states.malformed

    def _compare(self, rows: Array, samples: Columns) -> None:
        states, stamp = self._states, samples['stamp']
        self._faults.add(f'no joint {self.joint!r}', stamp[~states.joint_found[rows]])
        turns = samples['turns'] + (self._unseen.of(samples['stretch']) if self._unseen else 0.0)
        rotor_angle = TURN * turns + samples['angle']
        expected = self._expected(samples | {'turns': turns})
        for column, (errors, (least, most)) in enumerate(zip(self._errors, expected, strict=True)):
            wanted, there = ~np.isnan(least), states.present[rows, column]
            both = wanted & there
            recorded = states.values[rows, column]
            error = np.maximum(np.maximum(least - recorded, recorded - most), 0.0)
            errors.update(
                error[both], stamp[both], rotor_angle[both], absent=stamp[wanted != there]
            )

    def _expected(self, samples: Columns) -> Sequence[tuple[Array, Array]]:
        """The least and the greatest value of each field; NaN where it is absent."""
        raise NotImplementedError


class CorrectedState(CorrectedTopic):
    """corrected_state."""

    units: ClassVar[Mapping[str, str]] = dict(zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True))

    def _expected(self, samples: Columns) -> Sequence[tuple[Array, Array]]:
        ideal = ideal_angle(self._gear, self._solver, samples['turns'], samples['angle'])
        position = ideal + self.offset + samples['deviation']
        history = samples['unknown_history']
        ratio = self._gear.gear_ratio
        rate = ratio.output_rate(samples['velocity'] * (1.0 + samples['slope']))
        unknown = np.where(history > 0.0, np.inf, 0.0)
        effort = float(ratio) * samples['effort']
        return (
            (position - history, position + history),
            (rate - unknown, rate + unknown),
            (effort, effort),
        )


class CorrectedInterval(CorrectedTopic):
    """corrected_interval."""

    units: ClassVar[Mapping[str, str]] = {'half width': 'rad'}

    def _expected(self, samples: Columns) -> Sequence[tuple[Array, Array]]:
        half_width = samples['half_width']
        return ((half_width - samples['unknown_history'], half_width),)


CORRECTED: Mapping[str, type[CorrectedTopic]] = {
    CORRECTED_STATE: CorrectedState,
    CORRECTED_INTERVAL: CorrectedInterval,
}
"""What compares each of CORRECTED_TOPICS."""
