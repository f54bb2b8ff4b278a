# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The data given to matplotlib, against 50-digit and matrix-method motion."""

import math
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import oracle
import pytest
from calibrations import single_order
from properties import numbers_of

from gear_kinematics import plotting
from gear_kinematics.bag.trajectory import Trajectory
from gear_kinematics.kinematics import Branch, Mechanism, matrix_method, split_turns
from gear_kinematics.report.document import Figure, Line, Panel, Pen
from gear_kinematics.report.image import ImageFile, to_image
from gear_kinematics.shape.outlines import bodies

figure_module = pytest.importorskip('matplotlib.figure', reason='matplotlib is not installed')

from PIL import Image  # noqa: E402, comes with matplotlib

from gear_kinematics.plotting.mechanism import Bodies, Centres  # noqa: E402

MODULE = 0.0005  # m
PNG = ImageFile(Path('figure.png'))


def corners(patch) -> list[np.ndarray]:
    """The polygons of a patch, each without its closing point."""
    return [polygon[:-1] for polygon in patch.get_path().to_polygons(closed_only=False)]


def middle(polygon) -> np.ndarray:
    """The centre of evenly spaced points."""
    return np.mean(polygon, axis=0)


@pytest.mark.parametrize('rotor_angle', [0.7, 1234.5])
def test_bodies_and_centres_are_drawn_where_the_motion_says(actuator, rotor_angle):
    e = actuator.eccentricity
    expected = oracle.expected_motion(numbers_of(actuator), oracle.rotor_angle_of(rotor_angle))
    for k, motion in enumerate(expected.branches):
        axes = figure_module.Figure().add_subplot()
        drawn, centres = Bodies(axes, actuator, MODULE, k), Centres(axes, actuator, k)
        drawn.show(split_turns(rotor_angle))
        centres.show(split_turns(rotor_angle))
        o3, o4 = (
            np.array([float(x) for x in point[:2]])
            for point in (motion.satellite_centre, motion.oldham_centre)
        )
        for body, hole, centre in (('satellite', 0, o3), ('oldham', 1, o4), ('rotor', 0, o3)):
            drawn_at = middle(corners(drawn.patches[body])[hole])
            assert drawn_at == pytest.approx(centre, abs=1e-12)
        # The mark of the satellite is on the x axis of its frame.
        mark = middle(corners(drawn.patches['satellite'])[-1]) - o3
        turned = math.atan2(mark[1], mark[0])
        assert oracle.turn_angle_error(turned, expected.output_angle) <= 1e-9

        ends = {name: line.get_xydata() for name, line in centres.lines.items()}
        for name, points in (('e', [[0, 0], o3]), ('x', [o3, o4]), ('y', [[0, 0], o4])):
            assert ends[name] == pytest.approx(np.array(points) / e, abs=1e-12)
        for body, point in (('satellite', o3), ('oldham', o4)):
            assert centres.points[body].get_xydata()[0] == pytest.approx(point / e, abs=1e-12)
        # Each slot goes through O4, at a right angle to the other, and the circle too (Thales).
        (a, b), (c, d) = ends['satellite slot'], ends['arm slot']
        assert (b - a) @ (d - c) == pytest.approx(0.0, abs=1e-12)
        for start, end in ((a, b), (c, d)):
            assert np.linalg.det([end - start, o4 / e - start]) == pytest.approx(0.0, abs=1e-11)
        assert np.hypot(*(o4 - o3 / 2)) == pytest.approx(0.5 * e, abs=1e-12)


def test_scheme_shows_the_bodies_named_and_the_angles(actuator, figures):
    plotting.scheme(actuator, MODULE, PNG, split_turns(math.radians(36.1)), 1)
    [figure] = figures
    left, right = figure.axes
    assert len(left.patches) == 5
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        'ring gear', 'satellite', "rotor's cam", 'Oldham coupling', 'arm'
    ]  # fmt: skip
    title = left.get_title()
    assert title == 'branch b, $z_k$ = 80, $z_s$ = 76\n$φ_2$ = 36.1°, $φ_5$ = −1.9°'
    assert {text.get_text() for text in right.texts} == {
        '$O_1$', '$O_3$', '$O_4$', '$e$', '$x$', '$y$'
    }  # fmt: skip
    # The whole ring gear is in the picture.
    ring = corners(left.patches[0])[0]
    assert np.abs(ring).max() < min(np.abs([*left.get_xlim(), *left.get_ylim()]))


