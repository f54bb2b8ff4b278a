"""Errors of one field of the outputs."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.report import FieldReport

Array = NDArray[Any]

_NONE = np.zeros(0, np.int64)


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(
        self, name: str, unit: str, tolerance: float, parts: Sequence[str] = ('',)
    ) -> None:
        """Start without samples.

        Args:
            name: of the field.
            unit: of its errors.
            tolerance: the greatest accepted error.
            parts: names of the parts that are plotted.
        """
        self.parts = parts
        self.non_finite = Occurrences()
        self.absent = Occurrences()
        self._report = FieldReport(name, unit, tolerance)
        self._squares = 0.0

    @property
    def name(self) -> str:
        """Name of the field."""
        return self._report.name

    @property
    def tolerance(self) -> float:
        """The greatest accepted error."""
        return self._report.tolerance

    @property
    def passed(self) -> bool:
        """Whether every sample so far is within the tolerance."""
        return self.report().passed

    @property
    def worst(self) -> float:
        """The greatest error so far."""
        return self._report.max_error

    def update(
        self, error: Array, stamp: Array, rotor_angle: Array, absent: Array = _NONE
    ) -> None:
        """Add absolute errors (n,), and the stamps of samples that lack the field, (m,)."""
        report = self._report
        finite = np.isfinite(error)
        self._report = report = replace(report, compared=report.compared + len(error))
        self.non_finite.add(stamp[~finite])
        self.absent.add(absent)
        if not finite.all():
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        self._squares += float(error @ error)
        if not len(error):
            return
        worst = int(np.argmax(error))
        if error[worst] <= report.max_error:
            return
        self._report = replace(
            report,
            max_error=float(error[worst]),
            worst_stamp=int(stamp[worst]),
            worst_rotor_angle=float(rotor_angle[worst]),
        )

    def report(self) -> FieldReport:
        """Report on everything so far."""
        finite = self._report.compared - self.non_finite.count
        return replace(
            self._report,
            non_finite=self.non_finite.count,
            first_non_finite=self.non_finite.first,
            absent=self.absent.count,
            first_absent=self.absent.first,
            rms_error=math.sqrt(self._squares / finite) if finite else 0.0,
        )
