"""The report as a page: whole, offline, safe, and drawn to the right scale."""

import base64
import hashlib
import json
import math
import re
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise

import pytest
import report_samples as samples
from lxml import html
from plotly.offline import get_plotlyjs

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.report import html as page
from gear_kinematics.report.interactive import SymmetricLog, interactive
from gear_kinematics.validation.document import document
from gear_kinematics.validation.report import Series


def to_html(reports):
    return page.to_html(document(reports))


def figure(bag):
    [section] = document([bag]).sections
    return interactive(section.figure, section.mechanism)


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
    page = to_html([samples.UNUSABLE, replace(samples.PASSING, series=None)])
    assert 'Plotly' not in page
    assert "script-src 'none'" in page
    empty = replace(samples.PASSING, series=Series([], [], [], [], []))
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
    plotted = sum(report.series is not None for report in samples.ALL)
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


def test_figure_of_hostile_names_cannot_leave_its_script():
    page = to_html([samples.HOSTILE_NAMES])
    (data,) = re.findall(r'data-figure="figure-0">(.*?)</script>', page, re.DOTALL)
    assert not set(data) & set('<>&')
    assert json.loads(data) == figure(samples.HOSTILE_NAMES)


def test_summary_leads_to_every_bag(fleet):
    tree = parse(fleet)
    links = tree.xpath("//section[@id='top']//a/@href")
    assert len(links) == len(samples.ALL)
    for link, report in zip(links, samples.ALL, strict=True):
        (section,) = tree.xpath(f"//section[@id='{link[1:]}']")
        if report.bag.isprintable() and report.bag:
            assert report.bag in section.find('h2').text_content()
    assert tree.find('.//header').text_content().split('\n')[0] == (
        'unusable gearkin validate9 bags: 2 passed, 4 failed, 3 unusable'
    )


def test_single_bag_has_no_summary():
    assert 'id="top"' not in to_html([samples.UNUSABLE])


def test_tables_show_what_is_bad():
    tree = parse(to_html([replace(samples.FAILING, series=None)]))
    bad = [cell.text for cell in tree.xpath("//td[contains(@class, 'bad')]")]
    assert bad == ['11', '8', '1', '0', '4008', '0.002', '2e8 %', '5', '1']
    clean = parse(to_html([replace(samples.PASSING, series=None)]))
    assert not clean.xpath(
        "//*[self::td or self::dd][contains(@class, 'bad') or contains(@class, 'notable')]"
    )
    notable = [cell.text for cell in tree.xpath("//dd[contains(@class, 'notable')]")]
    assert notable == ['5', '3', '2', '1', '1', '7', '1', '2', '1', '4', 'no']


def test_damage_faults_and_findings_are_told():
    tree = parse(to_html([replace(samples.DAMAGED, findings=('It ran slow.',), series=None)]))
    assert [item.text for item in tree.iter('li')] == [samples.DAMAGED.error, 'It ran slow.']
    assert tree.xpath('//ul/@class') == ['remarks unusable']


def test_page_is_the_same_every_time(fleet):
    assert to_html(samples.ALL) == fleet


def test_figure_has_angles_and_errors_over_the_same_time():
    plots = figure(samples.FAILING)
    series = samples.FAILING.series
    assert plots['time'] == pytest.approx(series.time)
    names = ['rotor angle', 'output angle', 'angle error', 'position error']
    assert [trace['name'] for trace in plots['data']] == names
    assert plots['data'][0]['y'] == pytest.approx(series.rotor_angle, rel=1e-7)
    assert plots['data'][1]['y'] == pytest.approx(series.output_angle, rel=1e-7)
    assert plots['data'][2]['customdata'] == pytest.approx(series.angle_error, rel=1e-3, abs=0)
    assert plots['data'][3]['customdata'] == pytest.approx(series.position_error, rel=1e-3, abs=0)
    domains = [plots['layout'][f'yaxis{k}']['domain'] for k in (1, 2, 3, 4)]
    assert all(0 <= low < high <= 1 for low, high in domains)
    assert all(upper[0] > lower[1] for upper, lower in pairwise(domains))


def test_figure_marks_the_tolerances():
    passing = figure(samples.PASSING)
    by_axis = {}
    for shape in passing['layout']['shapes']:
        by_axis.setdefault(shape['yref'], []).append(shape['y0'])
    # Angle errors have a sign, position errors have none.
    assert len(by_axis['y3']) == 2
    assert sum(by_axis['y3']) == 0
    assert len(by_axis['y4']) == 1
    # An error beyond the tolerance is drawn beyond its line.
    failing = figure(samples.FAILING)
    line = max(shape['y0'] for shape in failing['layout']['shapes'] if shape['yref'] == 'y3')
    assert max(failing['data'][2]['y']) > line
    assert max(passing['data'][2]['y']) < max(by_axis['y3'])


