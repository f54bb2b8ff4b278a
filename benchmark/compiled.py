# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The C++ node of the benchmarks, which is built where rclcpp is installed."""

import shutil
import subprocess
from pathlib import Path

_NAME = 'rclcpp_node'
_SOURCE = Path(__file__).parent / _NAME
_BUILD = _SOURCE.parents[1] / 'build' / _NAME


class NotBuiltError(RuntimeError):
    """There is no C++ node; the text says why in a line."""


def rclcpp_node() -> Path:
    """Give the C++ node, after having built what is new of it.

    Raises:
        NotBuiltError: if something is missing for that, or it fails.
    """
    if not (cmake := shutil.which('cmake')):
        raise NotBuiltError('there is no cmake on the path')
    _BUILD.mkdir(parents=True, exist_ok=True)
    for arguments in (
        ('-S', _SOURCE, '-B', _BUILD, '-DCMAKE_BUILD_TYPE=Release'),
        ('--build', _BUILD),
    ):
        done = subprocess.run(  # noqa: S603, the project's own
            [cmake, *arguments], capture_output=True, check=False, text=True
        )
        if done.returncode:
            if 'Findrclcpp.cmake' in done.stderr:
                raise NotBuiltError('CMake does not find rclcpp')
            log = _BUILD / 'failed.log'
            log.write_text(done.stdout + done.stderr, 'utf-8')
            raise NotBuiltError(f'its build has failed, see {log}')
    return _BUILD / _NAME
