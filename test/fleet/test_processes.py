# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bags one by one, and in processes that are killed."""

import json
import multiprocessing
import os
import re
import shutil
import signal
import subprocess
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest
from blocked_bags import BAGS, DEADLINE, GEARKIN, BlockedBag, gearkin, running_gearkin, wait_until

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.fleet.processes import Work, on_this_machine
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validate_bag import WORK, validate_bag

COMPARED = {
    'constant_speed_3000rpm': 3000,
    'driver_faults': 1265,
    'servo_point_to_point': 3000,
    'single_turn_encoder': 2500,
}

SHIPPED = [*COMPARED]


def task(path: Path, **options) -> Task:
    folder = BAGS / path.name
    beside = folder / 'actuator.yaml'
    config = beside if beside.exists() else default_config()
    return Task(path, NodeParameters.load(config), str(config), **options)


# One bag.


def test_a_shipped_bag_is_reported():
    told = []
    report = validate_bag(task(BAGS / 'driver_faults'), lambda *progress: told.append(progress))
    assert (report.verdict, report.error) == (Verdict.PASS, None)
    assert (report.bag, report.config) == (str(BAGS / 'driver_faults'), str(default_config()))
    assert [topic.compared for topic in report.topics] == [1265, 1265]
    assert told[-1] == (report.messages, report.messages) == (1314 + 2 * 1265,) * 2
    assert {total for _, total in told} == {report.messages}


BROKEN = """import gear_kinematics.validation.validate_bag as fleet
honest = fleet.find_topics
def find_topics(bag, *_, **__):
    return 1 // (bag.path.name != 'driver_faults') and honest(bag)
fleet.find_topics = find_topics
"""


@pytest.mark.slow
@pytest.mark.parametrize('options', [[], ['--debug']])
def test_an_unexpected_error_makes_one_bag_unusable_and_no_other(options):
    bags = [BAGS / name for name in ('driver_faults', 'constant_speed_3000rpm')]
    done = gearkin('validate', *options, *bags, code=BROKEN + GEARKIN)
    assert done.returncode == 2
    said = f'gearkin: {bags[0]}: unexpected ZeroDivisionError: '
    lines = done.stderr.splitlines()
    assert lines[-1].startswith(said)
    assert lines[-1].endswith('; --debug shows where') == (not options)
    assert ('Traceback' in done.stderr) == bool(options)
    assert len(lines) == 1 or options
    assert f'{bags[0]}: verdict: unusable: unexpected ' in done.stdout
    assert f'{bags[1]}: verdict: passed; ' in done.stdout