@pytest.mark.slow
@pytest.mark.parametrize('rotor_angle', [0.0, math.pi * 76 / 160, 2.0, -1.0])
def test_labels_of_the_centres_do_not_lie_on_each_other(actuator, figures, rotor_angle):
    """Also where two centres coincide: O4 and O3, or O4 and O1."""
    plotting.scheme(actuator, MODULE, PNG, split_turns(rotor_angle))
    boxes = {
        text.get_text(): text.get_window_extent()
        for text in figures[0].axes[1].texts
        if text.get_text().startswith('$O')
    }
    assert len(boxes) == 3
    for name, box in boxes.items():
        overlapping = [other for other in boxes if other > name and box.overlaps(boxes[other])]
        assert not overlapping, name


@pytest.mark.parametrize(('pair', 'petals'), [((80, 76), 40), ((61, 58), 61)])
def test_roses_follow_the_formula(figures, pair, petals):
    """r = e cos(zk ψ/(zk - zs)), with as many petals as the greatest radii."""
    mechanism = Mechanism(*pair, 0.0011, (Branch('a', 0.3), Branch('b', math.pi)))
    moved = Trajectory.at_constant_speed(300.0, duration=0.05)
    plotting.roses(mechanism, PNG, moved)
    [figure] = figures
    titles = [f'branch {name}: {petals} petals' for name in 'ab']
    assert [axes.get_title() for axes in figure.axes] == titles
    state = matrix_method.solve(mechanism, 300.0 * moved.time)
    for k, axes in enumerate(figure.axes):
        circle, whole, part = (line.get_xydata() for line in axes.get_lines())
        assert np.hypot(*circle.T) == pytest.approx(1.1)
        assert whole[0] == pytest.approx(whole[-1], abs=1e-9)
        assert np.max(np.hypot(*whole.T)) == pytest.approx(1.1, abs=1e-3)
        if petals == 40:  # else ψ counts turns
            x, y = whole[:-1].T
            r, psi = np.hypot(x, y), np.arctan2(-x, y)
            alpha = mechanism.branches[k].cam_phase
            assert r == pytest.approx(1.1 * np.abs(np.cos(20.0 * psi - alpha)), abs=1e-9)
            tips = (r > 1.099) & (r >= np.roll(r, 1)) & (r > np.roll(r, -1))
            assert np.count_nonzero(tips) == petals
        assert part == pytest.approx(1e3 * state.oldham_centre[:, k], abs=1e-9)


@pytest.mark.parametrize('by_angle', [False, True])
def test_slides_are_those_of_the_matrix_method(actuator, figures, by_angle):
    moved = Trajectory.at_constant_speed(-20.0)
    plotting.slides(actuator, PNG, moved, by_angle=by_angle)
    expected = matrix_method.solve(actuator, -20.0 * moved.time, -20.0)
    along = np.degrees(-20.0 * moved.time) if by_angle else moved.time
    slides, speeds = figures[0].axes
    assert speeds.get_xlabel() == ('rotor angle [°] at -20 rad/s' if by_angle else 'time [s]')
    for axes, kinds in (
        (slides, ('satellite_slide', 'arm_slide')),
        (speeds, ('satellite_slide_velocity', 'arm_slide_velocity')),
    ):
        curves = {line.get_label(): line.get_data() for line in axes.get_lines()}
        assert set(curves) == {
            f'{branch}, on the {part}' for branch in 'ab' for part in ('satellite', 'arm')
        }
        for k, branch in enumerate('ab'):
            for part, field in zip(('satellite', 'arm'), kinds, strict=True):
                x, y = curves[f'{branch}, on the {part}']
                assert x == pytest.approx(along, abs=1e-9)
                assert y == pytest.approx(1e3 * getattr(expected, field)[:, k], abs=1e-6)


def recorded(angles, period=0.001) -> Trajectory:
    """A motion through rotor angles, rad, as a driver records it."""
    angles = np.asarray(angles, float)
    time = period * np.arange(len(angles))
    return Trajectory(time, *split_turns(angles), np.gradient(angles, time))


