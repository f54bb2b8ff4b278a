# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Arguments about bags and the files in their folders, shared by several commands."""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from gear_kinematics.commands import arguments
from gear_kinematics.commands.output import message_progress, progress
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.fleet import processes
from gear_kinematics.fleet.cluster import on_cluster
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.parameters.arm import as_file

CALIBRATION = 'calibration.yaml'  # name of a calibration in the folder of a bag


def add_rotor(parser: argparse.ArgumentParser, *, configured: bool = True) -> None:
    """Add the options for the rotor's topic and joint; `load_config` applies the latter.

    In a command that is not `configured` by parameters, the joint only finds the topic.
    """
    group = arguments.group(parser, 'recording')
    text = "topic of the rotor's joint states (default: found by type, name and joint)"
    group.add_argument('--rotor-topic', metavar='NAME', help=text)
    text = ' (default: the parameter rotor_joint)' if configured else ', to find its topic'
    group.add_argument('--joint', metavar='NAME', help=f'joint of the rotor{text}')


def add_encoder(parser: argparse.ArgumentParser) -> None:
    """Add the option for the topic of the output encoder."""
    text = 'topic of the output encoder (default: found by type, name and joint)'
    group = arguments.group(parser, 'recording')
    group.add_argument('--encoder-topic', metavar='NAME', help=text)


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add the options for the names of the node's topics in a bag."""
    group = arguments.group(parser, 'recording')
    for topic, content in ('output', 'output joint states'), ('poses', 'body poses'):
        text = f'topic of the {content} (default: found by type and name)'
        group.add_argument(f'--{topic}-topic', metavar='NAME', help=text)


def add_calibration(parser: argparse.ArgumentParser) -> None:
    """Add the option for a calibration of the gear."""
    arguments.group(parser, 'gear').add_argument(
        '--calibration',
        type=Path,
        metavar='FILE',
        help='calibration of the gear (default: the parameter `calibration`, or else '
        f'{CALIBRATION} beside the bag)',
    )


def calibration_path(
    options: argparse.Namespace, config: NodeParameters, bag: Path | None
) -> Path | None:
    """Choose the calibration given, in the parameters or, of a single gear, in the folder."""
    if given := options.calibration or config.calibration:
        return Path(given)
    return arguments.in_bag_folder(bag, CALIBRATION) if bag and not config.actuator else None


def load_calibration(
    options: argparse.Namespace, config: NodeParameters, bag: Path | None
) -> Calibration | None:
    """Load the calibration at `calibration_path`; raises ValueError if it cannot be used."""
    gear, path = config.gear, calibration_path(options, config, bag)
    return Calibration.load(path, gear) if path else None


def joints_beside(bag: Path, options: argparse.Namespace) -> dict[str, NodeParameters | None]:
    """Return the parameters of rotors by joint, from a file in a bag's folder if it can be used.

    Raises ValueError or OSError if it cannot be used to choose a given actuator.
    """
    if options.actuator or arguments.in_bag_folder(bag, default_config().name):
        try:
            configs = arguments.load_configs(options, bag)
        except (OSError, ValueError):  # such as a file for several nodes
            if options.actuator:
                raise
        else:
            return {config.rotor_joint: config for config in configs.values()}
    return {}


def files_of(
    options: argparse.Namespace,
    configs: Mapping[str, NodeParameters],
    bag: Path | None,
    node: str = '',
) -> dict[str, bytes]:
    """Return parameters and calibrations as files to keep beside a new recording.

    If several nodes are recorded, the files are those of the node with a full name.
    """
    files, used = dict[str, bytes](), list[NodeParameters]()
    for actuator, config in configs.items():
        owner = node[1:].replace('/', '_')
        name = '_'.join(filter(None, (owner, actuator, CALIBRATION)))
        if calibration := calibration_path(options, config, bag):
            files[name] = calibration.read_bytes()
        used.append(replace(config, calibration=name if calibration else '', home_file=''))
    return {default_config().name: as_file(used, node or '/**').encode(), **files}


def add_jobs(ways: argparse._MutuallyExclusiveGroup) -> None:
    """Add the options that distribute many recordings; see `results`."""
    count, text = arguments.between(1, kind=int), 'number of processes (default: 1)'
    ways.add_argument('--jobs', type=count, default=1, metavar='N', help=text)
    text = 'scheduler of a Dask cluster that does the work, such as tcp://HOST:8786'
    ways.add_argument('--scheduler', metavar='ADDRESS', help=text)


def results(
    options: argparse.Namespace,
    work: processes.Work[Any, processes.Report],
    tasks: Sequence[Any],
    unit: str,
) -> dict[tuple[Path, str], processes.Report]:
    """Return the reports on tasks by `key`, computed by several processes if options say so.

    These have one progress bar, in the unit; otherwise, each recording has its own.
    """
    if options.jobs > 1 or options.scheduler:
        if options.scheduler:
            done = on_cluster(work, tasks, options.scheduler)
        else:
            done = processes.on_this_machine(work, tasks, options.jobs)
        with progress(unit, quiet=options.quiet) as bars:
            tracked = bars.track(done, total=len(tasks), description=unit)
            return {key(task): report for task, report in tracked}
    reports = {}
    for task in tasks:
        with message_progress(task.bag.name, quiet=options.quiet) as report_progress:
            reports[key(task)] = work.run(task, report_progress)
    return reports


def key(task: Any) -> tuple[Path, str]:
    """Return what identifies a task: its bag, and the actuator in its parameters."""
    return task.bag, task.parameters.actuator


@contextmanager
def naming(bag: Path, *others: Path) -> Iterator[None]:
    """Put the bag's name before a ValueError or RuntimeError that names no file."""
    try:
        yield
    except (ValueError, RuntimeError) as error:
        if any(str(path) in str(error) for path in (bag, *others)):
            raise
        kind = RuntimeError if isinstance(error, RuntimeError) else ValueError
        raise kind(f'{bag}: {error}') from error
