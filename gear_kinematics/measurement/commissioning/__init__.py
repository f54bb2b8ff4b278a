# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the parameters of the node in recordings of both encoders, each with its evidence."""

from gear_kinematics.measurement.commissioning.analysis import (
    Channel,
    Commissioning,
    Request,
    commission,
)
from gear_kinematics.measurement.commissioning.file import actuator_file

__all__ = ['Channel', 'Commissioning', 'Request', 'actuator_file', 'commission']