def test_slides_of_many_turns_are_a_band_and_a_few_turns_in_detail(actuator, figures):
    """20 s of strokes; the rotor is fastest, 120 rad/s, in the middle of each, as at 10 s."""
    time = 0.001 * np.arange(20_001)
    moved = recorded(60.0 * np.sin(2.0 * time - 20.0))
    plotting.slides(actuator, PNG, moved, by_angle=False)
    whole, detail, whole_speeds, detail_speeds = figures[0].axes
    assert not whole.get_lines()
    assert [band.get_datalim(whole.transData).y1 for band in whole.collections] == pytest.approx(
        [1.1] * 4, abs=1e-3
    )
    start, end = detail.get_xlim()
    assert 120.0 * (end - start) == pytest.approx(3 * math.tau, rel=1e-2)
    assert abs(math.sin(start + end - 20.0)) < 0.01  # around a middle
    state = matrix_method.solve(actuator, 60.0 * np.sin(2.0 * np.linspace(start, end, 721) - 20.0))
    curves = {line.get_label(): line.get_ydata() for line in detail.get_lines()}
    assert curves['b, on the arm'] == pytest.approx(1e3 * state.arm_slide[:, 1], abs=2e-3)
    assert len(curves) == len(detail_speeds.get_lines()) == 4
    marked = whole.patches[0].get_bbox()
    assert (marked.x0, marked.x1) == pytest.approx((start, end))
    assert whole_speeds.get_xlim() == pytest.approx((0.0, 20.0), abs=0.1)


def test_output_of_many_turns_is_a_band_and_a_turn_in_detail(actuator, figures):
    moved = recorded(300.0 * 0.001 * np.arange(3001))  # 900 rad, 7.5 turns of the output
    plotting.output(actuator, PNG, moved)
    whole, detail, _, rate = figures[0].axes
    assert not whole.get_lines()
    [line] = detail.get_lines()
    shown = np.ptp(line.get_ydata())
    assert shown == pytest.approx(360.0, rel=0.01)
    assert rate.get_lines()[0].get_ydata() == pytest.approx(-300.0 / 19 * 180.0 / math.pi)
    [band] = whole.collections
    assert band.get_datalim(whole.transData).y0 == pytest.approx(-900.0 / 19 * 180.0 / math.pi)


def assert_nothing_is_cut_off(pixels: Image.Image) -> None:
    """Paper is white along all edges."""
    grey = np.asarray(pixels.convert('L'))
    assert min(edge.min() for edge in (grey[0], grey[-1], grey[:, 0], grey[:, -1])) == 255


@pytest.mark.parametrize(('width', 'dpi', 'size'), [(84.0, 300, 7.0), (170.0, 100, 9.0)])
def test_figures_have_the_width_and_resolution_of_a_paper(actuator, figures, width, dpi, size):
    turn = Trajectory.at_constant_speed(20.0)
    file = ImageFile(Path('slides.png'), width, dpi)
    image = Image.open(BytesIO(plotting.slides(actuator, file, turn, by_angle=True)))
    assert image.size[0] == pytest.approx(width / 25.4 * dpi, abs=1)
    assert_nothing_is_cut_off(image)
    assert {text.get_fontsize() for text in figures[0].legends[0].get_texts()} == {size}


def test_panels_are_below_each_other_where_paper_is_narrow(figures):
    line = Line('line', Pen.FIRST, np.arange(3.0), np.arange(3.0))
    three = Figure(tuple(Panel(f'{k}', 'x', 'y', (line,)) for k in range(3)))
    for width, columns in ((80.0, 1), (170.0, 2), (None, 3)):
        to_image(three, ImageFile(PNG.path, width))
        lefts = {round(axes.get_position().x0, 2) for axes in figures[-1].axes}
        assert len(lefts) == columns


LONG = 'far_end_of_the_left_elbow'  # 25 letters