def test_a_bag_that_is_cut_off_is_reported_as_far_as_it_goes(tmp_path):
    path = tmp_path / 'cut.mcap'
    shutil.copy(BAGS / 'servo_point_to_point' / 'servo_point_to_point_0.mcap', path)
    os.truncate(path, path.stat().st_size // 2)
    readable = []
    with Bag(path) as bag, pytest.raises(BagError):
        readable.extend(bag.messages(bag.topics))
    report = validate_bag(task(path))
    assert report.verdict == Verdict.UNUSABLE
    assert re.fullmatch(
        rf'{path}: at byte \d+: cut off within a record; mcap recover .*', report.error
    )
    assert 3000 < report.messages == len(readable) < 9000
    assert report.rotor.valid > 1000
    for topic in report.topics:
        assert topic.compared > 1000
        assert all(field.passed for field in topic.fields)


# Processes.


@pytest.mark.slow
def test_processes_report_what_one_after_the_other_does():
    tasks = [task(BAGS / name) for name in SHIPPED]
    tasks.append(task(BAGS / 'missing'))
    done = (report for _, report in on_this_machine(WORK, tasks, 2))
    reports = sorted(done, key=lambda report: report.bag)
    one_by_one = sorted(map(validate_bag, tasks), key=lambda report: report.bag)
    # A NaN, where a curve has a gap, equals no other.
    assert list(map(repr, reports)) == list(map(repr, one_by_one))
    assert [report.verdict for report in reports].count(Verdict.PASS) == len(SHIPPED)


def copies(folder: Path) -> list[Path]:
    """Copy every shipped bag, as a fleet's would be."""
    return [Path(shutil.copytree(BAGS / name, folder / name)) for name in SHIPPED]


def check_reports(path: Path, bags: list[Path], lost: Path | None = None) -> None:
    """Every bag is reported, once, in order, and with all of its messages."""
    reports = json.loads(path.read_text('utf-8'))['bags']
    assert [report['bag'] for report in reports] == [str(bag) for bag in bags]
    for bag, report in zip(bags, reports, strict=True):
        if bag == lost:
            assert report['verdict'] == 'unusable'
            assert report['error'].endswith('its worker died repeatedly')
            assert report['topics'] == []
        else:
            assert report['verdict'] == 'pass'
            assert [t['compared'] for t in report['topics']] == [COMPARED[bag.name]] * 2


def kill_readers(blocked: BlockedBag, process) -> int:
    """Kill whoever reads a bag, until the process ends; tells how many there were."""
    killed = []

    def ended() -> bool:
        for reader in blocked.readers():
            with suppress(ProcessLookupError):  # it has ended meanwhile
                os.kill(reader, signal.SIGKILL)
                killed.append(reader)
        return process.poll() is not None

    wait_until(ended, 'the end of gearkin')
    return len(set(killed))


@pytest.mark.slow
def test_as_many_bags_as_there_are_jobs_are_under_way(tmp_path):
    with ExitStack() as stack:
        blocked = [
            stack.enter_context(BlockedBag(BAGS / SHIPPED[k], tmp_path / str(k))) for k in range(2)
        ]
        process = stack.enter_context(running_gearkin('validate', '--jobs', 2, tmp_path))
        readers = {bag.reader() for bag in blocked}
        assert len(readers) == 2
        assert process.pid not in readers


@pytest.mark.slow
def test_a_bag_whose_process_died_is_begun_again(tmp_path):
    bags = [*copies(tmp_path / 'copies'), tmp_path / 'driver_faults']
    report = tmp_path / 'report.json'
    with (
        BlockedBag(BAGS / 'driver_faults', bags[-1]) as blocked,
        running_gearkin('validate', '--jobs', 2, '--json', report, *bags) as process,
    ):
        reader = blocked.reader()
        blocked.heal()
        os.kill(reader, signal.SIGKILL)
        _, errors = process.communicate(timeout=DEADLINE)
    assert (process.returncode, errors) == (0, '')
    check_reports(report, bags)


@pytest.mark.slow
@pytest.mark.parametrize('place', [0, 4])
def test_a_bag_whose_process_dies_again_and_again_is_lost_and_no_other(place, tmp_path):
    bags = copies(tmp_path / 'bags')
    lost = tmp_path / 'bags' / 'killer'
    bags.insert(place, lost)
    report = tmp_path / 'report.json'
    with ExitStack() as stack:
        blocked = stack.enter_context(BlockedBag(BAGS / 'driver_faults', lost))
        arguments = ['validate', '--jobs', 2, '--json', report, *bags]
        process = stack.enter_context(running_gearkin(*arguments, stdout=subprocess.DEVNULL))
        killed = kill_readers(blocked, process)
        _, errors = process.communicate(timeout=DEADLINE)
    assert process.returncode == 2
    assert errors == f'gearkin: {lost}: its worker died repeatedly\n'
    assert killed == 3
    check_reports(report, bags, lost)


def test_processes_end_even_within_a_report():
    """One whose report is not taken is in the midst of sending it."""
    others = multiprocessing.active_children()
    reports = on_this_machine(Work(bytes, None), [2**24] * 3, 2)
    assert next(reports) == (2**24, bytes(2**24))
    reports.close()
    wait_until(lambda: multiprocessing.active_children() == others, 'the end of the processes')
