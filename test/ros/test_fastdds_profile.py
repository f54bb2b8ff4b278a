# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The profile for Fast DDS: who chooses it, and that it spares a wakeup for every message."""

import os
from pathlib import Path

import pytest
from live import live_node, rotor_state, stamp_of

from gear_kinematics.ros.workarounds import fastdds_profile
from gear_kinematics.ros.workarounds.fastdds_profile import use_profile

pytestmark = pytest.mark.live

PROFILE = Path(__file__).resolve().parents[2] / 'config/fastdds.xml'
VARIABLE = 'FASTRTPS_DEFAULT_PROFILES_FILE'


@pytest.fixture(autouse=True)
def _nothing_chosen(monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, 'to restore it in the end')
    monkeypatch.delenv(VARIABLE)
    monkeypatch.delenv('SKIP_DEFAULT_XML_FILE', raising=False)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ('environment', 'in_the_folder', 'used'),
    [
        ({}, False, True),
        ({VARIABLE: '/my.xml'}, False, False),
        ({'FASTDDS_DEFAULT_PROFILES_FILE': '/my.xml'}, False, False),
        ({}, True, False),
        ({'SKIP_DEFAULT_XML_FILE': '1'}, True, True),
    ],
)
def test_profile_is_used_if_nobody_has_chosen_another(
    monkeypatch, tmp_path, environment, in_the_folder, used
):
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    if in_the_folder:
        (tmp_path / 'DEFAULT_FASTRTPS_PROFILES.xml').touch()
    use_profile()
    if used:
        assert Path(os.environ[VARIABLE]).read_bytes() == PROFILE.read_bytes()
    else:
        assert os.environ.get(VARIABLE) == environment.get(VARIABLE)


def test_other_middleware_gets_no_profile(monkeypatch):
    monkeypatch.setattr(
        fastdds_profile, 'get_rmw_implementation_identifier', lambda: 'rmw_cyclonedds_cpp'
    )
    use_profile()
    assert VARIABLE not in os.environ


def wakeups(pid: int) -> int:
    """Count how often the event threads of Fast DDS have waited."""
    tasks = Path(f'/proc/{pid}/task').iterdir()
    texts = [
        (task / 'status').read_text() for task in tasks if 'dds.ev' in (task / 'comm').read_text()
    ]
    if not texts:
        pytest.skip('the threads of this Fast DDS have no names')
    return sum(int(text.partition('\nvoluntary_ctxt_switches:')[2].split()[0]) for text in texts)


def wakeups_per_message(live) -> float:
    """Send messages one by one, each after the output_state to the one before."""
    peer, count = live.peer, 100
    outputs = peer.received['output_state']
    before = wakeups(live.process.pid)
    for _ in range(count):
        stamp = peer.stamp()
        peer.send(rotor_state(stamp, position=[1.0]))
        peer.wait_until(lambda s=stamp: outputs and stamp_of(outputs[-1]) == s, 'an output')
    return (wakeups(live.process.pid) - before) / count


def test_node_does_not_wake_up_a_thread_for_every_message(tmp_path):
    with live_node(tmp_path) as live:
        live.peer.connect()
        for subscription in live.peer._subscriptions[1:]:
            live.peer.node.destroy_subscription(subscription)
        # A thread wakes up at most 50 times a second: again if the machine is busier than that.
        live.peer.wait_until(lambda: wakeups_per_message(live) < 0.7, 'few wakeups')
    assert 'XMLPARSER' not in live.text()
