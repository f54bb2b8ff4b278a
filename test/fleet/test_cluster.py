# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings on a Dask scheduler with two workers, on this machine."""

import json
import os
import shutil
import signal
import sys
from contextlib import ExitStack

import pytest
from blocked_bags import (
    BAGS,
    DEADLINE,
    BlockedBag,
    gearkin,
    gearkin_here,
    refusal,
    running_gearkin,
    started,
    wait_until,
)

NAMES = 'driver_faults', 'servo_point_to_point', 'single_turn_encoder'

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def cluster(tmp_path_factory):
    """Start both, each worker without a nanny that would start another one; gives the address."""
    folder = tmp_path_factory.mktemp('cluster')
    file, log = folder / 'scheduler.json', folder / 'cluster.log'
    common = '--scheduler-file', file, '--no-dashboard'
    command = sys.executable, '-m', 'distributed.cli.dask_scheduler', '--port', '0'
    worker = sys.executable, '-m', 'distributed.cli.dask_worker', '--no-nanny', '--nthreads', '1'
    with ExitStack() as stack, log.open('w', encoding='utf-8') as stream:

        def start(*words):
            command = map(str, (*words, '--host', '127.0.0.1', *common))
            stack.enter_context(started([*command], stdout=stream, stderr=stream))

        start(*command)
        wait_until(lambda: file.exists() and file.stat().st_size, 'the scheduler')
        for name in 'one', 'two':
            start(*worker, '--name', name, '--local-directory', folder / name)
        yield json.loads(file.read_text('utf-8'))['address']


def test_a_cluster_reports_what_processes_report(cluster, tmp_path):
    for name in NAMES:
        shutil.copytree(BAGS / name, tmp_path / 'bags' / name)
    (tmp_path / 'bags' / 'empty.mcap').touch()
    done = {}
    for way in (['--jobs', 2], ['--scheduler', cluster]):
        report = tmp_path / f'{way[0]}.json'
        # Relative to a folder that is not the workers'
        result = gearkin('validate', 'bags', *way, '--json', report, cwd=tmp_path)
        texts = result.stdout, result.stderr, report.read_text('utf-8')
        # Workers name absolute paths in errors.
        done[way[0]] = result.returncode, *(text.replace(f'{tmp_path}/', '') for text in texts)
    assert done['--scheduler'] == done['--jobs']
    code, _, errors, reports = done['--jobs']
    assert (code, len(json.loads(reports)['bags']), errors.count('\n')) == (2, 4, 1)


def test_loads_are_reported_by_a_cluster(cluster, tmp_path):
    bag = BAGS / 'servo_point_to_point'
    config = BAGS.parent / 'docs' / 'examples' / 'preloaded.yaml'
    arguments = 'loads', bag, '--config', config, '--force', '--json', tmp_path / 'loads.json'
    found = []
    for way in ([], ['--scheduler', cluster]):
        assert gearkin_here(*arguments, *way).returncode == 1
        found.append(json.loads((tmp_path / 'loads.json').read_text('utf-8')))
    assert found[0] == found[1]


def test_a_bag_that_a_worker_cannot_see_is_one_line(cluster, tmp_path):
    """It is removed once gearkin has found it."""
    gone = shutil.copytree(BAGS / NAMES[0], tmp_path / 'gone')
    code = (
        'import shutil, sys\n'
        'from gear_kinematics.commands import bags\n'
        'from gear_kinematics.__main__ import gearkin\n'
        'work = bags.on_cluster\n'
        f'bags.on_cluster = lambda *given: shutil.rmtree({str(gone)!r}) or work(*given)\n'
        'sys.exit(gearkin())\n'
    )
    done = gearkin('validate', gone, BAGS / NAMES[1], '--scheduler', cluster, code=code)
    assert done.returncode == 2
    assert done.stderr.count('\n') == 1, done.stderr
    assert f'has no {gone}, which all workers must see' in done.stderr


def test_a_worker_that_is_killed_loses_no_recording(cluster, tmp_path):
    """It is the last test of the cluster, which has one worker from then on."""
    report = tmp_path / 'report.json'
    bags = [BAGS / name for name in NAMES[1:]] + [tmp_path / NAMES[0]]
    with (
        BlockedBag(BAGS / NAMES[0], bags[-1]) as blocked,
        running_gearkin('validate', '--scheduler', cluster, '--json', report, *bags) as process,
    ):
        reader = blocked.reader()
        blocked.heal()
        os.kill(reader, signal.SIGKILL)
        _, errors = process.communicate(timeout=DEADLINE)
    assert (process.returncode, errors) == (0, '')
    reports = json.loads(report.read_text('utf-8'))['bags']
    assert [each['bag'] for each in reports] == [str(bag) for bag in bags]
    assert {each['verdict'] for each in reports} == {'pass'}


@pytest.mark.parametrize('address', ['tcp://127.0.0.1:9', 'nonsense://x', 'tcp://127.0.0.1:x'])
def test_a_scheduler_that_cannot_be_reached_is_one_line(address):
    config = pytest.importorskip('dask.config', reason='dask is not installed')
    with config.set({'distributed.comm.timeouts.connect': '1s'}):
        error = refusal('validate', BAGS / NAMES[0], '--scheduler', address)
    assert error == f'no Dask scheduler answers at {address}: it needs the form tcp://HOST:PORT'
