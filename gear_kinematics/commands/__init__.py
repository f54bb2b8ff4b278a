# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The subcommands of `gearkin`, one module each.

Each module has `add_arguments(parser)` and `run(options)`, which returns the exit code and raises
ValueError, OSError or RuntimeError with a text of one line if input or arguments are unusable. It
imports no other command; common functions are in `arguments` and `output`. Commands compute
nothing: their results come from the other sub-packages.
"""

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes of `gearkin`."""

    DONE = 0
    FAILED = 1  # a check failed
    UNUSABLE = 2  # the input or the arguments are unusable; stderr has one line on the cause
