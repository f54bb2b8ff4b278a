# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The profile for Fast DDS: who chooses it, and that it spares a wakeup for every message."""

import os
import time
from pathlib import Path

import pytest
from live import live_node, rotor_state, stamp_of

from gear_kinematics.ros.workarounds import fastdds_profile
from gear_kinematics.ros.workarounds.fastdds_profile import use_profile

pytestmark = pytest.mark.live

CONFIG = Path(__file__).resolve().parents[2] / 'config'
FASTDDS_2 = '7.1.6', 'FASTRTPS_DEFAULT_PROFILES_FILE', 'fastdds.xml'
FASTDDS_3 = '9.1.2', 'FASTDDS_DEFAULT_PROFILES_FILE', 'fastdds3.xml'
VARIABLES = FASTDDS_2[1], FASTDDS_3[1]


@pytest.fixture(autouse=True)
def _nothing_chosen(monkeypatch, tmp_path):
    for variable in VARIABLES:
        monkeypatch.setenv(variable, 'to restore it in the end')
        monkeypatch.delenv(variable)
    monkeypatch.delenv('SKIP_DEFAULT_XML_FILE', raising=False)
    monkeypatch.chdir(tmp_path)


def chosen() -> dict[str, str]:
    return {name: os.environ[name] for name in VARIABLES if name in os.environ}


@pytest.mark.parametrize(('environment', 'in_the_folder', 'used'), [
    ({}, '', FASTDDS_2), ({}, '', FASTDDS_3), ({FASTDDS_2[1]: '/my.xml'}, '', FASTDDS_3),
    ({FASTDDS_3[1]: '/my.xml'}, '', FASTDDS_2), ({}, 'DEFAULT_FASTRTPS_PROFILES.xml', FASTDDS_2),
    ({}, 'DEFAULT_FASTDDS_PROFILES.xml', FASTDDS_3),
    ({'SKIP_DEFAULT_XML_FILE': '1'}, 'DEFAULT_FASTDDS_PROFILES.xml', FASTDDS_3),
])  # fmt: skip
def test_profile_is_used_if_nobody_has_chosen_another(
    monkeypatch, tmp_path, environment, in_the_folder, used
):
    release, variable, name = used
    monkeypatch.setattr(fastdds_profile, 'version', {'rclpy': release}.get)
    for other, value in environment.items():
        monkeypatch.setenv(other, value)
    if in_the_folder:
        (tmp_path / in_the_folder).touch()
    before = chosen()
    use_profile()
    if before or (in_the_folder and not environment):
        assert chosen() == before
    else:
        [(only, path)] = chosen().items()
        assert (only, Path(path).read_bytes()) == (variable, (CONFIG / name).read_bytes())


def test_other_middleware_gets_no_profile(monkeypatch):
    monkeypatch.setattr(
        fastdds_profile, 'get_rmw_implementation_identifier', lambda: 'rmw_cyclonedds_cpp'
    )
    use_profile()
    assert not chosen()


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
    before, begin = wakeups(live.process.pid), time.monotonic()
    for _ in range(count):
        stamp = peer.stamp()
        peer.send(rotor_state(stamp, position=[1.0]))
        peer.wait_until(lambda s=stamp: outputs and stamp_of(outputs[-1]) == s, 'an output')
    # A thread wakes up at most 50 times a second, also without a message.
    idle = 50.0 * (time.monotonic() - begin)
    return (wakeups(live.process.pid) - before - idle) / count


def test_node_does_not_wake_up_a_thread_for_every_message(tmp_path):
    with live_node(tmp_path) as live:
        live.peer.connect()
        for subscription in live.peer._subscriptions[1:]:
            live.peer.node.destroy_subscription(subscription)
        live.peer.wait_until(lambda: wakeups_per_message(live) < 0.7, 'few wakeups')
    # Fast DDS says in lines of its own what it does not like of the profile or of its variable.
    assert all('gear_state_publisher]: ' in line for line in live.text().splitlines()), live.text()
