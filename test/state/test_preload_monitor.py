# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The diagnostics of the preload: margin, and time out of mesh."""

import math
from dataclasses import replace

from gear_kinematics.kinematics import RotorSample, split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.diagnostics import OK, WARN
from gear_kinematics.state.loads import Loads
from gear_kinematics.state.preload_monitor import PreloadMonitor

PARAMETERS = replace(NodeParameters.load(), preload=3.0, branch_stiffness=(2000.0,))
PERIOD = 1_000_000  # ns


def followed(torques):
    """Return the monitor after these torques of the output, N·m."""
    loads, monitor = Loads(PARAMETERS), PreloadMonitor(PARAMETERS)
    for k, torque in enumerate(torques):
        effort = None if math.isnan(torque) else torque / -19.0
        sample = RotorSample(k * PERIOD, split_turns(0.0), None, effort)
        monitor.follow(sample, loads.follow(sample, 0, whole=False))
    return monitor


def test_margin_falls_by_half_of_the_load_of_equal_branches():
    report = followed([0.0, 4.0, -2.0]).report()
    assert (report.level, report.message) == (OK, 'ok')
    assert report.values['margin (N·m)'] == '2'
    assert report.values['least margin (N·m)'] == '1'
    assert report.values['least margin (% of the preload)'] == '33.3'
    assert report.values['out of mesh (% of the time)'] == '0.0'


def test_time_out_of_mesh_is_a_warning_until_the_next_report():
    monitor = followed([0.0] * 76 + [8.0] * 25)
    report = monitor.report()
    assert report.level == WARN
    assert report.message == 'a branch was out of mesh for 25.0 % of the time'
    assert report.values['least margin (N·m)'] == '-1'
    assert 'preload' in report.values['advice']
    assert monitor.report().message == 'no input'


def test_without_effort_the_margin_is_unknown_and_no_warning():
    report = followed([math.nan, math.nan]).report()
    assert (report.level, report.message) == (OK, 'unknown: no effort in rotor_state')
