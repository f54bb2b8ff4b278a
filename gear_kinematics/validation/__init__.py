# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the outputs of a node with recomputed ones.

In a test of another package:

    report = validate('logs/monday', 'actuator.yaml')
    assert report.passed, explain(report)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gear_kinematics.validation.findings import explain
    from gear_kinematics.validation.report import BagReport
    from gear_kinematics.validation.task import Task, Tolerances
    from gear_kinematics.validation.validate_bag import validate

__all__ = ['BagReport', 'Task', 'Tolerances', 'explain', 'validate']

_MODULES = {
    'BagReport': 'report',
    'Task': 'task',
    'Tolerances': 'task',
    'explain': 'findings',
    'validate': 'validate_bag',
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is used, as most commands need few of them."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.{_MODULES[name]}'), name)
