# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report as a page: whole, offline, safe, and drawn to the right scale."""

import base64
import hashlib
import json
import math
import re
import sys
from dataclasses import replace

import numpy as np
import pytest
import report_samples as samples
from lxml import html
from plotly.offline import get_plotlyjs

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.report import html as page
from gear_kinematics.report.interactive import interactive
from gear_kinematics.report.json import to_json
from gear_kinematics.report.junit import to_junit
from gear_kinematics.validation.document import document
from gear_kinematics.validation.findings import sentence
from gear_kinematics.validation.report import Series


def to_html(reports):
    return page.to_html(document(reports))


def figure(bag):
    [section] = document([bag]).sections
    return interactive(section.figure.panels, section.mechanism)


@pytest.fixture(scope='module')
def fleet():
    return to_html(samples.ALL)


def parse(page):
    return html.document_fromstring(page.encode(), parser=html.HTMLParser(encoding='utf-8'))


def without_plotly(page):
    assert page.count(get_plotlyjs()) == 1
    return page.replace(get_plotlyjs(), '')


def test_plotly_is_there_once_and_only_where_there_is_something_to_plot(fleet):
    without_plotly(fleet)
    page = to_html([samples.UNUSABLE, replace(samples.PASSING, series=())])
    assert 'Plotly' not in page
    assert "script-src 'none'" in page
    empty = replace(samples.PASSING, series=(Series('/output_state', [], []),))
    assert 'Plotly' not in to_html([empty])


def test_page_loads_nothing(fleet):
    page = without_plotly(fleet)
    assert '://' not in page
    assert '@import' not in page
    assert 'url(' not in page
    tree = parse(page)
    loading = ('link', 'base', 'iframe', 'object', 'embed', 'img', 'audio', 'video', 'form')
    assert not list(tree.iter(*loading))
    assert not tree.xpath('//@src')
    assert all(link.startswith('#') for link in tree.xpath('//@href'))
    assert not tree.xpath("//meta[@http-equiv='refresh']")


def test_browser_is_told_to_run_these_scripts_and_to_load_nothing(fleet):
    policy = parse(fleet).xpath("//meta[@http-equiv='Content-Security-Policy']/@content")[0]
    directives = dict(part.strip().split(' ', 1) for part in policy.split(';'))
    assert directives['default-src'] == "'none'"
    scripts = re.findall(r'<script>(.*?)</script>', fleet, re.DOTALL)
    assert len(scripts) == 3
    digests = [base64.b64encode(hashlib.sha256(s.encode()).digest()).decode() for s in scripts]
    assert directives['script-src'].split() == [f"'sha256-{digest}'" for digest in digests]


def test_names_are_no_markup(fleet):
    tree = parse(without_plotly(fleet))
    assert not list(tree.iter('img'))
    assert not tree.xpath("//@*[starts-with(name(), 'on')]")
    plotted = sum(bool(report.series) for report in samples.ALL)
    kinds = [script.get('type') for script in tree.iter('script')]
    assert kinds == ['application/json'] * plotted + [None, None, None]
    text = tree.text_content()
    # Bag (in summary and heading), config, ratio, error, finding, fault, names of topics ...
    assert text.count(samples.HOSTILE) > 10
    assert 'run\\x1b[31m' in text
    alone = parse(without_plotly(to_html([samples.HOSTILE_NAMES])))
    assert alone.findtext('head/title') == f'failed: {samples.HOSTILE}'
    title = to_html([replace(samples.UNUSABLE, bag='</title><img src=x>')])
    assert not list(parse(title).iter('img'))
    # The data of a figure cannot leave their script.
    [data] = alone.xpath('//script[@data-figure="figure-0"]/text()')
    assert not set(data) & set('<>&')
    assert json.loads(data) == figure(samples.HOSTILE_NAMES)


