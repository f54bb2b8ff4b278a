# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The data given to matplotlib, against 50-digit and matrix-method motion."""

import math
from importlib.util import find_spec
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import oracle
import pytest
from properties import numbers_of

from gear_kinematics import plotting
from gear_kinematics.kinematics import Branch, Mechanism, matrix_method, split_turns
from gear_kinematics.plotting.mechanism import BodyDrawing, CentreDrawing
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.report.image import to_image
from gear_kinematics.shape.outlines import bodies

Image = pytest.importorskip('PIL.Image', reason='pillow is not installed')
# Found and not imported, which takes long, and all workers would do.
pytestmark = pytest.mark.skipif(not find_spec('matplotlib'), reason='matplotlib is not installed')
MODULE = 0.0005  # m
PNG = Path('figure.png')


def corners(patch) -> list[np.ndarray]:
    """The polygons of a patch, each without its closing point."""
    return [polygon[:-1] for polygon in patch.get_path().to_polygons(closed_only=False)]


def new_axes():
    from matplotlib.figure import Figure  # noqa: PLC0415, an import that only these tests wait for

    return Figure().add_subplot()


def middle(polygon) -> np.ndarray:
    """The centre of evenly spaced points."""
    return np.mean(polygon, axis=0)


@pytest.mark.parametrize('rotor_angle', [0.7, 1234.5])
def test_bodies_and_centres_are_drawn_where_the_motion_says(actuator, rotor_angle):
    e = actuator.eccentricity
    expected = oracle.expected_motion(numbers_of(actuator), oracle.rotor_angle_of(rotor_angle))
    for k, motion in enumerate(expected.branches):
        axes = new_axes()
        drawn, centres = BodyDrawing(axes, actuator, MODULE, k), CentreDrawing(axes, actuator, k)
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


@pytest.mark.parametrize('force', [191.0, -1.0])
def test_forces_on_the_satellite_are_drawn_where_they_act(actuator, force):
    """At the pitch point across the radius, and against it at the centre of the satellite."""
    axes = new_axes()
    drawn = BodyDrawing(axes, actuator, MODULE, 0, force)
    drawn.show(split_turns(0.7))
    u = np.array([-math.sin(0.7), math.cos(0.7)])
    mesh, cam = corners(drawn.patches['force'])
    feet = [0.5 * (arrow[0] + arrow[2]) for arrow in (mesh, cam)]
    assert feet == [pytest.approx(0.0011 * 80 / 4 * u), pytest.approx(0.0011 * u)]
    along = math.copysign(1.0, force) * np.array([-u[1], u[0]])  # u'(θ)
    length = float(np.hypot(*(mesh[1] - feet[0])))
    assert length > 0.005
    assert mesh[1] - feet[0] == pytest.approx(length * along)
    assert cam[1] - feet[1] == pytest.approx(-length * along)


def test_scheme_shows_the_bodies_named_and_the_angles(actuator, figures):
    plotting.scheme(actuator, MODULE, PNG, split_turns(math.radians(36.1)))
    [figure] = figures
    left, right = figure.axes
    assert len(left.patches) == 5
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        'ring gear', 'satellite', "rotor's cam", 'Oldham coupling', 'arm'
    ]  # fmt: skip
    title = left.get_title()
    assert title == 'branch a, $z_k$ = 80, $z_s$ = 76\n$φ_2$ = 36.1°, $φ_5$ = −1.9°'
    assert {text.get_text() for text in right.texts} == {
        '$O_1$', '$O_3$', '$O_4$', '$e$', '$x$', '$y$'
    }  # fmt: skip
    # The whole ring gear is in the picture.
    ring = corners(left.patches[0])[0]
    assert np.abs(ring).max() < min(np.abs([*left.get_xlim(), *left.get_ylim()]))


@pytest.mark.parametrize(('pair', 'petals'), [((80, 76), 40), ((61, 58), 61)])
def test_roses_follow_the_formula(pair, petals):
    """r = e cos(zk ψ/(zk - zs)), with as many petals as the greatest radii."""
    mechanism = Mechanism(*pair, 0.0011, (Branch('a', 0.3), Branch('b', math.pi)))
    panels = plotting.roses(mechanism).panels
    assert [panel.title for panel in panels] == [
        f'branch {name}: {petals} petals' for name in 'ab'
    ]
    for branch, panel in zip(mechanism.branches, panels, strict=True):
        [line] = panel.lines
        r, psi = np.hypot(line.x, line.y), np.arctan2(-line.x, line.y)
        assert (line.x[0], line.y[0]) == pytest.approx((line.x[-1], line.y[-1]), abs=1e-9)
        assert np.max(r) == pytest.approx(1.1, abs=1e-3)
        if petals == 40:  # else ψ counts turns
            wave = np.abs(np.cos(20.0 * psi - branch.cam_phase))
            assert r == pytest.approx(1.1 * wave, abs=1e-9)
            tips = (r > 1.099) & (r >= np.roll(r, 1)) & (r > np.roll(r, -1))
            assert np.count_nonzero(tips[:-1]) == petals


