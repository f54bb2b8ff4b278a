# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Live commissioning: what is said when, what is kept, and both forms beside a driver."""

import math
import re
import sys
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from blocked_bags import finished, wait_until
from chromium import chromium
from live import rotor_bytes
from simulated_encoders import Drive, sine_strokes, stamps
from terminals import Person
from watching import ENCODER, MOTOR, NODE, gearkin, node, parameters

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.commissioning.analysis import Channel, Request
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.parameters.arm_file import add_actuators
from gear_kinematics.watch import commissioning
from gear_kinematics.watch.commissioning import GUIDE, LiveCommissioning
from gear_kinematics.watch.view import Entry

# Without ROS


def hear(monkeypatch, degrees, ratio='', *, seconds=8.0, most=10_000, **asked):
    """Turn the output of a gear there and back, and give what was made of it.

    Its rotor is on a topic at 250 Hz, its output in the same messages.
    """
    drive = Drive(play=1e-4, ratio=-121.0, noise=1e-5)
    times, rotor, output = drive.readings(sine_strokes(np.radians(degrees), 2.0), seconds, 250.0)
    messages = [
        ('/j', stamp, rotor_bytes(stamp, ('m', 'o'), both))
        for stamp, *both in zip(map(int, stamps(times)), rotor, output, strict=True)
    ]
    messages.append(('/other', 0, b'of another driver'))
    monkeypatch.setattr(commissioning, '_MOST_STATES', most)
    monkeypatch.setattr(commissioning, '_PAUSE', 0.0)
    given = GearRatio.parse(ratio) if ratio else None
    request = Request(rotor=Channel('/j', 'm'), output=Channel('/j', 'o'), ratio=given)
    live = LiveCommissioning(replace(request, **asked))
    for start in range(0, len(messages), 500):
        live.take(messages[start : start + 500])

    def all_shown():
        live.take([])
        return [e.value for e in live.shown.entries][:1] == [f'{len(messages) - 1} messages']

    wait_until(all_shown, 'the analysis')
    return live


@pytest.mark.parametrize(
    ('degrees', 'ratio', 'advice', 'known'),
    [
        (0.0, '', GUIDE, 0.0),
        (40.0, '121', GUIDE, 0.5 * 40.0 / 60.0 + 0.5),
        (40.0, '', GUIDE, 0.5 * 40.0 / 60.0 + 0.25),
        (
            90.0,
            '',
            r'The ratio is undetermined: -1[0-9]{2}.* turn the output by 390° or more, .*',
            0.75,
        ),
        (90.0, '100', 'The given ratio 100 does not agree with the measured -12.*', 0.75),
        (90.0, '121', r'The gear has the ratio 121 .*', 1.0),
    ],
)
def test_advice_and_bar_follow_what_is_known(monkeypatch, degrees, ratio, advice, known):
    shown = hear(monkeypatch, degrees, ratio).shown
    assert re.fullmatch(advice, shown.advice)
    assert shown.known == pytest.approx(known, abs=0.01)
    turned = f'the output turned {degrees:.0f}° forward and {degrees:.0f}° backward'
    assert shown.entries[0] == Entry('heard', '2000 messages', turned)


def shown_of(monkeypatch, times, rotor, output):
    """Give what is shown of angles, rad, at times, s, that come all at once."""
    monkeypatch.setattr(commissioning, '_PAUSE', 0.0)
    stamped = zip(map(int, stamps(times)), rotor, output, strict=True)
    live = LiveCommissioning(Request(rotor=Channel('/j', 'm'), output=Channel('/j', 'o')))
    live.take([('/j', s, rotor_bytes(s, ('m', 'o'), both)) for s, *both in stamped])

    def analysed():
        live.take([])
        return live.shown.known > 0.0

    wait_until(analysed, 'the analysis')
    return live.shown


@pytest.mark.parametrize(('rate', 'known'), [(100, True), (40, False)])
def test_wraps_are_counted_at_any_speed_or_named_as_too_fast(monkeypatch, rate, known):
    times = np.arange(0.0, 8.0, 1.0 / rate)
    rotor = 25.0 * math.tau * (1.0 - np.cos(times * math.tau / 8.0))  # up to 123 rad/s
    shown = shown_of(monkeypatch, times, np.mod(rotor, math.tau), rotor / -19.0)
    assert (shown.known == 1.0) is known
    said = 'The gear has the ratio -19' if known else 'the position wraps too fast'
    assert shown.advice.startswith(said)