def test_summary_leads_to_every_bag_and_first_to_those_that_failed(fleet):
    tree = parse(fleet)
    links = tree.xpath("//section[@id='top']//a/@href")
    assert tree.xpath('//main/section/@id')[1:] == [link[1:] for link in links]
    verdicts = tree.xpath("//h2/span[contains(@class, 'badge')]/text()")
    assert verdicts == ['failed'] * 4 + ['unusable'] * 3 + ['passed'] * 2
    # Else in the order of the bags.
    listed = tree.xpath("//section[@id='top']//a/text()")
    failed = [samples.ALL[k].bag for k in (1, 4, 6, 7)]
    assert listed[:2] == failed[:2]
    assert [heading[0].tail.strip() for heading in tree.iter('h2')] == listed
    assert tree.find('.//header').text_content().split('\n')[0] == (
        'failed gearkin validate9 bags: 2 passed, 4 failed, 3 unusable'
    )


def test_tables_show_what_is_bad():
    tree = parse(to_html([replace(samples.FAILING, series=())]))
    bad = [cell.text for cell in tree.xpath("//td[contains(@class, 'bad')]")]
    assert bad == ['11', '8', '1', '0', '4008', '0.002', '5', '1']
    clean = parse(to_html([replace(samples.PASSING, series=())]))
    assert not clean.xpath(
        "//*[self::td or self::dd][contains(@class, 'bad') or contains(@class, 'notable')]"
    )
    notable = [cell.text for cell in tree.xpath("//dd[contains(@class, 'notable')]")]
    assert notable == ['5', '3', '2', '2']


def test_page_begins_with_cause_and_figure_and_ends_with_folded_tables():
    tree = parse(without_plotly(to_html([samples.FAILING])))
    assert tree.find('.//h1').text_content() == f'failed {samples.FAILING.bag}'
    [section] = tree.xpath('//main/section')
    parts = [(part.tag, part.get('class')) for part in section]
    assert parts == [
        ('p', 'first fail'),
        ('p', None),
        ('details', None),
        ('div', 'moving'),
        ('dl', 'inline'),
        ('details', None),
    ]
    assert section.find_class('first')[0].text == sentence(samples.FAILING.causes[0])
    findings, tables = section.findall('details')
    assert findings.find('summary').text == '10 more findings'
    assert len(findings.findall('.//li')) == 10
    assert tables.find('summary').text == 'Tables'
    assert not section.xpath('.//table[not(ancestor::details)]')
    assert not section.xpath('.//details[@open]')


def test_mechanism_stands_at_the_moment_of_the_gravest_finding():
    rotor = replace(samples.FAILING.rotor, first_stamp=samples.START)
    wrong = replace(samples.FAILING.topics[0], faults=())
    failing = replace(samples.FAILING, rotor=rotor, topics=(wrong,))
    tree = parse(without_plotly(to_html([failing])))
    # The worst sample is 2.5 s from the start, and there is one every 10 ms.
    assert tree.xpath('//input[@type="range"]/@value') == ['250']
    missing = replace(wrong, fields=samples.OUTPUT.fields)
    missing = replace(samples.FAILING, rotor=rotor, topics=(missing,))
    tree = parse(without_plotly(to_html([missing])))
    assert tree.xpath('//input[@type="range"]/@value') == ['100']
    tree = parse(without_plotly(to_html([samples.PASSING])))
    assert tree.xpath('//input[@type="range"]/@value') == ['0']


def panels(plots):
    """Give the names of the lines of each panel, from top to bottom."""
    axes = [f'y{k}' for k in range(1, 1 + len({trace['yaxis'] for trace in plots['data']}))]
    return [[t['name'] for t in plots['data'] if t['yaxis'] == axis] for axis in axes]


def test_figure_shows_the_errors_of_what_failed():
    plots = figure(samples.FAILING)
    output, _ = samples.FAILING.series
    assert plots['time'] == pytest.approx(output.time)
    assert panels(plots) == [['error'], ['rotor angle']]
    error, rotor = plots['data']
    errors = np.maximum(np.abs(output.errors['position']), 1e-18)
    assert error['y'] == pytest.approx(errors, rel=1e-7, abs=0)
    assert rotor['y'] == pytest.approx(output.rotor_angle, rel=1e-7)
    assert panels(figure(samples.PASSING)) == [['error'], ['rotor angle']]


