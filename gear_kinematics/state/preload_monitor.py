# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node's diagnostics of the preload: did both branches stay in mesh?"""

import math

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.diagnostics import OK, WARN, Report
from gear_kinematics.state.loads import SampleLoads
from gear_kinematics.wire.cdr import SECOND


class PreloadMonitor:
    """Follows the margin, which is less than 0 while a branch is out of mesh."""

    def __init__(self, parameters: NodeParameters) -> None:
        """Start for a mechanism with a preload."""
        self._sharing, self._preload = parameters.sharing, abs(parameters.preload)
        massless = parameters.loads.without_mass
        self._lacking = 'no effort' if massless else 'no effort or no velocity'
        self._margin = math.nan
        self._last: int | None = None
        self._clear()

    def _clear(self) -> None:
        self._least = math.inf
        self._received = self._seen = self._lost = 0

    def follow(self, sample: RotorSample, loads: SampleLoads) -> None:
        """Take the loads at the next sample."""
        self._received += 1
        last = sample.stamp if self._last is None else self._last
        step = min(max(sample.stamp - last, 0), SECOND)
        self._last = sample.stamp
        margin = self._sharing.margin(loads.torque)
        if not math.isnan(margin):
            self._margin, self._least = margin, min(self._least, margin)
            self._seen += step
            self._lost += step * (margin <= 0.0)

    def report(self) -> Report:
        """Report on the time since the last report."""
        least, seen, received, lost = self._least, self._seen, self._received, self._lost
        self._clear()
        if least == math.inf:
            what = f'unknown: {self._lacking} in rotor_state' if received else 'no input'
            return Report(OK, what, {})
        share = f'{100.0 * lost / seen if seen else 100.0 * (least <= 0.0):.1f}'
        values = {'preload (N·m)': f'{self._preload:.4g}'}
        for name, margin in (('margin', self._margin), ('least margin', least)):
            values[f'{name} (N·m)'] = f'{margin:.4g}'
            values[f'{name} (% of the preload)'] = f'{100.0 * margin / self._preload:.1f}'
        values['out of mesh (% of the time)'] = share
        if least > 0.0:
            return Report(OK, 'ok', values)
        values['advice'] = 'Raise the preload (gearkin preload) or lower the torque of the output.'
        return Report(WARN, f'a branch was out of mesh for {share} % of the time', values)
