# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads sqlite3 files."""

import sqlite3
import struct
from collections.abc import Collection, Iterator
from contextlib import suppress
from itertools import pairwise
from operator import le
from pathlib import Path
from typing import Any

from gear_kinematics.bag.codecs import ReadLimits
from gear_kinematics.bag.runs import starts_of_runs
from gear_kinematics.bag.storage import Message, Storage, Topic

_STEPS = 1000
_SAMPLED, _TIME_OF_ROW = 1000, 'SELECT timestamp FROM messages WHERE id = ?'
_LATEST = 2**63 - 1  # number of a row
_PIECE, _PIECE_SIZE = 256, 2**20  # messages, bytes


class Sqlite(Storage):
    """An sqlite3 file."""

    def __init__(self, path: Path, limits: ReadLimits) -> None:
        super().__init__(limits)
        _check_size(path)
        # Without a journal nothing changes: it needs no locks, which read-only media lack.
        journal = path.with_name(f'{path.name}-wal')
        options = '?mode=ro' if journal.exists() else '?mode=ro&immutable=1'
        uri = path.absolute().as_uri() + options
        self._database = sqlite3.connect(uri, uri=True, check_same_thread=False)
        # With this, sqlite reads as much as possible of a truncated file.
        self._database.execute('PRAGMA writable_schema=ON')
        # Pages that occur repeatedly in a tree, or views, make an endless number of rows.
        self._size = sum(file.stat().st_size for file in (path, journal) if file.exists())
        self._steps = 100_000 + 10 * self._size
        self._database.set_progress_handler(self._spend, _STEPS)
        # Computed columns may have any size.
        self._database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, self._size)

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def _rows(self, table: str) -> list[dict[str, Any]]:
        rows = []
        cursor = self._database.execute(f'SELECT * FROM {table}')  # noqa: S608, our own names
        names = [column[0] for column in cursor.description]
        for row in cursor:
            self.limits.describe(*map(str, row))
            rows.append(dict(zip(names, row, strict=True)))
        return rows

    def _spend(self) -> bool:
        """Count steps of sqlite's virtual machine; returns True to stop it at the limit."""
        self._steps -= _STEPS
        return self._steps < 0

    def topics(self) -> list[Topic]:
        """Return the rows of the table of topics."""
        return list(self._topics().values())

    def _topics(self) -> dict[int, Topic]:
        definitions = {}
        with suppress(sqlite3.Error):  # absent before version 4 of the schema
            definitions = {row['topic_type']: row for row in self._rows('message_definitions')}
        topics = {}
        for row in self._rows('topics'):
            topics[row['id']] = Topic.of(definitions.get(row['type'], {}) | row)
        return topics

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages in the order of reception."""
        known = self._topics()
        wanted = {key: topic for key, topic in known.items() if topic.name in topics}
        for topic in wanted.values():
            self.check_encoding(topic)
        names = {key: topic.name for key, topic in wanted.items()}
        chosen = [] if len(names) == len(known) else list(names)
        starts = self._starts_of_runs()
        for first, end in pairwise([-_LATEST - 1, *starts, _LATEST] if starts else []):
            yield from self._messages(names, chosen or list(names), first, end)
        if not starts:
            yield from self._messages(names, chosen)

    def _starts_of_runs(self) -> list[int]:
        """Find the rows that begin another run, if the times of samples of the rows fall."""
        try:
            first, last = next(self._database.execute('SELECT min(id), max(id) FROM messages'))
            step = max(1, (last - first) // _SAMPLED)
            # A short first run lies between two even samples; those before the second one show it.
            early = {first + int(step * 0.7**k) for k in range(64)}
            sampled = [
                time
                for row in sorted(early.union(range(first, last, step)))
                for (time,) in self._database.execute(_TIME_OF_ROW, [row])
            ]
            if all(map(le, sampled, sampled[1:])):
                return []
            rows = self._database.execute('SELECT topic_id, timestamp FROM messages ORDER BY id')
            starts = starts_of_runs(rows, after=self.after)
            at = 'SELECT id FROM messages ORDER BY id LIMIT 1 OFFSET ?'
            return [row for k in starts for (row,) in self._database.execute(at, [k])]
        except Exception:  # noqa: BLE001, reading the messages raises it again
            return []

    def _messages(
        self, names: dict[int, str], chosen: list[int], first: int | None = None, end: int = 0
    ) -> Iterator[list[Message]]:
        # Without a condition, which is evaluated for each message, reading takes less time.
        condition = f'WHERE topic_id IN ({",".join("?" * len(chosen))})' if chosen else ''
        if first is not None:
            condition += ' AND id >= ? AND id < ?'
            chosen = [*chosen, first, end]
        left, piece, size = self._size, list[Message](), 0
        try:
            for key, received, data in self._database.execute(
                'SELECT topic_id, timestamp, data FROM messages'  # noqa: S608, placeholders
                f' {condition} ORDER BY timestamp',
                chosen,
            ):
                if key not in names:
                    continue
                if type(data) is not bytes or type(received) is not int:
                    raise ValueError('a message without a time or data')
                size += len(data)
                if size > left:  # messages that share pages
                    raise ValueError('the messages are longer than the file')
                piece.append((names[key], received, data))
                if size >= _PIECE_SIZE or len(piece) == _PIECE:
                    yield piece
                    piece, size, left = [], 0, left - size
        except Exception:
            yield piece
            raise
        yield piece


def _check_size(path: Path) -> None:
    """Refuse a file that ends within a page, which sqlite would pad with zeros."""
    with path.open('rb') as source:
        (page_size,) = struct.unpack('>16xH', source.read(18))
    if path.stat().st_size % (page_size if page_size > 1 else 2**16):
        raise ValueError('cut off within a page')
