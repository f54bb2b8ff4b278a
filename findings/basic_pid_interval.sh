#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# basic-pid 0.2.7: at 100 Hz, an integral acts 100 times too strongly and a derivative 100 times too weakly.
#
# setTimeinc() takes the time between two updates, "in whatever time unit signal is in". With 0.01 s, in the mode in
# which the controller integrates by itself, an error of 1 rad that lasts for 1 s has an integral of 1 rad·s. Expected
# with an integral gain of 1: 1. What happens: 99.5, as with each other time, 0.001 s or 10 s. Of an error that grows by
# 1 rad/s, a derivative gain of 1 makes 0.01 instead of 1. getTimeinc() gives the time back, but it is used nowhere.
# For us: multiply the integral gain by the time between two updates, and divide the derivative gain by it, beforehand.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check basic-pid==0.2.7
cd "$folder"
venv/bin/python - <<'PYTHON'
from basicpid import BasicPid


def output(gains, interval, errors):
    """The output after these errors in rad, one each interval in s."""
    controller = BasicPid()
    controller.setIntegrateModeOn()
    controller.setGains(*gains)
    controller.setTimeinc(interval)
    assert controller.getTimeinc() == interval
    return [controller.pid(error, 0.0) for error in errors][-1]


constant, growing = [1.0] * 100, [0.01 * sample for sample in range(100)]
integral, derivative = output((0.0, 1.0, 0.0), 0.01, constant), output((0.0, 0.0, 1.0), 0.01, growing)
print(f'integral of 1 rad over 1 s: {integral}, expected 1; derivative of 1 rad/s: {derivative:.4f}, expected 1')
assert integral == 99.5 and abs(derivative - 0.01) < 1e-9
assert output((0.0, 1.0, 0.0), 0.001, constant) == output((0.0, 1.0, 0.0), 10.0, constant) == 99.5
PYTHON