@pytest.mark.parametrize('report', [samples.PASSING, samples.FAILING, samples.EXACT])
def test_figure_keeps_every_value_and_tick_in_view(report):
    plots = figure(report)
    for k in (3, 4):
        axis, heights = plots['layout'][f'yaxis{k}'], plots['data'][k - 1]['y']
        low, high = axis['range']
        assert low < min(heights)
        assert max(heights) < high
        assert all(low < tick < high for tick in axis['tickvals'])
        assert '0' in axis['ticktext']
        assert len(axis['tickvals']) == len(set(axis['tickvals'])) <= 9


def test_values_that_are_no_numbers_leave_holes():
    plots = figure(samples.NOT_FINITE)
    assert plots['time'] == [0.0, None]
    assert plots['data'][0]['y'] == [0.0, None]
    assert plots['data'][2]['y'] == [None, None]
    assert plots['data'][3]['y'] == [0.0, 0.0]


def test_symmetric_log_is_odd_and_rises():
    scale = SymmetricLog.fit([3e-16, -2e-3, 0.0])
    values = [-2e-3, -1e-9, -3e-16, 0.0, 3e-16, 1e-15, 1e-9, 2e-3]
    heights = [scale(value) for value in values]
    assert heights == sorted(set(heights))
    assert scale(0.0) == 0
    assert scale(-1e-9) == -scale(1e-9)
    # A decade is a decade.
    assert scale(1e-5) - scale(1e-6) == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize('values', [[], [0.0], [1e-9], [1e-300, 1e-9], [5e-324], [9.99e-10, 1e-9]])
def test_symmetric_log_fits_anything(values):
    scale = SymmetricLog.fit(values)
    assert all(math.isfinite(scale(value)) for value in values)
    ticks = scale.ticks()
    assert 1 <= len(ticks) <= 4
    assert all(0 < tick <= scale.greatest * (1 + 1e-9) for tick in ticks)


def test_symmetric_log_spends_no_more_than_twelve_decades():
    scale = SymmetricLog.fit([1e-300, 1e-9])
    assert scale(1e-9) == pytest.approx(12, abs=1.1)


def test_other_forms_of_the_report_need_no_plotly():
    program = (
        'import sys; sys.modules["plotly"] = None\n'
        'import report_samples as samples\n'
        'from gear_kinematics.report.html import to_html\n'
        'from gear_kinematics.report.json import to_json\n'
        'from gear_kinematics.report.junit import to_junit\n'
        'from gear_kinematics.validation.document import document\n'
        'fleet = document(samples.ALL)\n'
        'to_json(fleet), to_junit(fleet), to_html(document([samples.UNUSABLE]))\n'
        'try: to_html(document([samples.PASSING]))\n'
        'except ModuleNotFoundError as error: print(error.name)\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', program],
        env={'PYTHONPATH': ':'.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == 'plotly.offline\n'


# The mechanism

MECHANISM = Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi)))


def moving(angles, period=0.001, mechanism=MECHANISM):
    count = len(angles)
    time = [period * k for k in range(count)]
    series = Series(time, angles, [0.0] * count, [0.0] * count, [0.0] * count)
    return replace(samples.PASSING, series=series, mechanism=mechanism)


def test_figure_says_how_far_rotor_and_output_have_turned():
    turned = figure(moving([math.tau, 20.25 * math.tau, -18.0 * math.tau]))['turned']
    # The whole turns of the first sample are left out: of the rotor one, of the output none.
    assert turned['rotor'] == pytest.approx([0.0, 19.25 * 360, -19.0 * 360], abs=1e-3)
    assert turned['output'] == pytest.approx(
        [-360 / 19, -20.25 / 19 * 360, 18 / 19 * 360], abs=1e-3
    )


def test_turns_do_not_lose_digits():
    far = 19e9 * math.tau  # of which float64 has 1.5e-5 rad
    turned = figure(moving([far, far + 1.0]))['turned']
    assert turned['rotor'][1] - turned['rotor'][0] == pytest.approx(180 / math.pi, abs=1e-2)
    assert turned['output'][1] - turned['output'][0] == pytest.approx(
        -180 / 19 / math.pi, abs=1e-2
    )
    assert all(abs(value) < 360 for values in turned.values() for value in values)


def test_angles_that_are_no_numbers_are_none():
    assert figure(samples.NOT_FINITE)['turned'] == {'rotor': [0.0, None], 'output': [0.0, None]}


@pytest.mark.parametrize(
    ('angles', 'speed'),
    [
        ([0.0, 0.3], '1/100 of real time'),
        ([0.0, 1e-4], '10 × real time'),
        ([0.0], '100 × real time'),
    ],
)
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


def test_nothing_moves_without_a_mechanism():
    page = without_plotly(to_html([replace(samples.PASSING, mechanism=None)]))
    assert not parse(page).xpath("//*[@class='motion'] | //svg")
