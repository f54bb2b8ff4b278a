"""`gearkin index`: the pin setting for a wanted turn of a ring gear."""

import argparse
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.commands import ExitCode, arguments, bracing
from gear_kinematics.commands.files import write_text
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import vernier
from gear_kinematics.kinematics.preload import Preload, Stiffness, ring_phase
from gear_kinematics.kinematics.vernier import Choice, PinSetting
from gear_kinematics.measurement.preload.file import MeasuredPreload, read_advice
from gear_kinematics.measurement.wording import PERCENT, plain, plus_minus
from gear_kinematics.report.document import (
    Cell,
    Document,
    Figure,
    Layout,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Tone,
)
from gear_kinematics.report.mark import MARK
from gear_kinematics.shape.angles import arc, arc_seconds
from gear_kinematics.shape.pin_sheet import MOST_TEETH, draw

_MAX_NEIGHBOURS = 1000
_SENSES = (
    'Seen against the z axis, angles, teeth and chassis holes count counterclockwise, ring holes '
    'clockwise, from 0 at the zero marks.'
)


class _Row(NamedTuple):
    """A position of the ring gear and its preload."""

    choice: Choice
    preload: float | None
    """N·m; None without a stiffness."""
    preload_error: float | None
    """`preload` minus that at the wanted turn, N·m."""


