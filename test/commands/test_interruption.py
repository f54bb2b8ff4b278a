# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Progress of live commands on a terminal, and Ctrl-C, which ends every command with 130."""

import re
import signal

import pytest
from blocked_bags import BAGS, DEADLINE, BlockedBag, running_gearkin, wait_until
from live import Listener
from sensor_msgs.msg import JointState
from terminals import ENVIRONMENT, Terminal

pytestmark = pytest.mark.slow

SERVO = BAGS / 'servo_point_to_point'
COUNTS = re.compile(r' (\d+)/(\d+|\?) ')


def ended(process) -> tuple[int, str]:
    output, _ = process.communicate(timeout=DEADLINE)
    return process.returncode, output


def counts(terminal) -> list[tuple[str, str]]:
    """Give the counts that a progress bar has shown, without those before the start."""
    found = COUNTS.findall(re.sub(r'\x1b\[[\d;?]*[a-zA-Z]', '', terminal.shown()))
    return [(done, total) for done, total in found if done != '0']


@pytest.mark.parametrize('arguments', [
    ['info'], ['lost-motion'], ['calibrate', '--encoder-topic', '/output_state'],
    ['plot', 'output', 'a.png', '--bag'],
], ids=lambda words: words[0])  # fmt: skip
def test_ctrl_c_while_reading_gives_130(arguments, tmp_path):
    with (
        BlockedBag(SERVO, tmp_path / 'blocked') as blocked,
        running_gearkin(*arguments, blocked.path, cwd=tmp_path) as process,
    ):
        blocked.reader()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=DEADLINE)
    assert (process.returncode, output, errors) == (130, '', '')
    assert [path.name for path in tmp_path.iterdir()] == ['blocked']


@pytest.mark.live
@pytest.mark.parametrize(
    ('arguments', 'total'),
    [
        (['replay', SERVO, '--no-wait'], '3000'),
        (['replay', SERVO, '--no-wait', '--loop'], '?'),
        (['validate', '--live', SERVO], '3000'),
        (['demo'], '3000'),
    ],
    ids=lambda value: ' '.join(str(word) for word in value or '').replace(str(SERVO), ''),
)
def test_live_commands_show_a_total_and_end_with_130(arguments, total):
    for _ in range(10):
        with Terminal() as terminal:
            streams = {'stderr': terminal.other}
            if arguments[0] == 'demo':
                streams['stdout'] = terminal.other
            with running_gearkin(*arguments, env=ENVIRONMENT, **streams) as process:
                wait_until(lambda shown=terminal: counts(shown), 'its progress')
                process.send_signal(signal.SIGINT)
                code, _ = ended(process)
        if code:  # else it had ended before the signal, as on a busy machine
            break
    assert code == 130
    assert {shown for _, shown in counts(terminal)} == {total}


@pytest.mark.live
def test_a_topic_is_replayed_under_another_name_until_ctrl_c():
    listener = Listener('/renamed')
    try:
        listener.listen(JointState, 'motor', 2000, '/renamed/motor')
        words = ['--rotor-topic', '/output_state', '--joint', 'output_shaft']
        with running_gearkin('replay', SERVO, '--as', '/renamed/motor', *words) as process:
            heard = listener.received['motor']
            listener.wait_until(lambda: len(heard) > 20, 'messages')
            process.send_signal(signal.SIGINT)
            code, output = ended(process)
    finally:
        listener.close()
    assert code == 130
    assert output.endswith(' ms late\n')
    assert {tuple(message.name) for message in heard} == {('output_shaft',)}
