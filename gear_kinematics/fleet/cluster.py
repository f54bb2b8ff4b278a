# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Works through many recordings on the workers of a Dask scheduler."""

import logging
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from socket import gethostname
from typing import Any
from urllib.parse import urlsplit

from gear_kinematics.fleet.processes import Report, Work

_PATIENCE = 30  # seconds for the first worker, which some clusters start only for tasks


def on_cluster(
    work: Work[Any, Report], tasks: Sequence[Any], scheduler: str
) -> Iterator[tuple[Any, Report]]:
    """Work on a cluster; yields tasks and reports as they are ready.

    Workers are given the absolute path of the `bag` of a task, which is a dataclass.

    The scheduler gives a recording whose worker dies to another one, and gives it up after the
    number of deaths that is set there.

    Raises:
        RuntimeError: if the scheduler cannot be reached, or has no workers.
        ModuleNotFoundError: without distributed.
    """
    from distributed import Client, KilledWorker, as_completed  # noqa: PLC0415, an extra

    # Else it warns of each recording that is begun again because its worker died.
    logging.getLogger('distributed.client').setLevel(logging.ERROR)
    try:
        parts = urlsplit(scheduler)
        if parts.scheme not in {'tcp', 'tls'} or not parts.port:
            raise ValueError  # Client would print tracebacks
        client = Client(scheduler)
    except (OSError, ValueError) as error:
        cause = f'no Dask scheduler answers at {scheduler}: it needs the form tcp://HOST:PORT'
        raise RuntimeError(cause) from error
    with client:
        futures = {
            client.submit(_run, work.run, task, task.bag.absolute(), pure=False): task
            for task in tasks
        }
        try:
            client.wait_for_workers(1, _PATIENCE)
        except TimeoutError as error:
            cause = f'the Dask scheduler {scheduler} has no workers: start some with `dask worker`'
            raise RuntimeError(cause) from error
        for future in as_completed(futures):
            task = futures.pop(future)
            try:
                yield task, future.result()
            except KilledWorker:
                yield task, work.lost(task, 'its worker died repeatedly')
            except Exception as error:  # noqa: BLE001, the error says what a worker lacks
                cause = ' '.join(str(error).split())
                yield task, work.lost(task, f'not read on the cluster: {cause}')


def _run(run: Callable[[Any], Report], task: Any, bag: Path) -> Report:
    if not bag.exists():
        raise FileNotFoundError(f'{gethostname()} has no {bag}, which all workers must see')
    return run(replace(task, bag=bag))
