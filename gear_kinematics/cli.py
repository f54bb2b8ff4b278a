"""The program `gearkin`: arguments, printing and exit codes; no mathematics."""

import argparse
import json
import math
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from gear_kinematics import parameters
from gear_kinematics.bag import Bag
from gear_kinematics.compute import compute
from gear_kinematics.description import urdf
from gear_kinematics.fleet import (
    Task,
    find_bags,
    find_topics,
    validate_bag,
    validate_on_cluster,
    validate_on_this_machine,
)
from gear_kinematics.kinematics import Mechanism, loop_closure, vernier
from gear_kinematics.rendering import render, to_html, to_json, to_junit
from gear_kinematics.report import BagReport, Verdict
from gear_kinematics.validation import Tolerances

_DONE, _FAILED, _UNUSABLE = 0, 1, 2
_INTERRUPTED = 130  # as shells have it
_EXIT_CODES = {Verdict.PASS: _DONE, Verdict.FAIL: _FAILED, Verdict.UNUSABLE: _UNUSABLE}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; returns the exit code: 0 done, 1 a check failed, 2 unusable input."""
    options = _parser().parse_args(arguments)
    # What has begun is cleared away when the process is told to end, too.
    previous = signal.signal(signal.SIGTERM, signal.default_int_handler)
    code = _DONE
    try:
        with _closed_pipe_ignored():
            code = options.run(options)
    except (ValueError, OSError, RuntimeError) as error:
        print(f'gearkin: {" ".join(str(error).split())}', file=sys.stderr)
        code = _UNUSABLE
    except KeyboardInterrupt:
        code = _INTERRUPTED
    finally:
        signal.signal(signal.SIGTERM, previous)
    return code


@contextmanager
def _closed_pipe_ignored() -> Iterator[None]:
    """Print to a pipe whose reader may have seen enough."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        sys.stdout = open(os.devnull, 'w')  # noqa: PTH123, SIM115, for the interpreter's last flush


class _Console(Console):
    """Raises BrokenPipeError, where rich ends the process."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='gearkin', description=__doc__)
    commands = parser.add_subparsers(title='commands', required=True, metavar='COMMAND')

    def command(
        name: str, run: Callable[[argparse.Namespace], int], text: str, *parents: Any
    ) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=text, description=text, parents=parents)
        added.set_defaults(run=run)
        return added

    config = argparse.ArgumentParser(add_help=False)
    config.add_argument(
        '--config',
        type=Path,
        metavar='FILE',
        help='parameters of the node as YAML (default: config/actuator.yaml)',
    )
    topics = argparse.ArgumentParser(add_help=False)
    for topic in ('rotor', 'output', 'poses'):
        topics.add_argument(f'--{topic}-topic', metavar='NAME', help='(default: by type and name)')

    validate = command(
        'validate', _validate, 'recorded outputs against recomputed ones', config, topics
    )
    validate.add_argument('bags', nargs='+', metavar='BAG', help='file, directory or glob')
    validate.add_argument('--tolerance-angle', type=float, default=1e-9, metavar='RAD')
    validate.add_argument('--tolerance-position', type=float, default=1e-9, metavar='M')
    validate.add_argument(
        '--allow-offset', action='store_true', help='accept a constant offset, as homing leaves it'
    )
    way = validate.add_mutually_exclusive_group()
    way.add_argument(
        '--live', action='store_true', help='play the rotor topic through the node, validate that'
    )
    way.add_argument('--jobs', type=_positive, default=1, metavar='N', help='processes')
    way.add_argument('--scheduler', metavar='ADDRESS', help='of a Dask cluster: tcp://host:port')
    for form in ('json', 'junit', 'html'):
        validate.add_argument(
            f'--{form}', nargs='?', const='-', metavar='FILE', help=f'as {form} (default: stdout)'
        )

    compute_command = command(
        'compute', _compute, 'write the outputs for a bag with the rotor topic', config, topics
    )
    compute_command.add_argument('bag', type=Path, metavar='BAG')
    compute_command.add_argument('out', type=Path, metavar='OUT', help='directory to make')
    compute_command.add_argument('--storage', choices=('mcap', 'sqlite3'), default='mcap')
    compute_command.add_argument('--compression', choices=('none', 'zstd'), default='none')

    replay = command('replay', _replay, "publish a bag's rotor topic in its own time")
    replay.add_argument('bag', type=Path, metavar='BAG')
    replay.add_argument('--rate', type=float, default=1.0, help='bag time per real time')
    replay.add_argument('--loop', action='store_true', help='until stopped')
    replay.add_argument('--start-offset', type=float, default=0.0, metavar='S')
    replay.add_argument('--duration', type=float, default=math.inf, metavar='S')
    replay.add_argument(
        '--topics', nargs='+', metavar='NAME', help='(default: the rotor topic, as rotor_state)'
    )
    replay.add_argument(
        '--clock', type=float, nargs='?', const=40.0, default=0.0, metavar='HZ', help='on /clock'
    )
    replay.add_argument(
        '--no-wait', action='store_true', help='do not wait for a subscriber before the start'
    )

    command('demo', _demo, 'the shipped bag through the live node, validated')
    describe = command(
        'describe', _describe, 'what a tooth pair implies: ratio, mobility, vernier', config
    )
    describe.add_argument('--ring-teeth', type=int, metavar='ZK')
    describe.add_argument('--satellite-teeth', type=int, metavar='ZS')
    describe.add_argument('--eccentricity', type=float, metavar='M')
    describe.add_argument('--json', action='store_true', help='for programs')
    command('urdf', _urdf, 'the URDF on stdout', config)
    return parser


def _positive(text: str) -> int:
    if (number := int(text)) < 1:
        raise argparse.ArgumentTypeError(f'must be at least 1, not {number}')
    return number


def _config_path(options: argparse.Namespace, bag: Path | None = None) -> Path:
    """The file that was asked for, or the one beside the bag's data, or the default."""
    if options.config:
        return Path(options.config)
    default = parameters.default_config()
    if not bag:
        return default
    beside = (bag if bag.is_dir() else bag.parent) / default.name
    return beside if beside.is_file() else default


