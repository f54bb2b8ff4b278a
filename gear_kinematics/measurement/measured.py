# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A measured figure as reports name and show it."""

from typing import NamedTuple

from gear_kinematics.measurement.backlash import Backlash
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report.document import Cell, Tone, number
from gear_kinematics.statistics.uncertainty import Estimate

HYSTERESIS = 'hysteresis'  # the name of the figure that is judged first
LOST_MOTION = 'lost motion'  # the name of the figure at a small torque, or on reversals
SHOWN = {'rad': ('′', ARC_MINUTES), 's': ('ms', 1e3)}  # units that are shown instead, and factors


class Measured(NamedTuple):
    """A figure of a recording."""

    name: str
    unit: str  # SI
    value: Estimate | Backlash | None
    at: str = ''  # condition under which it was read, in words that follow the name

    @property
    def cell(self) -> Cell:
        """The value with its ±, or as an interval; it stands out if its ± exceeds it."""
        unit, scale = SHOWN.get(self.unit, (self.unit, 1.0))
        value = self.value
        if isinstance(value, Backlash):
            if not value.value:
                text = ' to '.join(number(end * scale) for end in self.ends) or 'unknown'
                return Cell(text, unit=unit if self.ends else '')
            value = value.value
        tone = Tone.NOTABLE if value and not value.clear else Tone.PLAIN
        return Cell(plus_minus(value, scale), tone, unit)

    @property
    def ends(self) -> tuple[float, ...]:
        """Ends of the interval that contains it, SI; infinite without a ±, none if not known."""
        return self.value.ends if self.value else ()


def cell_of(unit: str, *values: float) -> Cell:
    """Show bare values in the unit of reports."""
    unit, scale = SHOWN.get(unit, (unit, 1.0))
    return Cell(', '.join(number(scale * value) for value in values), unit=unit)
