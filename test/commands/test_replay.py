# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin replay as a user runs it."""

import re

import pytest
from blocked_bags import gearkin, refusal

SAMPLES = 300


@pytest.mark.live
@pytest.mark.slow
def test_a_replay_tells_what_it_did(bags):
    done = gearkin('replay', bags / 'good', '--no-wait', '--rate', 10)
    assert (done.returncode, done.stderr) == (0, '')
    assert re.fullmatch(rf'{SAMPLES} messages, at most [\d.]+ ms late\n', done.stdout)


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['missing.mcap'], 'missing.mcap: no such file or folder'),
        (['garbage.mcap'], 'garbage.mcap: not a bag of a known kind'),
        (['good', '--rate', '0'], 'rate must be positive'),
        (['good', '--as', '/x y'], 'Invalid topic name'),
    ],
)
def test_a_replay_that_cannot_be_done_gets_one_line_and_code_2(
    arguments, cause, bags, monkeypatch
):
    monkeypatch.chdir(bags)
    assert cause in refusal('replay', '--no-wait', *arguments)
