# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Calibration of the real output of a gear, from recordings of its rotor's and output's encoders.

The method and its sources are in docs/calibration.md.
"""

from gear_kinematics.measurement.calibration.check import Judgement, judge
from gear_kinematics.measurement.calibration.fit import Fit, fit

__all__ = ['Fit', 'Judgement', 'fit', 'judge']
