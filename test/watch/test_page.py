# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The page of `gearkin watch` in Chromium, beside a live node and a driver."""

import asyncio
import math
import re
import threading
from contextlib import contextmanager

import pytest
from chromium import expect, noting
from live import Listener
from watching import (
    DEADLINE,
    MOTOR,
    NAMESPACE,
    NODE,
    OTHER,
    RATIO,
    WatcherStandIn,
    gearkin,
    node,
    parameters,
)

from gear_kinematics.watch.view import Entry, Guide, View

pytestmark = [pytest.mark.live, pytest.mark.slow, pytest.mark.usefixtures('driver')]

pytest.importorskip('tornado', reason='no tornado is installed')
from gear_kinematics.watch.server import Server  # noqa: E402, needs it

# Without the page of a driver, which draws all the time


@contextmanager
def shown(browser, view):
    """Open a page of one view, and give it with what it is asked for."""
    ended, watcher = threading.Event(), WatcherStandIn(view)
    server = Server(watcher)
    thread = threading.Thread(target=lambda: asyncio.run(server.run(ended.is_set)))
    thread.start()
    page = browser.new_page()
    try:
        page.goto(server.address)
        yield page, watcher.asked
    finally:
        page.close()
        ended.set()
        thread.join(DEADLINE)


def test_names_are_text_on_the_page(browser):
    hostile = '<img src=x onerror=alert(1)>'
    view = View(
        node=hostile,
        state='connected',
        message=hostile,
        values=(Entry(hostile, hostile, hostile),),
        diagnostics=(Entry(hostile, hostile),),
        drivers=(Entry(hostile, hostile, hostile),),
        joints=((hostile, hostile), (hostile, 'b')),
        guide=Guide(hostile, 0.5, (Entry(hostile, hostile, hostile),)),
        output=-1e-9,
    )
    with shown(browser, view) as (page, _):
        parts = '#node', '#message', '#values dt', '#values dd', '#diagnostics dd', '#drivers dt'
        for part in (*parts, '#drivers dd', '#guide p', '#guide .detail', '#guide dd'):
            expect(page.locator(part).first).to_have_text(hostile)
        option = page.locator('#commission option').first
        expect(option).to_have_text(f'{hostile} on {hostile}')
        assert page.locator('img').count() == 0
        caption = page.locator('#curve figcaption')
        expect(caption).to_have_text('output angle, 10 s: 0.0 to 0.0°')


def test_a_question_that_was_cancelled_just_before_does_not_home_as_well(browser):
    with shown(browser, View(state='connected', question='Set it?', revision=7)) as (page, asked):
        expect(page.locator('#home')).to_be_enabled()
        page.evaluate("""for (const answer of ['Cancel', 'Set it']) {
            document.getElementById('home').click();
            const buttons = [...document.querySelectorAll('#question button')];
            buttons.find(button => button.textContent === answer).click();
        }""")
        expect(page.locator('#answer')).to_have_text('home.')
        page.evaluate('new Promise(done => requestAnimationFrame(() => setTimeout(done)))')
        page.get_by_role('button', name='Home').click()
        page.get_by_role('button', name='Cancel').click()
    assert asked == [{'do': 'home', 'revision': 7}]


# Beside a driver


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('watch')


@pytest.fixture(scope='module')
def page(browser, folder):
    """Give the page as it was opened before there was a node, with all that it asked for."""
    with gearkin(folder, 'watch', '--node', NODE) as program:
        address = program.wait_for(r'Open (http://127\.0\.0\.1:\d+/[\w-]+/)')[1]
        size = {'width': 1280, 'height': 900}
        page = noting(browser.new_page(viewport=size, color_scheme='light'))
        page.set_default_timeout(60_000.0)
        page.goto(address)
        yield page
        assert page.seen == [address]
    assert program.process.returncode == 130
    assert 'Traceback' not in program.text()


@pytest.fixture(scope='module')
def connected(page, folder):
    """Give the page when it shows the node."""
    with node(folder) as process:
        expect(page.locator('#state')).to_have_text('connected')
        expect(page.locator('#diagnostics')).to_contain_text('rotor inputhealthy')
        page.node = process
        yield page


