# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What every test needs: a ROS domain of its own, hypothesis profiles, gears, shared data."""

import atexit
import os
import signal
import socket
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def _free_domain() -> int:
    """Find a ROS domain that nobody on this machine uses, and reserve it for this process.

    Its discovery port is bound while it has participants. As tests have none at times, the last of
    its ports is kept bound as well, which only its 119th participant would need.
    """
    # Sessions that start at the same moment begin their search at different domains.
    candidates = [1 + (os.getpid() + k) % 101 for k in range(101)]
    for domain in candidates:
        reserved = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(('127.0.0.1', 7400 + 250 * domain))
                reserved.bind(('127.0.0.1', 7649 + 250 * domain))
            except OSError:
                reserved.close()
                continue
            atexit.register(reserved.close)
            return domain
    raise RuntimeError('every ROS domain from 1 to 101 is in use on this machine')


# Before anything else is imported: middleware reads the environment once.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_DOMAIN_ID'] = str(_free_domain())
with suppress(PackageNotFoundError):
    # From Kilted on, Fast DDS warns of its former name.
    name = 'FASTRTPS' if int(version('rclpy').split('.')[0]) < 9 else 'FASTDDS'
    PROFILES = f'{name}_DEFAULT_PROFILES_FILE'
    os.environ[PROFILES] = str(Path(__file__).with_name('support') / 'discovery.xml')
# Threads of linear algebra that wait for a busy processor take ten times as long as one alone.
os.environ['OPENBLAS_NUM_THREADS'] = '1'

# A background job of a shell ignores SIGINT, and so would every process that a test starts.
signal.signal(signal.SIGINT, signal.default_int_handler)

import gc  # noqa: E402, see above
import math  # noqa: E402
from collections import Counter  # noqa: E402
from collections.abc import Callable  # noqa: E402

import hypothesis  # noqa: E402
import pytest  # noqa: E402
from chromium import chromium  # noqa: E402

from gear_kinematics.kinematics import Branch, Mechanism  # noqa: E402
from gear_kinematics.parameters import NodeParameters  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / 'shared'

# A tenth of the time of tests went into garbage collections; so they are rarer in this process.
gc.set_threshold(50_000)

hypothesis.settings.register_profile('default', deadline=None)
hypothesis.settings.register_profile(
    'ci', parent=hypothesis.settings.get_profile('default'), derandomize=True
)
hypothesis.settings.register_profile(
    'quick', parent=hypothesis.settings.get_profile('ci'), max_examples=20
)
hypothesis.settings.load_profile('ci' if 'CI' in os.environ else 'default')


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files of live tests, and then of slow ones; the fewer a file has, the later.

    Workers take the files in this order: others compute while live tests wait, and at the end no
    worker is left alone with a long file.
    """
    marks: dict[Path, Counter[str]] = {}
    for item in items:
        marks.setdefault(item.path, Counter()).update(
            mark for mark in ('live', 'slow') if item.get_closest_marker(mark)
        )
    items.sort(key=lambda item: (not marks[item.path]['live'], -marks[item.path].total()))


def pytest_collection_finish() -> None:
    """Leave all that was imported out of garbage collections, a twentieth of the tests' time."""
    gc.freeze()


@pytest.fixture(scope='session')
def shared_path() -> Callable[[str], Path]:
    """Give the path of recorded data beside the repository, or skip the test and say why."""

    def find(relative: str) -> Path:
        path = SHARED / relative
        if not path.exists():
            pytest.skip(f'no recorded data at {path}')
        return path

    return find


@pytest.fixture(scope='session')
def recorded() -> list:
    """The first 300 samples of a shipped bag and their outputs, as rosbags reads them."""
    from shipped_bags import BAGS, TYPES, read_bag  # noqa: PLC0415, only where rosbags is

    messages = read_bag(BAGS / 'servo_point_to_point')
    assert len(messages) == 9000
    assert {topic for topic, _, _ in messages} == set(TYPES)
    return messages[:900]


@pytest.fixture(scope='session')
def actuator() -> Mechanism:
    """Return the mechanism of the default configuration."""
    branches = (
        Branch('a', axial_position=0.04),
        Branch('b', cam_phase=math.pi, axial_position=-0.04),
    )
    return Mechanism(80, 76, 0.0011, branches)


@pytest.fixture(scope='module')
def browser():
    with chromium() as browser:
        yield browser


@pytest.fixture
def figures(monkeypatch) -> list:
    """Collect the figures that matplotlib makes."""
    module = pytest.importorskip('matplotlib.figure', reason='matplotlib is not installed')
    made = []

    class Kept(module.Figure):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            made.append(self)

    monkeypatch.setattr(module, 'Figure', Kept)
    return made


@pytest.fixture(scope='module')
def context():
    """Give a context of rclpy for nodes in the process of the test."""
    rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
    from rclpy.signals import SignalHandlerOptions  # noqa: PLC0415, only where rclpy is

    context = rclpy.Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield context
    rclpy.shutdown(context=context)


@pytest.fixture(scope='module')
def config() -> NodeParameters:
    """Return the default parameters of the node."""
    return NodeParameters.load()


@pytest.fixture(
    params=[(80, 76, 1), (80, 76, 2), (80, 78, 2), (61, 58, 3), (7, 2, 4), (2, 1, 1)],
    ids=lambda numbers: '{}-{}-{}'.format(*numbers),
)
def mechanism(request) -> Mechanism:
    """Return mechanisms with ring teeth, satellite teeth and branches, evenly spread cams."""
    ring_teeth, satellite_teeth, count = request.param
    branches = tuple(
        Branch('abcd'[k], cam_phase=2.0 * math.pi * k / count, axial_position=0.04 - 0.03 * k)
        for k in range(count)
    )
    return Mechanism(ring_teeth, satellite_teeth, 0.0011, branches)