def test_what_to_avoid_in_another_recording_is_named(monkeypatch):
    """The angle of the output is computed, as in messages of a node."""
    times = np.arange(0.0, 12.0, 0.004)
    rotor = 80.0 * np.sin(0.7 * times)
    shown = shown_of(monkeypatch, times, rotor, rotor / 101.0 + 0.3)
    assert 'record it anew without these faults' in shown.advice
    assert 'as if it were computed from it' in shown.entries[0].detail


def test_ratio_that_was_shown_is_not_lost_with_later_messages(monkeypatch):
    live = hear(monkeypatch, 90.0, '121')
    # As after many messages in a row were lost, across which the rotor cannot be unwrapped.
    later = replace(live.result(), between=None)
    monkeypatch.setattr(live, '_analyse', lambda: later)
    kept = live.result()
    assert str(kept.between) == '-121'
    assert str(kept.notes[-1]) == f'With the messages that came later: {later.answer}'
    later = replace(later, request=replace(later.request, ratio=GearRatio.parse('100')))
    assert not live.result().between  # which is another question


def test_file_has_the_zero_of_the_end(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    live = hear(monkeypatch, 90.0, '121', seconds=7.0, zero_here='END')
    assert '--params-file actuator.yaml -r rotor_state:=/j' in live.write()
    at_end = live.result().longest.encoders.measured[-1]
    assert abs(at_end) > 0.1
    zero = NodeParameters.load(tmp_path / 'actuator.yaml').output_encoder_zero
    assert zero == pytest.approx(at_end, abs=1e-8)


def test_gear_is_added_to_the_file_of_an_arm(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / 'actuator.yaml'
    add_actuators(path, {'elbow': ["gear_ratio: '50'"]}, ())
    live = hear(monkeypatch, 90.0, '121')
    live.write('shoulder')
    ratios = {name: each.gear_ratio for name, each in load_actuators(path).items()}
    assert ratios == {'elbow': '50', 'shoulder': '121'}
    with pytest.raises(ValueError, match='shoulder is in it already'):
        live.write('shoulder')


def test_node_of_another_gear_is_not_changed(monkeypatch):
    live = hear(monkeypatch, 90.0, '121')
    other = SimpleNamespace(name='/g', parameters=NodeParameters.load(), hears=lambda _: False)
    with pytest.raises(ValueError, match='/g does not listen to /j and /j: write the file'):
        live.changes(other)


def test_memory_is_bounded(monkeypatch):
    live = hear(monkeypatch, 90.0, '121', most=1000)
    assert live.shown.known == 1.0
    joint = live.result().longest
    assert 250 <= len(joint.encoders.rotor.stamp) <= 500
    assert joint.recording.remarks[0].values['every'] == 4


# Beside a driver

beside_driver = pytest.mark.usefixtures('driver')
LIVE = ('commission', '--live', '--rotor-topic', MOTOR, '--joint', 'm1', '--ratio=-19')
WITHOUT_EXTRAS = """
import sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split('.')[0] in ('scipy', 'matplotlib', 'plotly', 'rosbags', 'tornado'):
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)
sys.meta_path.insert(0, Missing())
from gear_kinematics.commands.cli import main
sys.exit(main())
"""


@pytest.mark.live
@beside_driver
def test_in_a_pipe_it_ends_by_itself_and_needs_no_extra(tmp_path):
    command = [sys.executable, '-P', '-c', WITHOUT_EXTRAS, *LIVE, '--encoder-topic', ENCODER]
    begin = time.monotonic()
    done = finished(command, cwd=tmp_path, timeout=240.0)
    assert done.returncode == 0, done.stderr
    lines = done.stderr.splitlines()
    assert re.search(
        r' 100% The gear has the ratio -19 .*; heard \d+ messages \(the output turned ', lines[-1]
    )
    assert len([line for line in lines if '% ' in line]) < time.monotonic() - begin + 2.0
    found = NodeParameters.load(tmp_path / 'actuator.yaml')
    assert (found.rotor_joint, found.gear_ratio, found.rotor_encoder) == (
        'm1',
        '-19',
        'multi_turn',
    )


@pytest.mark.live
@beside_driver
def test_in_a_terminal_it_asks_and_interrupted_leaves_nothing(tmp_path):
    with Person(tmp_path, 'commission', '--live', '--encoder-topic', ENCODER) as terminal:
        choice = terminal.wait_for(rf'\d  m1 on {MOTOR}')
        terminal.wait_for('Number of the joint of the rotor: ')
        terminal.type(f'{choice[0]}\n')
        terminal.wait_for('Turn the output by hand')
        terminal.wait_for(r'heard +[1-9]\d+ messages +the output turned')
        terminal.interrupt()
        assert terminal.end() == 130
        assert 'Traceback' not in terminal.shown()
    assert not list(tmp_path.iterdir())


def within_its_errors(page, expect) -> bool:
    """Apply what is found to the node and undo it; tells whether both new zeros agree."""
    answer, undo = page.locator('#answer'), page.locator('#undo')
    page.get_by_role('button', name='Apply to the running node').click()
    # An output that is within 1° of the node's zero at that moment leaves it.
    changed = re.compile(
        f'Changed in {NODE}: output_encoder_joint(, output_encoder_zero)?, rotor_zero. '
        'Write the file to keep it after a restart.'
    )
    expect(answer).to_have_text(changed)
    names = 'output_encoder_joint', 'output_encoder_zero', 'rotor_zero'
    joint, zero, rotor_zero = parameters(*names)
    assert joint == 'shaft'
    expect(undo).to_have_text(
        "Undo back to rotor_zero 0, output_encoder_joint ''"
        + bool(zero) * ', output_encoder_zero 0'
    )
    undo.get_by_role('button').click()
    expect(answer).to_contain_text('Undone: ')
    expect(undo).not_to_contain_text("output_encoder_joint ''")  # nor is a command refused
    assert parameters(*names) == ['', 0.0, 0.0]
    return zero != 0.0 and abs(rotor_zero + 19 * zero) <= 19 * 2e-4


@pytest.mark.live
@pytest.mark.slow
@beside_driver
def test_page_guides_writes_and_applies_to_the_node(tmp_path):
    sync_api = pytest.importorskip('playwright.sync_api', reason='no playwright is installed')
    pytest.importorskip('tornado', reason='no tornado is installed')
    with (
        chromium() as browser,
        gearkin(tmp_path, 'watch', '--node', NODE) as program,
        node(tmp_path),
    ):
        page = browser.new_page()
        page.set_default_timeout(60_000.0)
        page.goto(program.wait_for(r'Open (http://127\.0\.0\.1:\d+/[\w-]+/)')[1])
        page.locator('#commission summary').click()
        page.locator('select[name=rotor]').select_option(f'm1 on {MOTOR}')
        page.locator('select[name=output]').select_option(f'shaft on {ENCODER}')
        page.locator('input[name=ratio]').fill('nineteen')
        page.get_by_role('button', name='Start').click()
        answer = page.locator('#answer')
        sync_api.expect(answer).to_contain_text('a gear ratio must be an integer')
        page.locator('input[name=ratio]').fill('19')
        page.get_by_role('button', name='Start').click()
        guide = page.locator('#guide')
        sync_api.expect(guide).to_contain_text('The gear has the ratio 19')
        assert page.locator('#guide progress').evaluate('bar => bar.value') == 1.0
        page.get_by_role('button', name='Write actuator.yaml').click()
        sync_api.expect(answer).to_contain_text(f'actuator.yaml -r rotor_state:={MOTOR}')
        page.get_by_role('button', name='Apply to the running node').click()
        sync_api.expect(answer).to_have_text(
            'Nothing was changed: a restart is needed for gear_ratio 19. '
            'Write the file and restart.'
        )
        assert parameters('rotor_direction', 'output_encoder_joint') == [1, '']
        page.locator('input[name=ratio]').fill('-19')
        page.locator('select[name=zero]').select_option('END')
        page.get_by_role('button', name='Change').click()
        sync_api.expect(guide).to_contain_text('the output angle is 0 at')
        # Where a busy machine has lost messages, the angle of the last one is interpolated.
        wait_until(lambda: within_its_errors(page, sync_api.expect), 'zeros that agree')
        page.get_by_role('button', name='End').click()
        sync_api.expect(guide).to_be_hidden()
    assert "gear_ratio: '19'" in (tmp_path / 'actuator.yaml').read_text('utf-8')
