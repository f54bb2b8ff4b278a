"""Arguments about bags, and the files beside them, that several commands have in common."""

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from gear_kinematics.bag import fleet
from gear_kinematics.bag.trajectory import Trajectory, read_trajectory
from gear_kinematics.commands.arguments import beside, count, positive
from gear_kinematics.commands.output import message_progress, progress
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters

CALIBRATION = 'calibration.yaml'
"""Name of a calibration beside a bag."""


def add_rotor(parser: argparse._ActionsContainer, *, configured: bool = True) -> None:
    """Add the options for the rotor's topic and joint; `load_config` applies the latter.

    Args:
        parser: to add them to.
        configured: whether the command takes parameters of the node, too.
    """
    parser.add_argument(
        '--rotor-topic',
        metavar='NAME',
        help='of the joint states (default: found by type, name and joint)',
    )
    text = ' (default: the parameter rotor_joint)' if configured else ', to find its topic'
    parser.add_argument('--joint', metavar='NAME', help=f'of the rotor{text}')


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add the options for the names of the node's topics in a bag."""
    for topic in ('output', 'poses'):
        text = '(default: found by type and name)'
        parser.add_argument(f'--{topic}-topic', metavar='NAME', help=text)


def add_recording(
    parser: argparse.ArgumentParser, motions: argparse._ActionsContainer, *, lasting: bool = True
) -> None:
    """Add the options for a motion of the rotor from a bag, one of alternative motions."""
    motions.add_argument('--bag', type=Path, metavar='BAG', help='recorded motion of the rotor')
    add_rotor(parser)
    parser.add_argument('--start-offset', type=float, metavar='S', help='start in the recording')
    if lasting:
        parser.add_argument('--duration', type=positive, metavar='S', help='(default: all of it)')


def recording(
    options: argparse.Namespace, config: NodeParameters, *bag_only_options: str
) -> Trajectory | None:
    """Read the rotor's motion from the bag, from the offset on; None without a bag.

    Args:
        options: parsed arguments.
        config: the parameters of the node.
        bag_only_options: names of further options that need a bag.

    Raises:
        ValueError: if such options are given without a bag.
    """
    if not options.bag:
        for name in ('rotor_topic', 'joint', 'start_offset', *bag_only_options):
            if getattr(options, name) is not None:
                raise ValueError(f'--{name.replace("_", "-")} needs --bag')
        return None
    start = options.start_offset or 0.0
    duration = getattr(options, 'duration', None) or math.inf
    with (
        naming(options.bag),
        message_progress(options.bag.name, quiet=options.quiet) as report_progress,
    ):
        whole = read_trajectory(options.bag, config, options.rotor_topic, report_progress)
        return whole.between(start, start + duration)


def add_calibration(parser: argparse.ArgumentParser) -> None:
    """Add the option for a calibration of the gear."""
    parser.add_argument(
        '--calibration',
        type=Path,
        metavar='FILE',
        help='calibration of the gear (default: the parameter `calibration`, or else '
        f'{CALIBRATION} beside the bag)',
    )


def calibration_path(
    options: argparse.Namespace, config: NodeParameters, bag: Path | None
) -> Path | None:
    """The given calibration, or that of the parameters, or the one in the bag's folder."""
    if given := options.calibration or config.calibration:
        return Path(given)
    return beside(bag, CALIBRATION) if bag else None


def load_calibration(
    options: argparse.Namespace, config: NodeParameters, bag: Path | None
) -> Calibration | None:
    """Load the calibration at `calibration_path`.

    Raises:
        ValueError: if it cannot be used for the gear, or the parameters describe none.
    """
    gear, path = config.gear, calibration_path(options, config, bag)
    return Calibration.load(path, gear) if path else None


def add_fleet(ways: argparse._ActionsContainer) -> None:
    """Add the options that distribute many recordings; see `results`."""
    ways.add_argument('--jobs', type=count, default=1, metavar='N', help='processes')
    ways.add_argument('--scheduler', metavar='ADDRESS', help='of a Dask cluster: tcp://host:port')


def results(
    options: argparse.Namespace,
    work: fleet.Work[fleet.Task, fleet.Report],
    tasks: Sequence[fleet.Task],
    unit: str,
    run: Callable[[fleet.Task], fleet.Report],
) -> Iterator[tuple[fleet.Task, fleet.Report]]:
    """Yield tasks and reports as they are ready: of `run`, or of `work` if `add_fleet` says so.

    Processes and clusters do the work with a progress in the unit; `run` shows its own.
    """
    if not options.scheduler and options.jobs == 1:
        yield from ((task, run(task)) for task in tasks)
        return
    done = (
        fleet.on_cluster(work, tasks, options.scheduler)
        if options.scheduler
        else fleet.on_this_machine(work, tasks, options.jobs)
    )
    with progress(unit, quiet=options.quiet) as bars:
        yield from bars.track(done, total=len(tasks), description=unit)


@contextmanager
def naming(bag: Path, *others: Path) -> Iterator[None]:
    """Name the bag in errors that name neither it nor other files.

    Raises:
        ValueError, RuntimeError: with the bag at the begin of the text.
    """
    try:
        yield
    except (ValueError, RuntimeError) as error:
        if any(str(path) in str(error) for path in (bag, *others)):
            raise
        kind = RuntimeError if isinstance(error, RuntimeError) else ValueError
        raise kind(f'{bag}: {error}') from error