def _validate(options: argparse.Namespace) -> int:
    tolerances = Tolerances(options.tolerance_angle, options.tolerance_position)
    if not (tolerances.angle >= 0.0 and tolerances.position >= 0.0):
        raise ValueError('a tolerance must not be negative')
    forms = {'json': to_json, 'junit': to_junit, 'html': to_html}
    targets = {form: target for form in forms if (target := getattr(options, form))}
    on_stdout = [f'--{form}' for form, target in targets.items() if target == '-']
    if len(on_stdout) > 1:
        raise ValueError(f'only one report can go to stdout, not {" and ".join(on_stdout)}')
    tasks = []
    for bag in find_bags(options.bags):
        config = _config_path(options, bag)
        loaded = parameters.load(config)
        Mechanism.from_mapping(loaded)  # what is wrong with it is no fault of the bag
        tasks.append(
            Task(
                bag,
                loaded,
                str(config),
                tolerances,
                options.allow_offset,
                options.rotor_topic,
                options.output_topic,
                options.poses_topic,
            )
        )
    order = {str(task.bag): number for number, task in enumerate(tasks)}
    reports = sorted(_reports(options, tasks), key=lambda report: order[report.bag])
    for report in reports:
        if report.error:
            print(f'gearkin: {report.error}', file=sys.stderr)
    if not on_stdout:
        with _closed_pipe_ignored():
            render(reports, _Console())
    for form, target in targets.items():
        _write(target, forms[form](reports))
    return max(_EXIT_CODES[report.verdict] for report in reports)


def _reports(options: argparse.Namespace, tasks: Sequence[Task]) -> Iterator[BagReport]:
    if options.scheduler or options.jobs > 1:
        reports = (
            validate_on_cluster(tasks, options.scheduler)
            if options.scheduler
            else validate_on_this_machine(tasks, options.jobs)
        )
        with _progress('bags') as bars:
            yield from bars.track(reports, total=len(tasks), description='bags')
        return
    for task in tasks:
        with _message_progress(task.bag.name) as progress:
            yield (_validate_live if options.live else validate_bag)(task, progress)


def _validate_live(task: Task, progress: Callable[[int, int | None], None]) -> BagReport:
    # Needs ROS, which the validation of a recording does without.
    from gear_kinematics.replay import live_messages  # noqa: PLC0415

    return validate_bag(task, progress, live_messages)


def _write(target: str, text: str) -> None:
    """Write a file that is whole or not there at all."""
    if target == '-':
        with _closed_pipe_ignored():
            print(text, end='' if text.endswith('\n') else '\n')
        return
    path = Path(target)
    if path.exists() and not path.is_file():  # a device or a pipe: nothing to put in its place
        path.write_text(text, encoding='utf-8')
        return
    path = path.resolve()
    unfinished = path.with_name(f'.{path.name}.{os.getpid()}.tmp')
    try:
        unfinished.write_text(text, encoding='utf-8')
        unfinished.replace(path)
    except OSError as error:
        raise ValueError(f'{target}: {error.strerror}') from error
    finally:
        with suppress(OSError):
            unfinished.unlink()


