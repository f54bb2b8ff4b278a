# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin plot and gearkin animate as someone who makes a figure runs them."""

import os
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from blocked_bags import refusal
from gear_recordings import Samples, write_recording

from gear_kinematics.commands.cli import main
from gear_kinematics.share import share_directory

pytest.importorskip('matplotlib', reason='matplotlib is not installed')

from PIL import Image

SERVO = str(share_directory() / 'bags' / 'servo_point_to_point')
SHAFT = ['--degrees', '1', '--branch-stiffness', '1', '--shaft-stiffness', '1']
SIGNATURES = {'png': b'\x89PNG\r\n\x1a\n', 'svg': b'<?xml', 'pdf': b'%PDF-', 'gif': b'GIF89a'}


@pytest.mark.slow
@pytest.mark.parametrize(
    ('suffix', 'figure', 'options'),
    [
        ('png', 'scheme', ('--bag', SERVO, '--start-offset', '0.5')),
        ('svg', 'scheme', ()),
        ('pdf', 'roses', ('--bag', SERVO, '--duration', '0.2')),
        ('svg', 'slides', ('--speed', '-100')),
        ('PNG', 'slides', ('--bag', SERVO)),
        ('png', 'output', ('--duration', '0.1')),
    ],
)
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


def scheme(folder, *options) -> bytes:
    path = folder / 'scheme.png'
    assert main(['plot', 'scheme', str(path), *options]) == 0
    return path.read_bytes()


@pytest.mark.slow
def test_scheme_shows_the_moment_of_the_recording(tmp_path):
    """The rotor stands at 2 rad from the second on."""
    rotor = Samples([0, 1_000_000_000, 3_000_000_000], [0.5, 2.0, 2.0])
    bag = write_recording(tmp_path / 'bag', rotor)
    recorded = scheme(tmp_path, '--bag', str(bag), '--start-offset', '1')
    assert recorded == scheme(tmp_path, '--degrees', '114.59155902616465') != scheme(tmp_path)


@pytest.mark.slow
def test_scheme_without_teeth_says_why(tmp_path, capsys):
    """At 0.65 mm the same gears mesh."""
    pair = ('--ring-teeth', '30', '--satellite-teeth', '28')
    path = str(tmp_path / 'a.svg')
    assert main(['plot', 'scheme', path, *pair, '--eccentricity', '0.0011']) == 0
    [told] = capsys.readouterr().out.splitlines()
    assert told.startswith('The gears are drawn as circles: involute teeth of module 0.0005 m ')
    assert 'at an eccentricity of 0.0011 m' in told
    assert main(['plot', 'scheme', path, *pair, '--eccentricity', '0.00065']) == 0
    assert main(['plot', 'roses', path, *pair, '--eccentricity', '0.0011']) == 0
    assert capsys.readouterr() == ('', '')


def test_animation_has_the_promised_frames(tmp_path, capsys):
    """Three turns of the rotor at 30 rad/s take 0.628 s, which are 13 frames, nearly 0.628/20."""
    path = tmp_path / 'loop.gif'
    pair = ('--ring-teeth', '4', '--satellite-teeth', '3', '--eccentricity', '0.0008')
    speed = ('--speed', '30', '--width', '120')
    assert main(['animate', str(path), *pair, *speed]) == 0
    told, circles = capsys.readouterr().out.splitlines()
    assert told == f'{path}: 13 frames, 20 per second'
    assert circles.startswith('The gears are drawn as circles: involute teeth of module 0.0005 m ')
    assert path.read_bytes().startswith(SIGNATURES['gif'])
    with Image.open(path) as image:
        assert (image.n_frames, image.size) == (13, (120, 80))
        assert image.info['duration'] == 50  # ms


def test_picture_of_the_readme_is_a_whole_turn_of_the_output():
    """Ten frames to each of 19 turns of the rotor, and small enough for a first screen."""
    root = Path(__file__).resolve().parents[2]
    [name] = re.findall(r'\((docs/\S+\.gif)\)', (root / 'README.md').read_text('utf-8'))
    assert (root / name).stat().st_size < 1.5e6
    with Image.open(root / name) as image:
        assert (image.n_frames, image.size, image.info['loop']) == (190, (420, 280), 0)