@pytest.mark.slow
@pytest.mark.parametrize('names', [('a', 'b'), (LONG,), ('left', LONG, 'c'), tuple('abcde')])
def test_nothing_is_cut_off_with_long_branch_names(figures, names):
    mechanism = Mechanism(80, 76, 0.0011, tuple(Branch(name) for name in names))
    turn = Trajectory.at_constant_speed(20.0)
    for picture in (
        plotting.scheme(mechanism, MODULE, PNG, split_turns(-123.456), len(names) // 2),
        plotting.roses(mechanism, PNG),
        plotting.slides(mechanism, PNG, turn, by_angle=True),
    ):
        assert_nothing_is_cut_off(Image.open(BytesIO(picture)))
    for figure in figures:
        for legend in figure.legends:  # is off the curves
            box = legend.get_window_extent()
            assert not any(box.overlaps(axes.get_window_extent()) for axes in figure.axes)
        titles = [axes.title.get_window_extent() for axes in figure.axes]
        assert not any(a.overlaps(b) for a, b in pairwise(titles) if a.width and b.width)
    labels = [text.get_text() for text in figures[-1].legends[0].get_texts()]
    assert labels == [f'{name}, on the {part}' for name in names for part in ('satellite', 'arm')]


def test_output_turns_by_the_ratio_and_deviates_within_an_interval(actuator, figures):
    turns, angle = split_turns(np.array([0.0, 1.0, 50.0]))
    moved = Trajectory(np.array([0.0, 0.1, 0.3]), turns, angle, np.array([1.0, -2.0, 300.0]))
    plotting.output(actuator, PNG, moved, single_order(half_width=2e-4))
    assert len(figures[0].axes) == 3
    curves = [axes.get_lines()[0].get_data() for axes in figures[0].axes]
    assert all(time == pytest.approx([0.0, 0.1, 0.3]) for time, _ in curves)
    angles, rates, deviation = (values for _, values in curves)
    assert angles == pytest.approx(np.degrees([0.0, -1.0 / 19, -50.0 / 19]))
    assert rates == pytest.approx(np.degrees([-1.0 / 19, 2.0 / 19, -300.0 / 19]))
    assert deviation == pytest.approx(np.cos([0.0, 1.0, 50.0]))  # mrad
    [band] = figures[0].axes[2].collections
    border = band.get_paths()[0].vertices
    at_start = border[border[:, 0] == 0.0, 1]
    assert (min(at_start), max(at_start)) == (pytest.approx(0.8), pytest.approx(1.2))


@pytest.fixture(scope='module')
def loop():
    """A whole turn of the output, 19 turns of the rotor, in 20 frames."""
    return Trajectory.at_constant_speed(19.0, turns=19).every(2.0 * math.pi / 20, closed=True)


@pytest.mark.slow
def test_frames_of_a_gif_show_the_bodies_in_turn(actuator, loop):
    """The background shows through the satellite's mark, but not on the opposite side."""
    told = []
    content = plotting.animate(
        actuator, MODULE, Path('a.gif'), loop, fps=25, width=300, progress=told.append
    )
    assert told == list(range(1, 21))
    image = Image.open(BytesIO(content))
    assert (image.n_frames, image.size, image.info['loop']) == (20, (300, 200), 0)
    shapes = bodies(actuator, MODULE)
    mark = middle(shapes['satellite'][-1])[0]
    pixels_per_m = 100.0 / (1.02 * np.max(shapes['stator'][0]))
    numbers = numbers_of(actuator)
    for frame in range(20):
        image.seek(frame)
        assert image.info['duration'] == 40
        colours = image.convert('RGB')
        angle = oracle.rotor_angle_of(19.0 * 2.0 * math.pi * frame / 20)
        expected = oracle.expected_motion(numbers, angle)
        turn = float(expected.output_angle)
        centre = np.array([float(x) for x in expected.branches[0].satellite_centre[:2]])
        direction = np.array([math.cos(turn), math.sin(turn)])
        for sign, colour in ((1.0, (255, 255, 255)), (-1.0, (154, 186, 223))):
            x, y = pixels_per_m * (centre + sign * mark * direction)
            assert colours.getpixel((round(99.5 + x), round(99.5 - y))) == colour


def test_standstill_is_one_long_frame(actuator):
    still = Trajectory(*(np.zeros(5) for _ in range(4)))
    image = Image.open(
        BytesIO(plotting.animate(actuator, MODULE, Path('a.GIF'), still, fps=10, width=100))
    )
    assert (image.n_frames, image.info['duration']) == (1, 500)
