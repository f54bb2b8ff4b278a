# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Progress of live commands on a terminal, and Ctrl-C, which ends every command with 130."""

import os
import re
import signal
from itertools import product

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


REPORTS = '--json a.json --junit a.xml'
INT, TERM = signal.SIGINT, signal.SIGTERM


@pytest.mark.parametrize(('arguments', 'number'), [
    ('info BAG', INT), ('lost-motion BAG', INT), ('plot output a.png --bag BAG', INT),
    ('calibrate --encoder-topic /output_state BAG', INT), (f'validate {REPORTS} SERVO BAG', INT),
    # One handler has both signals: SIGTERM is sent where files or other processes have to go.
    *product(['compute BAG out --joint rotor', f'validate --jobs 2 {REPORTS} BAG'], [INT, TERM]),
])  # fmt: skip
def test_what_is_interrupted_while_it_reads_ends_at_once_and_leaves_nothing(
    arguments, number, tmp_path
):
    (folder := tmp_path / 'results').mkdir()
    with BlockedBag(SERVO, tmp_path / 'blocked') as blocked:
        paths = {'BAG': blocked.path, 'SERVO': SERVO}
        words = [paths.get(word, word) for word in arguments.split()]
        with running_gearkin(*words, cwd=folder) as process:
            blocked.reader()
            if 'compute' in words:
                assert list(folder.iterdir())  # it has begun to write
            if number == signal.SIGINT:
                os.killpg(process.pid, number)  # as a terminal does
            else:
                process.send_signal(number)
            output, errors = process.communicate(timeout=DEADLINE)
            assert (process.returncode, output, errors) == (130, '', '')
            wait_until(lambda: not blocked.readers(), 'the end of the processes')
    assert not list(folder.iterdir())


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
