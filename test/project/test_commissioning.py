# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The commands of docs/commissioning.md, beside the drivers of a joint that they know not."""

import contextlib
import math
import os
import re
import shlex
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from blocked_bags import wait_until
from live import Peer, stamp_of
from played_joint import moments, played
from simulated_encoders import Drive
from terminals import Person

from gear_kinematics.ros.live import running_node

pytestmark = [pytest.mark.live, pytest.mark.slow]

ROOT = Path(__file__).resolve().parents[2]
ROTOR, ENCODER = '/motor/joint_states', '/encoder/joint_states'
PAGE = (ROOT / 'docs/commissioning.md').read_text('utf-8')
DEGREE = math.pi / 180.0


def command(*words: str) -> list[str]:
    """Give the arguments of the only command of the page with these words."""
    lines = re.findall(r'^    (\w.*)$', re.sub(r'\\\n\s*', '', PAGE), re.MULTILINE)
    found = [shlex.split(line, comments=True) for line in lines]
    [(_, *arguments)] = [each for each in found if set(words) <= set(each)]
    return arguments


class Joint(NamedTuple):
    """What the drivers of a joint publish, and what is to be found."""

    readings: np.ndarray  # (n, 3): s, rad of the rotor, rad of the output's encoder
    truth: np.ndarray  # (n,), rad
    tolerance: float  # rad, the transmission error
    ratio: str
    forgets: bool  # whether the motor counts from where it was switched on


def simulated() -> Joint:
    """A gear of 30 whose motor counts backwards and wraps, with an encoder that errs by 0.1°."""
    drive = Drive(play=0.05 * DEGREE, errors={1.0: 0.1 * DEGREE}, ratio=30.0, noise=1e-5)
    stroke = np.array([0.0, 0.0, 430.0, 430.0, 0.0]) * DEGREE - 1.0  # there and back
    seconds, rotor, output = drive.readings(
        lambda t: np.interp(t, [0.0, 1.0, 2.5, 3.5, 5.0], stroke), 5.0, 250.0
    )
    readings = np.stack([seconds, (2.0 - rotor) % math.tau, output % math.tau], axis=1)
    return Joint(readings, rotor / 30.0, 0.25 * DEGREE, '-30', forgets=False)


def recorded(path: Path) -> Joint:
    """A joint of a LARA 8, there and back: counts, 2^24 a turn on either side."""
    seconds, motor, load, _ = np.loadtxt(path, delimiter=',', skiprows=1).T
    forwards = np.stack([seconds, motor * math.tau / 2**24, load * math.tau / 2**24], axis=1)
    backwards = forwards[-2:0:-1] * (-1.0, 1.0, 1.0) + (2.0 * seconds[-1], 0.0, 0.0)
    readings = np.concatenate([forwards, backwards])
    return Joint(readings, readings[:, 2], 0.05 * DEGREE, '121', forgets=True)


@pytest.fixture(params=['simulated', 'data/dual_encoders/neura_jogging_joint_mass_joint2.csv'])
def joint(request, shared_path) -> Joint:
    return simulated() if request.param == 'simulated' else recorded(shared_path(request.param))


@contextlib.contextmanager
def driven(joint: Joint, lost: float = 0.0):
    """Run the drivers; yields the true output angle by stamps, ns.

    `lost` is the angle of the motor, rad, at which it was switched on.
    """
    with played(joint.readings - (0.0, lost, 0.0), ROTOR, ENCODER) as first:
        after, rows = moments(joint.readings[:, 0], 100 * len(joint.readings))
        yield dict(zip((first + after).tolist(), joint.truth[rows].tolist(), strict=True))


def gearkin(folder: Path, *arguments: str) -> str:
    """Run a command until it has heard enough, and press Enter; returns what it shows."""

    def shown() -> str:
        with Person(folder, *arguments) as person:
            person.wait_for('the output turned')
            # 6 s of messages, unless it ends by itself before, when everything is known.
            person.wait_for(r'heard +([3-9]\d{3}|\d{5,}) messages|the messages of 20')
            person.type('\n')
            code = person.end()
            assert not code or 'undetermined' in person.shown()
        return '' if code else ' '.join(person.shown().split())

    return wait_until(shown, 'the ratio, of which a busy machine can lose too much')


def test_an_unknown_joint_is_commissioned(joint, tmp_path):
    file = tmp_path / 'actuator.yaml'
    nameplate = re.findall('`(--ratio) (121)`', PAGE)[0] if joint.ratio == '121' else ()
    with driven(joint):
        said = gearkin(tmp_path, *command('commission', '-o'), *nameplate)
    assert f'The gear has the ratio {joint.ratio} (' in said
    [setting] = re.findall(r'`(output_encoder_reference: absolute)`', PAGE)
    file.write_text(f'{file.read_text()}    {setting}\n')
    with driven(joint, lost=37.3 if joint.forgets else 0.0) as truth:
        gearkin(tmp_path, *command('commission', '--check'))
        [start] = re.findall(r'^#     (.*gear_state_publisher.*)$', file.read_text(), re.MULTILINE)
        _, ros, arguments = start.partition('--ros-args')
        with (
            (tmp_path / 'node.log').open('w') as log,
            running_node(
                [ros, *shlex.split(arguments)], cwd=tmp_path, stdout=log, stderr=log,
                env={**os.environ, 'PYTHONPATH': str(ROOT)},
            ),
            contextlib.closing(Peer('')) as peer,
        ):  # fmt: skip
            received = peer.received['output_state']

            def unreferenced() -> str:
                """Wait for a reference; returns for how many inputs there was none so far."""
                _, _, values = peer.status(
                    lambda status: any(
                        (pair.key, pair.value) == ('referenced', 'true') for pair in status.values
                    ),
                    'the reference',
                )
                return values['not referenced']

            def referenced_outputs() -> list:
                before = unreferenced()
                if unreferenced() != before:  # an earlier output may still be on its way
                    return []
                received.clear()
                peer.wait_until(lambda: len(received) >= 500, 'outputs')
                compared = [*received]
                return compared if unreferenced() == before else []

            # On a busy machine messages are lost, and the turns can become unknown at any time.
            compared = peer.wait_until(referenced_outputs, 'outputs with a reference')
    errors = [math.remainder(m.position[0] - truth[stamp_of(m)], math.tau) for m in compared]
    assert max(map(abs, errors)) <= joint.tolerance
