# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How often something happened to messages, and when first."""

import numpy as np
from numpy.typing import NDArray

Stamps = NDArray[np.int64]


class Occurrences:
    """Counts what happened."""

    def __init__(self) -> None:
        self.count = 0
        self.first: int | None = None
        """Stamp of the one that was added first, ns."""

    def add(self, stamps: Stamps) -> None:
        """Add what happened at stamps, (n,), ns."""
        if self.first is None and len(stamps):
            self.first = int(stamps[0])
        self.count += len(stamps)

    def add_all(self, others: 'Occurrences') -> None:
        """Add those of another object."""
        if self.first is None:
            self.first = others.first
        self.count += others.count
