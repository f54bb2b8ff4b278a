# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin watch` beside a node and a driver, and a stand-in for what watches them."""

import contextlib
import math
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from pathlib import Path
from typing import NamedTuple

import numpy as np
from live import PATIENT, Participant
from played_joint import played
from rclpy.parameter_client import AsyncParameterClient

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.ros.live import running_node
from gear_kinematics.watch.gear import Answer
from gear_kinematics.watch.view import View

NAMESPACE = f'/watched_{os.getpid()}'
NODE = f'{NAMESPACE}/gear_state_publisher'
MOTOR = f'{NAMESPACE}/motor/joint_states'
ENCODER = f'{NAMESPACE}/output_encoder'
GEARKIN = (sys.executable, '-P', '-m', 'gear_kinematics')
OTHER = f'{NAMESPACE}/other/gear_state_publisher'
DEADLINE = 60.0
ENCODER_RATE = 50  # Hz
RATIO = -19  # rotor speed / output speed


class Program(NamedTuple):
    """A running gearkin."""

    process: subprocess.Popen
    log: Path

    def text(self) -> str:
        return self.log.read_text('utf-8')

    def wait_for(self, pattern: str) -> re.Match:
        """Wait until it has printed a pattern."""
        deadline = time.monotonic() + DEADLINE
        while not (found := re.search(pattern, self.text())):
            assert self.process.poll() is None, self.text()
            assert time.monotonic() < deadline, self.text()
            time.sleep(0.02)
        return found


@contextlib.contextmanager
def gearkin(folder: Path, *arguments: str):
    """Run a command in a folder, and end it as a user does."""
    log = folder / f'{arguments[0]}.log'
    with log.open('w', encoding='utf-8') as stream:
        process = subprocess.Popen(
            [*GEARKIN, *arguments], cwd=folder, stdout=stream, stderr=subprocess.STDOUT
        )
    try:
        yield Program(process, log)
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        try:
            process.wait(DEADLINE)
        finally:
            process.kill()


@contextlib.contextmanager
def node(folder: Path, name: str = NODE):
    """Run the node for the driver, under a full name."""
    arguments = ['--ros-args', '-r', f'__ns:={name.rpartition("/")[0]}', '-p', 'rotor_joint:=m1']
    arguments += ['-r', f'rotor_state:={MOTOR}', '-r', f'output_encoder:={ENCODER}']
    arguments += ['-p', 'transmission_error_window:=2.0', '-p', 'home_max_speed:=10.0', *PATIENT]
    with (
        (folder / 'node.log').open('a', encoding='utf-8') as stream,
        running_node(arguments, stdout=stream, stderr=stream) as process,
    ):
        yield process


@contextlib.contextmanager
def driving(rate: int = 100, late: str = 'left out'):
    """Run the drivers, at a rate in Hz: each message takes all who hear it processor time.

    To a node, `late` readings that are sent would look like a clock set back.
    """
    seconds = np.arange(4 * rate) / rate
    rotor = 60.0 * np.sin(math.tau * seconds / 4.0)
    angle = rotor / RATIO
    output = angle + 1e-4 * np.sin(4.0 * angle)  # rad, the transmission error
    readings, every = np.stack([seconds, rotor, output], 1), rate // ENCODER_RATE
    with played(readings, MOTOR, ENCODER, every, late):
        yield


def parameters(*names: str) -> list:
    """Ask the node for parameters."""
    with contextlib.closing(Participant('asking', NAMESPACE)) as asking:
        return asking.parameters_of(AsyncParameterClient(asking.node, NODE), *names)


LOST = r'messages?( of \S+)? missing|messages? of /\S+ without any output|ends [\d.]+ s before'
JUDGED = rf'verdict: (passed|failed: [^;]*({LOST})[^;]*); \d+ inputs, \d+ outputs compared, '
"""What is said of a recording without a wrong number, which may lack what a busy machine lost."""


class WatcherStandIn:
    """Shows one view, answers every command, and notes what it is asked for."""

    def __init__(self, view: View) -> None:
        """Take the view."""
        self.view = view
        self.drawn = Mechanism(80, 76, 0.0011, (Branch('a'),)), 0.0005
        self.asked: list = []

    def ask(self, command) -> Future:
        """Answer a command with its name."""
        self.asked.append(command)
        answer: Future = Future()
        answer.set_result(Answer(f'{command["do"]}.', done=True))
        return answer