class _Answer(NamedTuple):
    """The wanted turn, and the nearest positions of the vernier."""

    ring_teeth: int
    start: PinSetting
    phase: float | None
    """Part of the turn that the cam phase of branch B requires, rad; None if not requested."""
    ring_turn: float
    """The wanted turn, rad."""
    preload: float | None
    """Preload at the wanted turn, N·m; None without a stiffness."""
    rows: tuple[_Row, ...]
    measured: MeasuredPreload | None = None

    @property
    def nearest(self) -> _Row:
        """The row in the middle."""
        return self.rows[len(self.rows) // 2]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_mechanism(parser)
    ways = parser.add_mutually_exclusive_group()
    bracing.add_ring_turn(ways)
    ways.add_argument(
        '--preload',
        type=float,
        metavar='N·m',
        help='wanted preload of the branches; negative: by turning the other way',
    )
    ways.add_argument(
        '--measured',
        type=Path,
        metavar='JSON',
        help='the least turn by measured ramps: from gearkin lost-motion --preloads --json',
    )
    parser.add_argument(
        '--load',
        type=arguments.positive,
        metavar='N·m',
        help='that --measured must be for (default: any)',
    )
    parser.add_argument(
        '--phase-b', action='store_true', help='add the turn for the cam phase of branch B'
    )
    bracing.add_setting(parser, '--from', 'start', 'initial pin setting (default: 0 0 0)')
    parser.add_argument(
        '--neighbours', type=int, default=3, metavar='N', help='on either side (default: 3)'
    )
    add_report_forms(parser)
    parser.add_argument(
        '--drawing', metavar='FILE', help='draw the holes as SVG on a page of A4 (-: stdout)'
    )
    parser.add_argument(
        '--mirrored', action='store_true', help='draw as seen along the z axis, not against it'
    )
    bracing.add_stiffness(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Report the setting and its neighbours, and draw it."""
    if options.mirrored and not options.drawing:
        raise ValueError('--mirrored needs --drawing')
    reporter = Reporter(options, others={'--drawing': options.drawing})
    answer = _answer(options)
    drawing = ''
    if options.drawing or (options.html and answer.ring_teeth <= MOST_TEETH):
        setting = answer.nearest.choice.settings[0]
        notes = [' '.join(fact) for fact in _outcome(answer)]
        drawing = draw(answer.ring_teeth, setting, notes, mirrored=options.mirrored)
    if options.drawing:
        write_text(options.drawing, f'{drawing}<!-- {MARK} -->\n')
    reporter.write(
        Document('gearkin index', (_section(answer, drawing),), _data(answer)),
        [arguments.config_path(options)],
    )
    return ExitCode.DONE


def _answer(options: argparse.Namespace) -> _Answer:
    stiffness, turn = bracing.stiffness(options), bracing.ring_turn(options)
    backlash = options.backlash or 0.0
    measured = _measured(options, stiffness)
    if measured:
        stiffness, backlash = measured.preload.stiffness, measured.preload.play
        turn = measured.least.high  # the greatest that may be needed suffices
    if turn is None and options.preload is None and not options.phase_b:
        raise ValueError('give --angle, --degrees, --preload, --measured or --phase-b')
    if not 0 <= options.neighbours <= _MAX_NEIGHBOURS:
        raise ValueError(f'--neighbours must be 0 to {_MAX_NEIGHBOURS}, not {options.neighbours}')
    pair, ring_teeth = None, options.ring_teeth
    if stiffness or options.phase_b or not ring_teeth:  # the vernier alone needs no satellite
        pair = arguments.load_config(options).mechanism
        ring_teeth = pair.ring_teeth
    if measured and pair and not math.isclose(measured.scale, ring_teeth / pair.satellite_teeth):
        raise ValueError(f'{options.measured}: measured on a gear with other teeth')
    if options.preload is not None:
        if not (pair and stiffness):
            raise ValueError('--preload needs the stiffness of branches and shaft')
        wanted = Preload.from_torque(stiffness, abs(options.preload))
        turn = math.copysign(wanted.ring_turn(pair, backlash), options.preload)
    phase = ring_phase(pair) if pair and options.phase_b else None
    in_phase = phase or 0.0

    ring_turn = bracing.within_a_turn(in_phase + (turn or 0.0))
    start = vernier.pin_setting(ring_teeth, *(options.start or (0, 0, 0)))
    choices = vernier.choices(ring_teeth, ring_turn, start, options.neighbours)
    if not (pair and stiffness):
        rows = tuple(_Row(choice, None, None) for choice in choices)
        return _Answer(ring_teeth, start, phase, ring_turn, None, rows)
    at_wanted, *at_choices = (
        Preload.from_ring_turn(pair, stiffness, angle - in_phase, backlash).torque
        for angle in (ring_turn, *(choice.ring_turn for choice in choices))
    )
    rows = tuple(
        _Row(choice, preload, preload - at_wanted)
        for choice, preload in zip(choices, at_choices, strict=True)
    )
    return _Answer(ring_teeth, start, phase, ring_turn, at_wanted, rows, measured)


def _measured(options: argparse.Namespace, stiffness: Stiffness | None) -> MeasuredPreload | None:
    if not options.measured:
        if options.load:
            raise ValueError('--load needs --measured')
        return None
    if stiffness:
        raise ValueError('--measured contains the stiffness and backlash, give no others')
    measured = read_advice(options.measured)
    if options.load and options.load != measured.load:
        made = f'for {measured.load:g} N·m' if measured.load else 'without --load'
        raise ValueError(f'{options.measured}: made {made}, not for {options.load:g} N·m')
    return measured


def _data(answer: _Answer) -> dict[str, Any]:
    return {
        'ring_teeth': answer.ring_teeth,
        'ring_holes': answer.ring_teeth + 1,
        'chassis_holes': answer.ring_teeth + 2,
        'positions': vernier.distinct_positions(answer.ring_teeth),
        'step': vernier.step(answer.ring_teeth),
        'from': _pins(answer.start),
        'wanted': {
            'ring_turn': answer.ring_turn,
            'phase': answer.phase,
            'preload': answer.preload,
        },
        'measured': plain(answer.measured and answer.measured._asdict()),
        'positions_around': [
            {
                'steps': choice.steps,
                'ring_turn': choice.ring_turn,
                'error': choice.error,
                'preload': preload,
                'preload_error': error,
                'settings': [_pins(setting) for setting in choice.settings],
            }
            for choice, preload, error in answer.rows
        ],
    }


def _pins(setting: PinSetting) -> dict[str, Any]:
    return {
        'tooth': setting.tooth,
        'ring_hole': setting.ring_hole,
        'chassis_hole': setting.chassis_hole,
        'turn': str(setting.turn),
        'body_turn': str(setting.body_turn),
    }


def _section(answer: _Answer, drawing: str) -> Section:
    zk = answer.ring_teeth
    count = vernier.distinct_positions(zk)
    return Section(
        '',
        (
            Table.of_values(
                Layout.LINES,
                ('holes', f'{zk} teeth, {zk + 1} ring holes, {zk + 2} chassis holes'),
                ('positions', f'{count} positions, one every {arc(vernier.step(zk))}'),
                *_pinning(answer),
                *_outcome(answer),
            ),
            _position_table(answer),
        ),
        remarks=(_SENSES,),
        figure=_figure(answer),
        drawing=drawing,
    )


def _figure(answer: _Answer) -> Figure:
    steps = np.array([choice.steps for choice, *_ in answer.rows], np.float64)
    error = np.array([arc_seconds(choice.error) for choice, *_ in answer.rows])
    line = Line('position', Pen.FIRST, steps, error, points=True)
    label = 'position, steps from the nearest'
    return Figure((Panel('', label, 'error of the turn [″]', (line,), levels=((0.0, 'wanted'),)),))


def _pinning(answer: _Answer) -> Iterator[tuple[str, str]]:
    first, *others = answer.nearest.choice.settings
    yield 'from', str(answer.start)
    yield 'pin', str(first)
    for other in others:
        yield 'or', f'{other}: the same position'
    yield 'ring body', arc(vernier.angle_between(answer.start.body_turn, first.body_turn))


def _outcome(answer: _Answer) -> Iterator[tuple[str, str]]:
    choice, preload, more = answer.nearest
    error = f'{arc_seconds(choice.error):+.3f}″'
    yield 'turn', f'{arc(choice.ring_turn)} for a wanted {arc(answer.ring_turn)} ({error})'
    if answer.phase is not None:
        yield 'phase', f'{arc(answer.phase)} of it'
    if measured := answer.measured:
        least = measured.least
        what = 'hysteresis falls no further'
        if measured.load:
            what = f'both branches stay in mesh under {measured.load:g} N·m'
        yield (
            'measured',
            (
                f'{what} from {arc(least.value)} on ({PERCENT}: {arc(least.low)} to '
                f'{arc(least.high)}, which is wanted)'
            ),
        )
        if measured.added_friction:
            yield 'added friction', f'{plus_minus(measured.added_friction)} N·m'
    if preload is not None:
        wanted = f'{answer.preload:.4g} N·m'
        yield 'preload', f'{preload:.4g} N·m for a wanted {wanted} ({more:+.2g} N·m)'


def _position_table(answer: _Answer) -> Table:
    columns = ['steps', 'tooth', 'ring hole', 'chassis hole', 'turn', 'error [″]']
    if answer.preload is not None:
        columns += ['preload [N·m]', 'error [N·m]']
    rows = []
    for choice, preload, more in answer.rows:
        cells = [
            f'{choice.steps:+}' if choice.steps else '0',
            ' or '.join(str(setting.tooth) for setting in choice.settings),
            str(choice.settings[0].ring_hole),
            ' or '.join(str(setting.chassis_hole) for setting in choice.settings),
            arc(choice.ring_turn),
            f'{arc_seconds(choice.error):+.3f}',
        ]
        if preload is not None:
            cells += [f'{preload:.4f}', f'{more:+.4f}']
        tone = Tone.PLAIN if choice.steps else Tone.CHOSEN
        rows.append(tuple(Cell(text, tone) for text in cells))
    return Table(tuple(columns), tuple(rows), words=())
