# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the outputs of a node with recomputed ones, and computes them where there are none.

In a test of another package:

    report = validate('logs/monday', 'actuator.yaml')
    assert report.passed, explain(report)
"""

from gear_kinematics.validation.findings import explain
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.task import Task, Tolerances
from gear_kinematics.validation.validate_bag import validate

__all__ = ['BagReport', 'Task', 'Tolerances', 'explain', 'validate']