def reading(page, name):
    return page.locator('#values > div').filter(has_text=name)


def angles(page) -> tuple[float, float]:
    """Give the drawn angles of rotor and output at one moment, degrees."""
    texts = page.locator('#mechanism').evaluate(
        'e => ["--rotor", "--output"].map(name => e.style.getPropertyValue(name))'
    )
    return tuple(float(text.removesuffix('deg')) for text in texts)


def test_page_lists_drivers_before_there_is_a_node(page):
    motor = page.locator('#drivers dl > div').filter(has_text=MOTOR)
    expect(motor).to_have_text(re.compile(rf'^{MOTOR}brake, m1[1-9]\d+ Hz$'))
    expect(page.locator('#message')).to_contain_text(f'{NODE} is not running')
    expect(page.locator('#home')).to_be_disabled()


def test_mechanism_moves_as_the_gear_ratio_says(connected):
    for branch in ('a', 'b'):
        assert connected.locator(f'svg[aria-label="branch {branch}"] use').count() == 5
    seen = []
    for _ in range(5):
        before = angles(connected)
        connected.wait_for_function(
            'before => document.getElementById("mechanism").style'
            '.getPropertyValue("--rotor") !== before',
            arg=f'{before[0]}deg',
        )
        seen.append(before)
    assert len(set(seen)) > 1
    for rotor, output in seen:
        assert abs(math.remainder(rotor - RATIO * output, 360.0)) < 1e-6
    drawn = connected.locator('.upright .rotor').first
    assert drawn.evaluate('e => getComputedStyle(e).transform').startswith('matrix(')


def test_values_of_the_driver_and_of_both_encoders_are_shown(connected):
    expect(reading(connected, 'output angle')).to_contain_text('°')
    expect(reading(connected, 'output rate')).to_contain_text(re.compile(r'[1-9]\d+ Hz'))
    # Twice the amplitude of 1e-4 rad.
    expect(reading(connected, 'transmission error')).to_contain_text(
        re.compile(r'peak to peak 0\.00019\d* rad')
    )
    caption = connected.locator('#curve figcaption')
    expect(caption).to_have_text(re.compile(r'output angle, 10 s: -?\d+\.\d to -?\d+\.\d°'))


@pytest.mark.usefixtures('connected')
def test_node_has_to_compute_only_what_is_shown():
    listener = Listener('/elsewhere', 'counting')
    count = listener.node.count_subscribers
    try:
        wanted = '/diagnostics', f'{NAMESPACE}/output_state'
        found = lambda: [*map(count, wanted)] == [1, 1]  # noqa: E731
        listener.wait_until(found, 'the subscriptions of the page')
        for topic in ('body_poses', 'mechanism_joint_states', 'markers', 'robot_description'):
            assert count(f'{NAMESPACE}/{topic}') == 0
    finally:
        listener.close()


def test_home_is_asked_called_and_undone_with_the_keyboard(connected):
    question = connected.locator('#question')
    home, answer = connected.locator('#home'), connected.locator('#answer')
    connected.locator('body').click(position={'x': 5, 'y': 5})
    connected.keyboard.press('Tab')
    expect(home).to_be_focused()
    connected.keyboard.press('Enter')
    expect(question).to_have_text(
        re.compile(r'The output is at -?\d+\.\d°\. Set it to 0\.0°\?\s+Cancel\s+Set it')
    )
    connected.keyboard.press('Escape')
    expect(question).to_be_hidden()
    expect(home).to_be_focused()
    for _ in range(2):  # as a key that is held down
        connected.keyboard.press('Enter')
    expect(question).to_be_hidden()
    assert answer.inner_text() == ''

    for key in ('Enter', 'Tab', 'Enter'):
        connected.keyboard.press(key)
    expect(answer).to_have_text(
        re.compile(
            r'the shaft was at -?\d+\.\d° and is now at 0\.0° \(rotor_zero -?\d+\.\d{3} rad, '
            r'lost at restart: set home_file\)\.'
        )
    )
    shown = float(re.search(r'rotor_zero (\S+) rad', answer.inner_text())[1])
    assert shown == pytest.approx(*parameters('rotor_zero'), abs=6e-4) != 0.0
    expect(reading(connected, 'zero')).to_have_text(
        f'zero{shown:.3f} radlost at restart: set home_file'
    )
    connected.get_by_role('button', name='Undo').focus()
    connected.keyboard.press('Enter')
    expect(answer).to_have_text('Undone: back to rotor_zero 0.')
    expect(connected.locator('#undo')).not_to_have_text('Undo back to rotor_zero 0')
    assert parameters('rotor_zero') == [0.0]


