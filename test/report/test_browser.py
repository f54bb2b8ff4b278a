# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report in a browser: what it shows first, on a phone too; the mechanism moves, and is where
50 digits say.
"""

import math
from dataclasses import replace

import numpy as np
import oracle
import pytest
import report_samples as samples
from chromium import expect, noting

from gear_kinematics import plotting
from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.report.document import Figure, Line, Panel, Pen, Section, Table
from gear_kinematics.report.html import to_html
from gear_kinematics.shape.outlines import bodies
from gear_kinematics.validation.document import document
from gear_kinematics.validation.findings import sentence
from gear_kinematics.validation.report import Series

pytestmark = pytest.mark.slow

PIXEL = 1.0
TIMES = [0.25 * k for k in range(41)]
ANGLES = [0.3 * k**2 - 2.0 * k for k in range(38)] + [1e4, -1e7, 2.0**40]
"""Angles of the rotor, rad: there and back, half turns in a step, and far away."""
MECHANISMS = (
    (Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi))), 0.0005),
    (Mechanism(11, 8, 0.004, (Branch('a', 0.4), Branch('b', 2.9), Branch('c', -1.3))), 0.0025),
)
"""Each with the module of its teeth."""


@pytest.fixture(scope='module')
def tab(browser, tmp_path_factory):
    series = Series('/output_state', TIMES, ANGLES, {'position': [0.0] * 41})
    reports = [
        replace(samples.PASSING, series=(series,), mechanism=mechanism, module=module)
        for mechanism, module in MECHANISMS
    ]
    path = tmp_path_factory.mktemp('page') / 'report.html'
    path.write_text(to_html(document(reports)), 'utf-8')
    tab = browser.new_page(viewport={'width': 1280, 'height': 900}, color_scheme='light')
    visit(tab, path)
    return tab


def visit(tab, path):
    """Open a page, which loads nothing but itself and complains about nothing."""
    noting(tab).goto(path.as_uri())
    assert tab.seen == [path.as_uri()]
    tab.seen.clear()


@pytest.fixture(params=[0, 1], ids=['80-76', '11-8'])
def report(tab, request):
    """Give a mechanism with its module, and the section of the page that is about its bag."""
    yield MECHANISMS[request.param], tab.locator(f'#section-{request.param}')
    assert tab.seen == []


def select(section, sample):
    section.locator('.figure').scroll_into_view_if_needed()  # that is when it is drawn
    section.locator('input').fill(str(sample))
    expect(section.locator('output')).to_have_text(f'{TIMES[sample]:.4f} s')


def middles(section, selector):
    """Find the middles of elements, px: (n, 2), y upwards."""
    boxes = [element.bounding_box() for element in section.locator(selector).all()]
    return np.array([[b['x'] + b['width'] / 2, -b['y'] - b['height'] / 2] for b in boxes])


def assert_is_where_it_should_be(drawn_mechanism, section, sample):
    mechanism, module = drawn_mechanism
    phases = tuple((branch.cam_phase, 0.0) for branch in mechanism.branches)
    numbers = oracle.Numbers(
        mechanism.ring_teeth, mechanism.satellite_teeth, mechanism.eccentricity, phases
    )
    motion = oracle.expected_motion(numbers, oracle.rotor_angle_of(ANGLES[sample]))
    rim = max(np.max(outline[:, 0]) for outline in bodies(mechanism, module)['stator'])
    drawn = section.locator('use.stator').first.bounding_box()['width']
    axes = middles(section, '.output_shaft.centre')
    for body in ('satellite', 'oldham'):
        centres = (middles(section, f'.{body}.centre') - axes) * 2 * rim / drawn
        expected = [getattr(branch, f'{body}_centre') for branch in motion.branches]
        assert len(centres) == len(expected)
        for centre, point in zip(centres, expected, strict=True):
            assert oracle.point_error(centre, point, 1.0) < PIXEL * 2 * rim / drawn
    turns = section.locator('use.satellite').evaluate_all(
        'all => all.map(one => [one.getScreenCTM().a, -one.getScreenCTM().b])'
    )
    assert len(turns) == len(mechanism.branches)
    for cosine, sine in turns:
        turn = math.atan2(sine, cosine)
        assert oracle.turn_angle_error(turn, motion.output_angle) < PIXEL * 2 / drawn


def plot(section):
    """Find the area of the uppermost plot, px."""
    return section.locator('.nsewdrag').first.bounding_box()


def x_of(area, sample):
    return area['x'] + area['width'] * TIMES[sample] / TIMES[-1]


def test_slider_moves_the_mechanism_and_the_cursor_of_the_plots(report):
    _, section = report
    for sample in (0, 7, 13, 22, 37, 38, 39, 40):
        select(section, sample)
        assert_is_where_it_should_be(*report, sample)
        cursor = section.locator('.shapelayer path').last.bounding_box()
        middle = cursor['x'] + cursor['width'] / 2
        assert middle == pytest.approx(x_of(plot(section), sample), abs=PIXEL)
        assert cursor['height'] > 2 * plot(section)['height']


def test_cursor_in_the_plots_moves_the_mechanism(tab, report):
    _, section = report
    section.locator('.figure').scroll_into_view_if_needed()
    area = plot(section)
    for sample in (30, 11):
        tab.mouse.move(x_of(area, sample), area['y'] + area['height'] / 2)
        expect(section.locator('output')).to_have_text(f'{TIMES[sample]:.4f} s')
        expect(section.locator('input')).to_have_value(str(sample))
        assert_is_where_it_should_be(*report, sample)
    tab.mouse.move(0, 0)


def test_it_plays_to_the_end_and_from_the_start_again_until_it_is_paused(report):
    _, section = report
    select(section, 38)
    shown, button = section.locator('input'), section.locator('.controls button')
    section.locator('select').select_option('100')
    button.click()
    expect(shown).to_have_value('40')
    expect(button).to_have_text('Play')
    section.locator('select').select_option('0.0001')
    button.click()
    expect(shown).to_have_value('0')
    expect(section.locator('output')).not_to_have_text('0.0000 s')
    expect(button).to_have_text('Pause')
    button.click()
    expect(button).to_have_text('Play')


# What it shows first

ROTOR = replace(samples.ROTOR, first_stamp=samples.START)
FAILED = replace(samples.FAILING, rotor=ROTOR, verdict='fail')
WIDE = {'width': 1280, 'height': 800}


@pytest.fixture
def opened(browser, tmp_path):
    """Open documents."""
    tabs = []

    def open_(shown, view):
        path = tmp_path / 'page.html'
        path.write_text(to_html(shown), 'utf-8')
        tab = browser.new_page(viewport=view)
        tabs.append(tab)
        visit(tab, path)
        return tab

    yield open_
    for tab in tabs:
        assert tab.seen == []
        tab.close()


def test_first_screen_shows_what_failed_and_findings_lead_to_their_moment(opened):
    tab = opened(document([FAILED]), WIDE)
    for part in ('h1 .badge', '.first', '.branches figure >> nth=0', '.subplot.xy >> nth=0'):
        box = tab.locator(part).bounding_box()
        assert box['y'] >= 0, part
        assert box['y'] + box['height'] <= WIDE['height'], part
    expect(tab.locator('h1 .badge')).to_have_text('failed')
    expect(tab.locator('.first')).to_have_text(sentence(samples.FAILING.causes[0]))
    # At the gravest finding, which is from the start on.
    expect(tab.locator('.motion output')).to_have_text('0.0000 s')
    tab.locator('summary').first.click()
    tab.get_by_role('link', name='missing').first.click()
    expect(tab.locator('.motion output')).to_have_text('1.0000 s')
    low, high = tab.evaluate("document.querySelector('.figure').layout.xaxis.range")
    assert low == pytest.approx(1.0 - 3.99 / 40)
    assert high == pytest.approx(1.0 + 3.99 / 40)


FAULTS = """() => {
  document.querySelectorAll('details').forEach(folded => folded.open = true);
  const faults = [];
  const boxes = [];
  const texts = document.querySelectorAll(
    'h1, h2, h3, p, li, dt, dd, th, td, summary, figcaption, .figure text');
  for (const text of texts) {
    const box = text.getBoundingClientRect();
    if (!box.width || text.closest('.scroll')) continue; // a wide table can be moved
    const frame = text.closest('.figure')?.getBoundingClientRect();
    const wider = text instanceof HTMLElement && text.scrollWidth > text.clientWidth + 1;
    const outside = box.left < 0 || box.right > innerWidth + 0.5 || frame
      && (box.top < frame.top - 1 || box.bottom > frame.bottom + 1 || box.right > frame.right + 1);
    if (outside || wider) faults.push(`cut: ${text.textContent}`);
    if (frame || text.matches('figcaption, .legend li')) boxes.push([text, box]);
  }
  for (const [text, a] of boxes) {
    for (const [other, b] of boxes) {
      if (text === other) break;
      const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (width > 3 && height > 3) faults.push(`${text.textContent} on ${other.textContent}`);
    }
  }
  if (document.documentElement.scrollWidth > innerWidth) faults.push('the page is too wide');
  return faults;
}"""


def figures():
    """Give all kinds: of a recording, those with long texts, marks and equal axes, and a split."""
    x = np.linspace(1.0, 9.0, 9)
    lines = tuple(Line(f'torque {way}', Pen.FIRST, x, x) for way in ('rising', 'falling'))
    title = 'ramps to 5 N·m: hysteresis 1.559 ± 0.033 arcmin'
    label = 'torque at the output [N·m]; dashed: 0 and ±3 % of rated'
    loops = Panel(title, label, 'wind-up at the output [arcmin]', lines, marks=((0.0, ''),))
    marks = ((2.0, 'rotor × 2'), (4.0, 'rotor × 4'))
    marked = Panel('spectrum', 'order', 'amplitude [arcmin]', lines, marks)
    preload = Preload.from_torque(Stiffness(1000.0, 1500.0, 2000.0), 1.5)
    shown = {
        'panels': Figure((loops, loops, marked)),
        'outlines': plotting.outlines(*MECHANISMS[0]),
        'split': plotting.torque_split(preload, ('left', 'right')),
    }
    others = (Section(name, (Table((), ()),), figure=one) for name, one in shown.items())
    recorded = document([FAILED, samples.DAMAGED])
    return replace(recorded, sections=(*recorded.sections, *others))


@pytest.mark.parametrize('width', [400, 1280, 1600])
def test_no_text_is_cut_off_or_lies_on_another(opened, width):
    tab = opened(figures(), {'width': width, 'height': 800})
    drawn = tab.locator('.figure').all()
    assert len(drawn) >= 5
    for figure in drawn:
        figure.scroll_into_view_if_needed()
        expect(figure.locator('.nsewdrag').first).to_be_attached()
    assert tab.evaluate(FAULTS) == []
