# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The entry points of the programs, which handle signals before slow imports.

Otherwise a signal during the import of ROS or numpy would raise KeyboardInterrupt somewhere in it,
which ends in a traceback or is even ignored.
"""

import os
import signal
import sys
import time
from collections.abc import Callable, Collection
from contextlib import suppress
from importlib import import_module
from itertools import takewhile
from math import inf
from types import FrameType

from gear_kinematics.ros.workarounds.shared_memory import SharedMemoryError, check_shared_memory

_INTERRUPTED = 130  # exit code, as in shells
_UNUSABLE = 2  # exit code: a package or memory is lacking, or arguments are unknown
_NODE_HELP = """\
usage: {program} [--help] [--version] [--ros-args ...]

{purpose}

options:
  -h, --help       show this help and exit
  --version        show the version and exit
  --ros-args ...   parameters, remappings and other arguments of ROS 2 nodes, such as
                   --ros-args -p rotor_joint:=m1 -r rotor_state:=/motor/joint_states
                   --ros-args --params-file my_actuator.yaml

Exit codes: 0 ended by SIGINT or SIGTERM, 2 unusable parameters or arguments.
"""
_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_PATIENCE = 2.0
"""s to wait for the end of an import, and to ignore repeated signals: launchers signal a process
and its group."""
_RETRY = 0.01  # s, period of SIGALRM, which repeats an interruption without effect


def gear_state_publisher() -> int:
    """Run the node; returns the exit code, which is 0 after a signal."""
    purpose = 'Publish the output angle and the body poses for every message on rotor_state.'
    return _run_node('gear_state_publisher', purpose, 'node', 'GearStatePublisher')


def gear_simulator() -> int:
    """Run the actuator without hardware; returns the exit code, which is 0 after a signal."""
    purpose = 'Move a simulated gear by rotor_command and load_torque, and publish its encoders.'
    return _run_node('gear_simulator', purpose, 'simulator', 'GearSimulator')


def gearkin() -> int:
    """Run the command line; returns the exit code."""
    # Shell scripts start background jobs with SIGINT ignored, which must remain so.
    heeded = [number for number in _STOP_SIGNALS if signal.getsignal(number) != signal.SIG_IGN]
    heeded.append(signal.SIGALRM)

    def load() -> Callable[[], int]:
        if sys.argv[1:] == ['--version']:
            from gear_kinematics.share import version  # noqa: PLC0415, imports pathlib

            return lambda: _answer(f'gearkin {version()}\n')
        from gear_kinematics.commands.cli import main  # noqa: PLC0415, slow

        interruption = _Interruption()
        _handle(heeded, interruption.handle)
        sys.unraisablehook = interruption.repeat
        return main

    return _run('gearkin', load, interrupted=_INTERRUPTED, stop_signals=heeded)


def _run_node(program: str, purpose: str, module: str, name: str) -> int:
    """Run the node of a class in a module of `ros`."""

    def load() -> Callable[[], int]:
        own = list(takewhile('--ros-args'.__ne__, sys.argv[1:]))
        if '-h' in own or '--help' in own:
            return lambda: _answer(_NODE_HELP.format(program=program, purpose=purpose))
        if '--version' in own:
            from gear_kinematics.share import version  # noqa: PLC0415, imports pathlib

            return lambda: _answer(f'{program} {version()}\n')
        if own:  # such as --params-file, which ROS would ignore
            fault = f'unknown arguments {own}: those of ROS follow --ros-args'
            print(f'{program}: {fault}', file=sys.stderr)
            return lambda: _UNUSABLE
        if warning := check_shared_memory():
            print(f'{program}: {warning}', file=sys.stderr)
        from gear_kinematics.ros.process import main  # noqa: PLC0415, slow

        node = getattr(import_module(f'gear_kinematics.ros.{module}'), name)
        return lambda: main(node, program)

    return _run(program, load, interrupted=0, stop_signals=_STOP_SIGNALS)


def _run(
    program: str,
    load: Callable[[], Callable[[], int]],
    *,
    interrupted: int,
    stop_signals: Collection[signal.Signals],
) -> int:
    """Load a program and run it; returns its exit code, or `interrupted` after a signal."""
    _handle(stop_signals, lambda *_: os._exit(interrupted))  # nothing needs to be cleaned up yet
    # The matrices are small: beside a node and drivers, threads of numpy wait for each other.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    _open_closed_streams()
    try:
        return _flushed(program, load())
    except KeyboardInterrupt:
        return interrupted
    except SharedMemoryError as error:
        print(f'{program}: {error}', file=sys.stderr)
        return _UNUSABLE
    except ImportError as error:
        from gear_kinematics.commands.extras import remedy  # noqa: PLC0415, imports argparse

        print(f'{program}: {remedy(error)}', file=sys.stderr)
        return _UNUSABLE
    finally:
        # At exit, Python restores the default of other handlers, which kills the process.
        _handle(stop_signals, signal.SIG_IGN)


def _flushed(program: str, run: Callable[[], int]) -> int:
    """Run a program and write out what it printed, with one line where that fails."""
    code = 0
    try:
        try:
            code = run()
        except SystemExit as end:  # of argparse, after --help
            code = int(end.code or 0)
        sys.stdout.flush()
    except OSError as error:
        sys.stdout = open(os.devnull, 'w')  # noqa: PTH123, SIM115, for the interpreter's last flush
        if not isinstance(error, BrokenPipeError) and code != _UNUSABLE:  # not yet reported
            with suppress(OSError):
                print(f'{program}: {error}', file=sys.stderr)
            code = _UNUSABLE
    return code


def _answer(text: str) -> int:
    sys.stdout.write(text)
    return 0


def _handle(
    numbers: Collection[signal.Signals],
    handler: Callable[[int, FrameType | None], object] | signal.Handlers,
) -> None:
    for number in numbers:
        signal.signal(number, handler)


class _Interruption:
    """Raises KeyboardInterrupt once for repeated signals, and makes sure that it has effect."""

    def __init__(self) -> None:
        self._asked = -inf  # time.monotonic()

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Raise KeyboardInterrupt, unless the clean-up after another signal is in progress.

        Wait for an import to end first: exceptions within are often dropped or converted to other
        errors.
        """
        age = time.monotonic() - self._asked
        if number != signal.SIGALRM:
            if age < _PATIENCE:
                return
            self._asked, age = time.monotonic(), 0.0
        if age < _PATIENCE and _imports(frame):
            signal.setitimer(signal.ITIMER_REAL, _RETRY)
        else:
            raise KeyboardInterrupt

    @staticmethod
    def repeat(unraisable: 'sys.UnraisableHookArgs') -> None:
        """Repeat an interruption that Python dropped in a destructor or a callback."""
        if unraisable.exc_type is KeyboardInterrupt:
            signal.setitimer(signal.ITIMER_REAL, _RETRY)
        else:
            sys.__unraisablehook__(unraisable)


def _imports(frame: FrameType | None) -> bool:
    """Return whether an import is in progress."""
    while frame and frame.f_code.co_filename != '<frozen importlib._bootstrap>':
        frame = frame.f_back
    return frame is not None


def _open_closed_streams() -> None:
    """Open the null device for each closed standard stream (`2>&-`).

    Python sets it to None, and its file descriptor would be reused by the next file or socket, to
    which libraries would then print.
    """
    for name, mode in (('stdin', 'r'), ('stdout', 'w'), ('stderr', 'w')):
        if getattr(sys, name) is None:
            stream = open(os.devnull, mode)  # noqa: PTH123, SIM115, open until the end
            os.set_inheritable(stream.fileno(), True)  # noqa: FBT003
            setattr(sys, name, stream)


if __name__ == '__main__':
    sys.exit(gearkin())
