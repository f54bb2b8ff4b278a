# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node's diagnostics of the preload: did both branches stay in mesh?"""

import math
from collections import deque
from collections.abc import Sequence

import numpy as np

from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.diagnostics import OK, WARN, Report
from gear_kinematics.state.loads import SampleLoads
from gear_kinematics.wire.cdr import SECOND

_LEAST_ERRORS = 10  # measured between two crossings, for a compliance
_MOST_ERRORS = 2000  # that are kept between two crossings
_LEAST_EPISODES = 4  # out of mesh, for a standard deviation
_MOST_EPISODES = 100


class PreloadMonitor:
    """Follows the margin, which is less than 0 while a branch is out of mesh.

    An encoder at the output can confirm it: out of mesh, the output yields more for each N·m.
    """

    def __init__(self, parameters: NodeParameters) -> None:
        """Start for a mechanism with a preload."""
        self._sharing, self._preload = parameters.sharing, abs(parameters.preload)
        massless = parameters.loads.without_mass
        self._lacking = 'no effort' if massless else 'no effort or no velocity'
        self._margin = self._torque = math.nan
        self._in_mesh: bool | None = None
        self._errors: deque[tuple[float, float]] = deque(maxlen=_MOST_ERRORS)
        self._compliance_in_mesh = math.nan
        self._added: deque[float] = deque(maxlen=_MOST_EPISODES)
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
        self._last, self._torque = sample.stamp, loads.torque
        margin = self._sharing.margin(loads.torque)
        in_mesh = None
        if not math.isnan(margin):
            in_mesh = margin > 0.0
            self._margin, self._least = margin, min(self._least, margin)
            self._seen += step
            self._lost += step * (not in_mesh)
        if in_mesh != self._in_mesh:
            self._note_crossing()
            self._in_mesh = in_mesh

    def compare(self, samples: Sequence[ErrorSample]) -> None:
        """Take measured errors of the output, of which those of a calibrated gear count."""
        known = (s.error - s.deviation for s in samples if not math.isnan(s.half_width))
        self._errors += [(self._torque, error) for error in known]

    def _note_crossing(self) -> None:
        """Compare the compliances before and after a branch left its mesh."""
        torque, error = np.array(self._errors, float).reshape(-1, 2).T
        self._errors.clear()
        compliance = math.nan
        if len(torque) >= _LEAST_ERRORS and np.ptp(torque) > 0.0:
            torque -= torque.mean()
            compliance = -float(torque @ error / (torque @ torque))
        if self._in_mesh:
            self._compliance_in_mesh = compliance
        elif not math.isnan(added := compliance - self._compliance_in_mesh):
            self._added.append(added)

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
        if len(self._added) >= _LEAST_EPISODES:
            found = Estimate.of_mean(self._added)
            if found.value > (spread := found.uncertainty or 0.0):
                measured = f'{found.value:.3g} ± {spread:.2g}'
                values['measured added compliance out of mesh (rad/(N·m))'] = measured
        if least > 0.0:
            return Report(OK, 'ok', values)
        values['advice'] = 'Raise the preload (gearkin preload) or lower the torque of the output.'
        return Report(WARN, f'a branch was out of mesh for {share} % of the time', values)
