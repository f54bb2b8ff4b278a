# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The error that the kinematics core raises."""


class MechanismError(ValueError):
    """A mechanism that cannot exist; `faults` lists everything that is wrong with it."""

    def __init__(self, faults: list[str]) -> None:
        """Keep all faults, so that they can be corrected together."""
        self.faults = tuple(faults)
        super().__init__('; '.join(faults))