def test_another_node_is_chosen_from_those_that_run(connected, folder):
    nodes = connected.locator('#nodes')
    expect(nodes).to_be_hidden()
    expect(connected.locator('#node')).to_have_text(f'{NODE}: m1, ratio -19')
    with node(folder, OTHER):
        expect(nodes.locator('option').last).to_have_text(f'{OTHER}: m1, ratio -19')
        for name in (OTHER, NODE):
            nodes.select_option(name)
            expect(nodes).to_have_value(name)
            expect(connected.locator('#home')).to_be_enabled()
    expect(nodes).to_be_hidden()


def test_phone_shows_everything_within_its_width(connected):
    connected.set_viewport_size({'width': 390, 'height': 844})
    try:
        assert connected.evaluate('document.documentElement.scrollWidth') == 390
        for part in ('#home', '#values > :first-child', '#mechanism'):
            box = connected.locator(part).bounding_box()
            assert box['x'] >= 0.0
            assert box['x'] + box['width'] <= 390.0
        assert connected.locator('#home').bounding_box()['height'] >= 40.0  # for a finger
        above = connected.locator('#values').bounding_box()['y']
        assert above < connected.locator('#mechanism').bounding_box()['y']
    finally:
        connected.set_viewport_size({'width': 1280, 'height': 900})


def test_dark_mode_is_dark_and_can_be_read(connected):
    connected.emulate_media(color_scheme='dark')
    try:
        for part in ('body', '#home', '#values dd', '#values .detail', '#node'):
            contrast = connected.locator(part).first.evaluate(CONTRAST)
            assert contrast >= 4.5, part
        background = 'e => getComputedStyle(e).backgroundColor'
        assert connected.locator('body').evaluate(background) == 'rgb(20, 23, 27)'
    finally:
        connected.emulate_media(color_scheme='light')


CONTRAST = """element => {
    const light = colour => {
        const [r, g, b] = colour.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255)
            .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    let ground = element;
    while (getComputedStyle(ground).backgroundColor === 'rgba(0, 0, 0, 0)') {
        ground = ground.parentElement;
    }
    const colours = [getComputedStyle(element).color, getComputedStyle(ground).backgroundColor];
    const both = colours.map(light);
    return (Math.max(...both) + 0.05) / (Math.min(...both) + 0.05);
}"""
"""Contrast as WCAG 2 defines it."""


def test_page_connects_again_after_the_node_was_restarted(connected, folder):
    connected.locator('#home').click()
    connected.get_by_role('button', name='Set it').click()
    expect(connected.locator('#undo')).to_have_text('Undo back to rotor_zero 0')
    connected.node.terminate()
    expect(connected.locator('#state')).to_have_text('ended')
    expect(connected.locator('#message')).to_contain_text('Waiting for it to start again.')
    expect(connected.locator('#home')).to_be_disabled()
    with node(folder):
        expect(connected.locator('#state')).to_have_text('connected')
        expect(connected.locator('#diagnostics')).to_contain_text('rotor inputhealthy')
        lost = re.compile(r'homed before; the zero is lost: it was -?\d+\.\d{3} rad')
        expect(reading(connected, 'zero')).to_contain_text(lost)
        expect(connected.locator('#undo')).to_be_hidden()
        rotor, _ = angles(connected)
        connected.wait_for_function(
            'before => document.getElementById("mechanism").style'
            '.getPropertyValue("--rotor") !== before',
            arg=f'{rotor}deg',
        )
