# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin replay as a user runs it."""

import re

import pytest
from blocked_bags import gearkin, refusal

SAMPLES = 300


@pytest.mark.live
@pytest.mark.slow
def test_a_replay_tells_what_it_did(bags):
    done = gearkin('replay', bags / 'good', '--no-wait', '--rate', 10, '--start-offset', 0.1)
    assert (done.returncode, done.stderr) == (0, '')
    sent = int(re.fullmatch(r'(\d+) messages, at most [\d.]+ ms late\n', done.stdout)[1])
    assert 200 < sent < SAMPLES


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['missing.mcap'], 'missing.mcap: no such file or folder'),
        (['garbage.mcap'], 'garbage.mcap: not a bag of a known kind'),
        (['good', '--rate', '0'], 'rate must be positive'),
        (['good', '--rate', '-1'], 'rate must be positive'),
        (['good', '--start-offset', '-1'], 'start offset must not be negative'),
        (['good', '--start-offset', '1000'], 'good: nothing to play'),
        (['good', '--topics', '/nope'], 'good: no topic /nope in it; there are: '),
    ],
)
def test_a_replay_that_cannot_be_done_gets_one_line_and_code_2(
    arguments, cause, bags, monkeypatch
):
    monkeypatch.chdir(bags)
    assert cause in refusal('replay', '--no-wait', *arguments)