def test_slides_are_those_of_the_matrix_method(actuator):
    slides, speeds = plotting.slides(actuator, -20.0).panels
    assert speeds.x_label == 'rotor angle [°] at -20 rad/s'
    for panel, of in ((slides, ''), (speeds, '_velocity')):
        lines = {line.name: line for line in panel.lines}
        assert len(lines) == 4
        for k, branch in enumerate('ab'):
            for part in ('satellite', 'arm'):
                line = lines[f'{branch}, on the {part}']
                state = matrix_method.solve(actuator, np.radians(line.x), -20.0)
                expected = 1e3 * getattr(state, f'{part}_slide{of}')[:, k]
                assert line.y == pytest.approx(expected, abs=1e-6)


def assert_nothing_is_cut_off(pixels: Image.Image) -> None:
    """Paper is white along all edges."""
    grey = np.asarray(pixels.convert('L'))
    assert min(edge.min() for edge in (grey[0], grey[-1], grey[:, 0], grey[:, -1])) == 255


LONG = 'far_end_of_the_left_elbow'  # 25 letters


@pytest.mark.slow
@pytest.mark.parametrize('names', [('a', 'b'), (LONG,), ('left', LONG, 'c'), tuple('abcde')])
def test_nothing_is_cut_off_with_long_branch_names(figures, names):
    mechanism = Mechanism(80, 76, 0.0011, tuple(Branch(name) for name in names))
    for picture in (
        plotting.scheme(mechanism, MODULE, PNG, split_turns(-123.456)),
        to_image(plotting.roses(mechanism), PNG),
        to_image(plotting.slides(mechanism, 20.0), PNG),
    ):
        assert_nothing_is_cut_off(Image.open(BytesIO(picture)))
    for figure in figures:
        for legend in figure.legends:  # is off the curves
            box = legend.get_window_extent()
            assert not any(box.overlaps(axes.get_window_extent()) for axes in figure.axes)
        titles = [axes.title.get_window_extent() for axes in figure.axes]
        assert not any(a.overlaps(b) for a, b in pairwise(titles) if a.width and b.width)
    labels = [text.get_text() for text in figures[-1].legends[0].get_texts()]
    assert labels == [f'{name}, on the {part}' for part in ('satellite', 'arm') for name in names]


def test_output_turns_by_the_ratio(actuator):
    turns, angle = split_turns(np.array([0.0, 1.0, 50.0]))
    moved = Trajectory(np.array([0.0, 0.1, 0.3]), turns, angle, np.array([1.0, -2.0, 300.0]))
    (angles,), (rates,) = (panel.lines for panel in plotting.output(actuator, moved).panels)
    assert angles.x == pytest.approx([0.0, 0.1, 0.3])
    assert angles.y == pytest.approx(np.degrees([0.0, -1.0 / 19, -50.0 / 19]))
    assert rates.y == pytest.approx(np.degrees([-1.0 / 19, 2.0 / 19, -300.0 / 19]))


@pytest.fixture(scope='module')
def loop():
    """A whole turn of the output, 19 turns of the rotor, in 20 frames."""
    return Trajectory.at_constant_speed(19.0, turns=19).every(2.0 * math.pi / 20, closed=True)


@pytest.mark.slow
def test_frames_of_a_gif_show_the_bodies_in_turn(actuator, loop):
    """The background shows through the satellite's mark, but not on the opposite side."""
    told = []
    content = plotting.animate(actuator, MODULE, loop, fps=25, progress=told.append)
    assert told == list(range(1, 21))
    image = Image.open(BytesIO(content))
    assert (image.n_frames, image.size, image.info['loop']) == (20, (420, 280), 0)
    shapes = bodies(actuator, MODULE)
    mark = middle(shapes['satellite'][-1])[0]
    pixels_per_m = 140.0 / (1.02 * np.max(shapes['stator'][0]))
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
            assert colours.getpixel((round(139.5 + x), round(139.5 - y))) == colour


def test_standstill_is_one_long_frame(actuator):
    still = Trajectory(*(np.zeros(5) for _ in range(4)))
    image = Image.open(BytesIO(plotting.animate(actuator, MODULE, still, fps=10)))
    assert (image.n_frames, image.info['duration']) == (1, 500)
