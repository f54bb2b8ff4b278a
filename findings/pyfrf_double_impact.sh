#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyFRF 1.5.0: one clean blow of 2 ms is a double impact in a record of 2 s, and two blows of 1 ms are none in 10 s.
#
# An arm is struck by a hammer, whose force is half a sine without any noise. Expected of is_data_ok(): that it is
# true for one blow, and false if a second one of half the force comes 30 ms later. What happens: its result depends
# on how long the record and the blow are. The check transforms one half of the spectrum of the force again, which
# leaves traces of any blow at all later times, and looks for the second blow beyond a hundredth of this transform: 10
# ms in a record of 2 s, and 50 ms in one of 10 s. A blow of 2 ms or longer, as of a soft tip, is refused in 2 s, one
# of 1 ms in 1 s, and the double blow of 1 ms is ok in 10 s. Its limit, 0.001, is documented, but not that it depends on
# the record: with 0.05 the blows are told apart in 1 s and 2 s, but the double blow is still ok in 10 s.
# For us: give is_data_ok() the first 2 s of each record and double_impact_limit=0.05.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyFRF==1.5.0 numpy==2.4.6 scipy==1.17.1
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pyFRF import FRF

RATE = 10_000


def is_ok(seconds, duration, second, **limit):
    times = np.arange(RATE * seconds) / RATE
    force = np.zeros(len(times))
    for start, height in (0.05, 1.0), (0.08, second):
        part = (times - start) / duration
        force += height * np.where((part >= 0) & (part <= 1), np.sin(np.pi * part), 0)
    response = np.exp(-times) * np.sin(50 * times)
    return bool(FRF(RATE, exc_type='f', resp_type='a', fft_len=len(times)).is_data_ok(force[None], response[None], **limit))


for seconds, duration, one, two in (
    (1, 0.001, False, False),
    (2, 0.001, True, False),
    (2, 0.002, False, False),
    (2, 0.005, False, False),
    (10, 0.001, True, True),
    (10, 0.002, True, True),
):
    found = is_ok(seconds, duration, 0.0), is_ok(seconds, duration, 0.5)
    print(f'blows of {1000 * duration:.0f} ms in {seconds} s: one is {found[0]}, two are {found[1]}')
    assert found == (one, two)
    raised = [is_ok(seconds, duration, second, double_impact_limit=0.05) for second in (0.0, 0.5)]
    print('with a limit of 0.05', raised)
    assert raised == [True, seconds == 10]
PYTHON