def test_figure_has_a_panel_for_every_field_that_failed():
    names = ('position', 'velocity', 'effort', 'orientation')
    fields = tuple(replace(samples.POSITION, name=name, max_error=1.0) for name in names)
    errors = {name: [0.0, 1.0] for name in names}
    report = replace(
        samples.FAILING,
        topics=(replace(samples.OUTPUT, fields=fields),),
        series=(Series('/output_state', [0.0, 1.0], [0.0, 1.0], errors),),
    )
    plots = figure(report)
    assert panels(plots) == [['error']] * 4 + [['rotor angle']]
    titles = [note['text'] for note in plots['layout']['annotations']]
    assert titles == [f'/output_state {name}' for name in names]


def test_figure_marks_the_tolerances():
    passing, failing = figure(samples.PASSING), figure(samples.FAILING)
    for plots in (passing, failing):  # an error beyond the tolerance is drawn beyond its line
        shapes = plots['layout']['shapes']
        levels = [shape['y0'] for shape in shapes if shape['yref'] == 'y1']
        assert levels == [1e-9]
        assert (max(plots['data'][0]['y']) > 1e-9) == (plots is failing)


def test_values_that_are_no_numbers_leave_holes():
    plots = figure(samples.NOT_FINITE)
    assert plots['time'] == [0.0, None]
    assert plots['data'][0]['y'] == [None, None]
    assert plots['data'][-1]['y'] == [0.0, None]
    assert plots['turned'] == {'rotor': [0.0, None], 'output': [0.0, None]}


def test_only_a_page_with_a_figure_needs_plotly(monkeypatch):
    monkeypatch.setitem(sys.modules, 'plotly.offline', None)
    fleet = document(samples.ALL)
    assert to_json(fleet)
    assert to_junit(fleet)
    assert to_html([samples.UNUSABLE])
    with pytest.raises(ModuleNotFoundError, match=r'plotly\.offline'):
        to_html([samples.PASSING])


# The mechanism

MECHANISM = Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi)))


def moving(angles, period=0.001, mechanism=MECHANISM):
    count = len(angles)
    time = [period * k for k in range(count)]
    series = (Series('/output_state', time, angles, {'position': [0.0] * count}),)
    return replace(samples.PASSING, series=series, mechanism=mechanism)


@pytest.mark.parametrize('far', [math.tau, 19e9 * math.tau])  # float64 has 1.5e-5 rad there
def test_figure_says_how_far_rotor_and_output_have_turned(far):
    """Without the whole turns of the first sample."""
    turned = figure(moving([far, far + 1.0, far - 19.0 * math.tau]))['turned']
    for values, ratio in ((turned['rotor'], 1.0), (turned['output'], -1.0 / 19.0)):
        assert abs(values[0]) < 360.0
        steps = np.degrees([ratio, -ratio * 19.0 * math.tau])
        assert np.subtract(values[1:], values[0]) == pytest.approx(steps, abs=1e-2)


@pytest.mark.parametrize(('angles', 'speed'), [
    ([0.0, 0.3], '0.01 × real time'), ([0.0, 1e-4], '10 × real time'), ([0.0], '100 × real time'),
])  # fmt: skip
def test_it_plays_at_a_speed_that_can_be_followed(angles, speed):
    tree = parse(without_plotly(to_html([moving(angles)])))
    assert [option.text for option in tree.xpath('//option[@selected]')] == [speed]


def test_every_shape_is_in_the_page_once_and_used():
    other = replace(MECHANISM, branches=(*MECHANISM.branches, Branch('c', cam_phase=math.pi)))
    tree = parse(
        without_plotly(to_html([moving([0.0]), moving([1.0]), moving([0.0], mechanism=other)]))
    )
    names = tree.xpath('//path/@id')
    # A ring gear and a satellite, a coupling, an arm, and two cams.
    assert len(names) == len(set(names)) == 6
    uses = tree.xpath('//use/@href')
    assert {f'#{name}' for name in names} == set(uses)
    assert len(uses) == 5 * (2 + 2 + 3)
    assert tree.xpath('//figcaption/text()') == [f'branch {name}' for name in 'abababc']