@pytest.mark.slow
def test_animation_of_a_bag_says_how_to_see_the_rotor(tmp_path, capsys):
    path = tmp_path / 'servo.gif'
    part = ('--start-offset', '0.3', '--duration', '0.25', '--width', '100')
    assert main(['animate', str(path), '--bag', SERVO, *part]) == 0
    frames, advice = capsys.readouterr().out.splitlines()
    assert frames == f'{path}: 5 frames, 20 per second'
    told, rate = advice.split('--rate ')
    assert told.startswith('The rotor turns 1.2 times from frame to frame; use')
    rate = rate.split()[0]
    assert main(['animate', str(path), '--bag', SERVO, *part, '--rate', rate]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 1


FFMPEG = """#!{python}
import sys
frames = sys.stdin.buffer.read()
with open(sys.argv[-1], 'w') as file:
    file.write(f'{{len(frames)}} {{" ".join(sys.argv)}}')
sys.exit({code})
"""


def fake_ffmpeg(folder: Path, monkeypatch, code: int) -> None:
    folder.mkdir()
    program = folder / 'ffmpeg'
    program.write_text(FFMPEG.format(python=sys.executable, code=code))
    program.chmod(0o755)
    monkeypatch.setenv('PATH', f'{folder}{os.pathsep}{os.environ["PATH"]}')


@pytest.mark.parametrize('packaged', [False, True])
def test_ffmpeg_gets_every_frame_of_an_mp4(packaged, tmp_path, monkeypatch):
    """That of the system or, where there is none, of a package."""
    fake_ffmpeg(tmp_path / 'bin', monkeypatch, 0)
    if packaged:
        monkeypatch.setenv('PATH', str(tmp_path))
        package = SimpleNamespace(get_ffmpeg_exe=lambda: tmp_path / 'bin' / 'ffmpeg')
        monkeypatch.setitem(sys.modules, 'imageio_ffmpeg', package)
    path = tmp_path / 'loop.mp4'
    options = ('--speed', '12', '--duration', '0.35', '--width', '150')
    assert main(['animate', str(path), *options]) == 0
    size, *command = path.read_text().split()
    assert command[0] == str(tmp_path / 'bin' / 'ffmpeg')
    width, height = map(int, command[command.index('-s') + 1].split('x'))
    assert (width, height) == (150, 100)  # even, as players want
    assert int(size) == 8 * width * height * 4
    assert command[command.index('-framerate') + 1] == '20'
    assert 'yuv420p' in command
    assert {file.name for file in tmp_path.iterdir()} == {'bin', 'loop.mp4'}


def test_an_ffmpeg_that_fails_leaves_no_file(tmp_path, monkeypatch):
    fake_ffmpeg(tmp_path / 'bin', monkeypatch, 1)
    error = refusal('animate', tmp_path / 'loop.mp4', '--duration', '0.1')
    assert error.startswith('ffmpeg failed: ')
    assert not (tmp_path / 'loop.mp4').exists()


def test_without_ffmpeg_that_is_said_before_any_frame(tmp_path, monkeypatch):
    monkeypatch.setenv('PATH', str(tmp_path))
    monkeypatch.setitem(sys.modules, 'imageio_ffmpeg', None)
    monkeypatch.setattr('gear_kinematics.commands.animate.plotting.animate', None)
    assert refusal('animate', tmp_path / 'loop.mp4') == (
        'ffmpeg is not installed: install it with the system, or '
        "pip install 'gear_kinematics[video]'"
    )


PLOT, ANIMATE = ['plot', 'roses', 'a.png'], ['animate', 'a.gif']
SCHEME, OUTPUT = ['plot', 'scheme', 'a.png'], ['plot', 'output', 'a.png']


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['plot', 'scheme', 'a.xyz'], 'a.xyz: the suffix of a plot must be one of '),
        (['plot', 'scheme', 'none/a.png'], 'none/a.png: No such file or directory'),
        ([*SCHEME, '--degrees', 'nan'], 'must be a finite number, not nan'),
        ([*SCHEME, '--speed', '1'], '--speed is for slides and output, not for scheme'),
        ([*SCHEME, '--module', '0'], '--module must be between 1e-06 and 0.1'),
        ([*SCHEME, '--config', 'none.yaml'], 'none.yaml'),
        ([*SCHEME, '--bag', 'none'], 'none: no such file or folder'),
        ([*PLOT, '--ring-teeth', '1001', '--satellite-teeth', '1000'], 'petals'),
        ([*PLOT, '--duration', '1'], '--duration needs --bag'),
        ([*PLOT, '--width-mm', '9'], '--width-mm: must be between 30 and 1000'),
        ([*PLOT, '--width-mm', 'nan'], '--width-mm: must be between 30 and 1000'),
        ([*PLOT, '--width-mm', '900', '--dpi', '2000'], 'most 20000 pixels wide: reduce --dpi'),
        (['plot', 'slides', 'a.png', '--speed', '0'], 'the speed must be finite and not 0'),
        ([*OUTPUT, '--duration', '60'], '3000 turns of the rotor are more than'),
        (
            [*OUTPUT, '--bag', SERVO, '--start-offset', '7'],
            'no rotor states from 7 s to inf s',
        ),
        ([*OUTPUT, '--bag', SERVO, '--rotor-topic', '/motor'], 'no topic /motor of type sensor_m'),
        ([*ANIMATE, '--start-offset', '1'], '--start-offset needs --bag'),
        ([*ANIMATE, '--width', '1920', '--speed', '2'], 'too large for a GIF: 1194 fr'),
        ([*ANIMATE, '--width', '99'], '--width: must be between 100 and 1920, not 99'),
        ([*ANIMATE, '--speed', '1'], '2388 frames are more than 2000; reduce --duration'),
        (['animate', 'a.png'], 'a.png: the suffix of an animation is one of gif, mp4'),
        (['animate', 'none/a.gif', '--duration', '0.1'], 'none/a.gif: No such file or directory'),
        (['describe', '--width-mm', '84'], '--width-mm and --dpi need --plot'),
        (['describe', '--plot', 'a.png', '--dpi', '9'], '--dpi: must be between 30 and 2400'),
    ],
)
def test_unusable_input_gets_one_clear_line_and_no_file(arguments, cause, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cause in refusal(*arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize('options', [('plot', 'roses'), ('preload', *SHAFT, '--plot')])
def test_figures_take_the_width_of_a_paper(options, tmp_path):
    """84 mm at 300 dots per inch are 992 pixels."""
    path = tmp_path / 'a.png'
    assert main([*options, str(path), '--width-mm', '84', '--dpi', '300']) == 0
    with Image.open(path) as image:
        assert image.size[0] == 992


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
     'index --degrees 1', 'preload --degrees 1'],
)  # fmt: skip
def test_what_needs_bodies_refuses_a_gear_with_only_a_ratio(command, other_gear):
    error = 'gear_ratio is 1457/26: only the ratio of this gear is known, not its bodies'
    assert refusal(*command.split(), '--config', other_gear) == error
