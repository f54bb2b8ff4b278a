# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""When something happened to messages, in bounded memory."""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.report import Lane
from gear_kinematics.wire.cdr import SECOND

Stamps = NDArray[np.int64]

_MAX_SPANS = 400
"""Spans that are kept; with more, neighbours are merged."""


class Occurrences:
    """Counts what happened, and keeps when: as instants, or as spans of neighbouring ones."""

    def __init__(self) -> None:
        self.count = 0
        self.first: int | None = None
        """Stamp of the one that was added first, ns."""
        self.spans = np.zeros((0, 2), np.int64)
        """First and last stamp of each span, (m, 2), ns, ascending."""
        self.apart = 0
        """Spans that are as near as this are merged, ns."""

    def add(self, stamps: Stamps) -> None:
        """Add instants, (n,), ns."""
        self.add_spans(stamps, stamps)

    def add_spans(self, starts: Stamps, ends: Stamps) -> None:
        """Add what lasted from the starts to the ends, (n,), ns."""
        if not len(starts):
            return
        if self.first is None:
            self.first = int(starts[0])
        self.count += len(starts)
        self._merge(np.stack([starts, ends], axis=1))

    def add_all(self, others: 'Occurrences') -> None:
        """Add those of another object."""
        if self.first is None:
            self.first = others.first
        self.count += others.count
        self.apart = max(self.apart, others.apart)
        self._merge(others.spans)

    def _merge(self, added: NDArray[np.int64]) -> None:
        spans = np.concatenate([self.spans, added])
        spans = _joined(spans[np.argsort(spans[:, 0], kind='stable')], self.apart)
        while len(spans) > _MAX_SPANS:
            gaps = np.sort(spans[1:, 0] - spans[:-1, 1])
            self.apart = max(2 * self.apart, int(gaps[len(spans) - _MAX_SPANS - 1]))
            spans = _joined(spans, self.apart)
        self.spans = spans


def lanes(
    topic: str, events: Mapping[str, Occurrences], start: int, *, fails: bool = True
) -> Iterator[Lane]:
    """Yield a lane of a plot for each event that happened, with the time 0 at a stamp, ns."""
    for event, found in events.items():
        if found.count:
            times = (found.spans - start) / SECOND
            yield Lane(topic, event, found.count, [(a, b) for a, b in times.tolist()], fails)


def _joined(spans: NDArray[np.int64], apart: int) -> NDArray[np.int64]:
    """Join ascending spans, (n, 2), of which the next one begins as near as this."""
    if not len(spans):
        return spans
    reach = np.maximum.accumulate(spans[:, 1])
    first = np.flatnonzero(np.append(True, spans[1:, 0] - reach[:-1] > apart))
    return np.stack([spans[first, 0], np.maximum.reduceat(reach, first)], axis=1)