def _compute(options: argparse.Namespace) -> int:
    config = parameters.load(_config_path(options, options.bag))
    with Bag(options.bag) as bag, _message_progress(options.bag.name) as progress:
        rotor = options.rotor_topic or find_topics(bag, outputs=False).rotor
        namespace = rotor.rpartition('/')[0]
        count = 0

        def told(now: int) -> None:
            nonlocal count
            progress(now - count, bag.message_count)
            count = now

        result = compute(
            bag,
            options.out,
            config,
            rotor_topic=rotor,
            output_topic=options.output_topic or f'{namespace}/output_state',
            poses_topic=options.poses_topic or f'{namespace}/body_poses',
            storage=options.storage,
            compression=options.compression,
            progress=told,
        )
    rejected = ', '.join(f'{cause} {number}' for cause, number in result.rejected.items())
    print(
        f'{options.out}: {result.computed} outputs for {result.received} rotor states'
        + (f' (rejected: {rejected})' if rejected else '')
        + f', {result.copied} other messages copied'
    )
    return _DONE


def _replay(options: argparse.Namespace) -> int:
    # Needs ROS, which most commands do without.
    from gear_kinematics.replay import play, stopped_by_signals  # noqa: PLC0415

    with Bag(options.bag) as bag, stopped_by_signals() as stopped:
        if options.topics:
            topics = {topic: topic for topic in options.topics}
        else:
            topics = {find_topics(bag, outputs=False).rotor: 'rotor_state'}
        if not options.no_wait:
            print(f'waiting for a subscriber on {", ".join(topics.values())}', file=sys.stderr)
        played = play(
            bag,
            topics,
            rate=options.rate,
            loop=options.loop,
            start_offset=options.start_offset,
            duration=options.duration,
            clock=options.clock,
            stopped=stopped,
            wait=0.0 if options.no_wait else math.inf,
        )
    print(f'{played.messages} messages, at most {1e3 * played.worst_delay:.1f} ms late')
    return _DONE


@contextmanager
def _message_progress(name: str) -> Iterator[Callable[[int, int | None], None]]:
    """Show messages/s and the remaining time; gives what is to be called with each batch."""
    with _progress('messages') as progress:
        task = progress.add_task(name, total=None)

        def update(count: int, total: int | None) -> None:
            progress.update(task, advance=count, total=total)

        yield update


def _progress(unit: str) -> Progress:
    """A progress bar on the terminal, on stderr so that stdout stays clean."""
    return Progress(
        TextColumn('{task.description}'),
        BarColumn(),
        MofNCompleteColumn(),
        _Speed(unit),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )


class _Speed(TextColumn):
    """How many come in a second."""

    def __init__(self, unit: str) -> None:
        super().__init__('')
        self._unit = unit

    def render(self, task: Any) -> Text:
        speed = task.finished_speed or task.speed
        return Text(f'{speed:,.0f} {self._unit}/s' if speed else '')


def _demo(_options: argparse.Namespace) -> int:
    # Needs ROS, which most commands do without.
    from gear_kinematics import demo  # noqa: PLC0415

    return _DONE if demo.run(Console()).passed else _FAILED


def _urdf(options: argparse.Namespace) -> int:
    config = parameters.load(_config_path(options))
    names = {name: config[name] for name in ('module', 'output_joint', 'frame_prefix')}
    print(urdf(Mechanism.from_mapping(config), **names), end='')
    return _DONE


def _describe(options: argparse.Namespace) -> int:
    config = parameters.load(_config_path(options))
    for name in ('ring_teeth', 'satellite_teeth', 'eccentricity'):
        if (given := getattr(options, name)) is not None:
            config[name] = given
    facts = _facts(Mechanism.from_mapping(config))
    if options.json:
        print(json.dumps({name: value for name, value, _ in facts}, indent=2))
        return _DONE
    table = Table('', 'value', 'unit', box=None, show_header=False)
    for name, value, unit in facts:
        table.add_row(name.replace('_', ' '), str(value), unit)
    Console().print(table)
    return _DONE


def _facts(mechanism: Mechanism) -> list[tuple[str, Any, str]]:
    """Name, value and unit of what follows from the mechanism alone."""
    zk = mechanism.ring_teeth
    return [
        ('ring_teeth', zk, ''),
        ('satellite_teeth', mechanism.satellite_teeth, ''),
        ('eccentricity', mechanism.eccentricity, 'm'),
        ('branches', [branch.name for branch in mechanism.branches], ''),
        ('gear_ratio', str(mechanism.gear_ratio), ''),
        ('mobility_by_counting', loop_closure.mobility_by_counting(mechanism), ''),
        ('mobility_by_rank', loop_closure.mobility_by_rank(mechanism), ''),
        ('redundant_constraints', loop_closure.redundant_constraints(mechanism), ''),
        ('ring_rolling_radius', mechanism.ring_rolling_radius, 'm'),
        ('satellite_rolling_radius', mechanism.satellite_rolling_radius, 'm'),
        ('oldham_petals', mechanism.oldham_petals, ''),
        ('vernier_combinations', vernier.combinations(zk), ''),
        ('vernier_distinct_positions', vernier.distinct_positions(zk), ''),
        ('vernier_ring_body_positions', vernier.ring_body_positions(zk), ''),
        ('vernier_step', vernier.step(zk), 'rad'),
    ]
