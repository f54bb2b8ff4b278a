# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin plot and gearkin animate as someone who makes a figure runs them."""

import re
from importlib.util import find_spec
from pathlib import Path

import pytest
from blocked_bags import refusal

from gear_kinematics.commands.cli import main
from gear_kinematics.share import share_directory

Image = pytest.importorskip('PIL.Image', reason='pillow is not installed')
# Found and not imported, which takes long, and all workers would do.
pytestmark = pytest.mark.skipif(not find_spec('matplotlib'), reason='matplotlib is not installed')
SERVO = str(share_directory() / 'bags' / 'servo_point_to_point')
SIGNATURES = {'png': b'\x89PNG\r\n\x1a\n', 'svg': b'<?xml', 'pdf': b'%PDF-', 'gif': b'GIF89a'}


@pytest.mark.slow
@pytest.mark.parametrize(('suffix', 'figure', 'options'), [
    ('svg', 'scheme', ('--degrees', '20', '--torque', '-4')), ('pdf', 'roses', ()),
    ('svg', 'slides', ('--speed', '-100')),
    ('PNG', 'output', ('--bag', SERVO, '--start-offset', '0.5', '--duration', '0.2')),
])  # fmt: skip
def test_plot_writes_the_same_file_each_time(figure, suffix, options, tmp_path, capsys):
    contents = []
    for name in ('one', 'two'):
        path = tmp_path / f'{name}.{suffix}'
        assert main(['plot', figure, str(path), *options]) == 0
        contents.append(path.read_bytes())
    assert contents[0].startswith(SIGNATURES[suffix.lower()])
    assert contents[0] == contents[1]
    assert len(list(tmp_path.iterdir())) == 2
    assert capsys.readouterr() == ('', '')


@pytest.mark.slow
def test_scheme_without_teeth_says_why(tmp_path, capsys):
    """At 0.65 mm the same gears mesh."""
    pair = ('--ring-teeth', '30', '--satellite-teeth', '28')
    path = str(tmp_path / 'a.svg')
    assert main(['plot', 'scheme', path, *pair, '--eccentricity', '0.0011']) == 0
    [told] = capsys.readouterr().err.splitlines()
    assert told.startswith(
        'gearkin: the gears are drawn as circles: involute teeth of module 0.0005 m '
    )
    assert 'at an eccentricity of 0.0011 m' in told
    assert main(['plot', 'scheme', path, *pair, '--eccentricity', '0.00065']) == 0
    assert main(['plot', 'roses', path, *pair, '--eccentricity', '0.0011']) == 0
    assert capsys.readouterr() == ('', '')


def test_animation_has_the_promised_frames(tmp_path, capsys):
    """Three turns of the rotor, two a second, take 1.5 s, of which a third is 10 frames."""
    path = tmp_path / 'loop.gif'
    pair = ('--ring-teeth', '4', '--satellite-teeth', '3', '--eccentricity', '0.0008')
    assert main(['animate', str(path), *pair, '--rate', '3']) == 0
    printed = capsys.readouterr()
    assert printed.out == f'{path}: 10 frames, 20 per second\n'
    assert printed.err.startswith(
        'gearkin: the gears are drawn as circles: involute teeth of module 0.0005 m '
    )
    assert path.read_bytes().startswith(SIGNATURES['gif'])
    with Image.open(path) as image:
        assert (image.n_frames, image.size) == (10, (420, 280))
        assert image.info['duration'] == 50  # ms


def test_picture_of_the_readme_is_a_whole_turn_of_the_output():
    """Ten frames to each of 19 turns of the rotor, and small enough for a first screen."""
    root = Path(__file__).resolve().parents[2]
    [name] = re.findall(r'\((docs/\S+\.gif)\)', (root / 'README.md').read_text('utf-8'))
    assert (root / name).stat().st_size < 1.5e6
    with Image.open(root / name) as image:
        assert (image.n_frames, image.size, image.info['loop']) == (190, (420, 280), 0)


@pytest.mark.slow
def test_an_animation_of_a_bag_has_its_time(tmp_path, capsys):
    path = tmp_path / 'servo.gif'
    part = ('--start-offset', '0.3', '--duration', '0.25')
    for rate, frames in (('1', 5), ('0.5', 10)):
        assert main(['animate', str(path), '--bag', SERVO, *part, '--rate', rate]) == 0
        assert capsys.readouterr().out == f'{path}: {frames} frames, 20 per second\n'


PLOT, ANIMATE = ['plot', 'roses', 'a.png'], ['animate', 'a.gif']
SCHEME, OUTPUT = ['plot', 'scheme', 'a.png'], ['plot', 'output', 'a.png']


@pytest.mark.parametrize(('arguments', 'cause'), [
    (['plot', 'scheme', 'a.xyz'], 'a.xyz: the suffix must be .png or '),
    (['plot', 'scheme', 'none/a.png'], 'none/a.png: No such file or directory'),
    ([*SCHEME, '--degrees', 'nan'], 'must be between -1e+06 and 1e+06, not nan'),
    ([*SCHEME, '--speed', '1'], '--speed is for slides, not for scheme'),
    ([*SCHEME, '--module', '0'], '--module must be between 1e-06 and 0.1'),
    ([*SCHEME, '--config', 'none.yaml'], 'none.yaml'),
    ([*OUTPUT, '--bag', 'none'], 'none: no such file or folder'), (OUTPUT, 'output needs --bag'),
    ([*PLOT, '--ring-teeth', '1001', '--satellite-teeth', '1000'], 'petals'),
    ([*PLOT, '--duration', '1'], '--duration needs --bag'),
    ([*ANIMATE, '--start-offset', '1'], '--start-offset needs --bag'),
    ([*ANIMATE, '--rate', '0.05'], 'frames are more than 2000; reduce --duration or raise --rate'),
    (['animate', 'a.png'], 'a.png: the suffix must be .gif'),
    (['animate', 'none/a.gif'], 'none/a.gif: No such file or directory'),
])  # fmt: skip
def test_unusable_input_gets_one_clear_line_and_no_file(arguments, cause, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cause in refusal(*arguments)
    assert list(tmp_path.iterdir()) == []


def test_angles_of_unknown_turns_are_drawn_with_a_warning(tmp_path, capsys):
    single_turn = str(Path(SERVO).with_name('single_turn_encoder'))
    assert main(['plot', 'output', str(tmp_path / 'a.svg'), '--bag', single_turn]) == 0
    assert capsys.readouterr().err.startswith('gearkin: the turns of the rotor are not known')


def test_of_a_gear_with_only_a_ratio_the_output_is_plotted(other_gear, tmp_path, capsys):
    out = tmp_path / 'a.png'
    assert main(['plot', 'output', str(out), '--config', str(other_gear), '--bag', SERVO]) == 0
    assert out.read_bytes().startswith(SIGNATURES['png'])
    teeth = ['--ring-teeth', '61', '--satellite-teeth', '58']  # replace the ratio
    assert main(['describe', '--config', str(other_gear), *teeth]) == 0
    assert 'gear ratio: -58/3' in capsys.readouterr().out


@pytest.mark.parametrize(
    'command',
    ['plot scheme a.png', 'plot slides a.png', 'animate a.gif', 'urdf', 'describe',
     'index --degrees 1', 'preload --degrees 1 --branch-stiffness 1 --shaft-stiffness 1'],
)  # fmt: skip
def test_what_needs_bodies_refuses_a_gear_with_only_a_ratio(command, other_gear):
    error = 'gear_ratio is 1457/26: only the ratio of this gear is known, not its bodies'
    assert refusal(*command.split(), '--config', other_gear) == error
