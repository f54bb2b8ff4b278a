# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads sqlite3 files."""

import os
import shutil
import sqlite3
import struct
import tempfile
from collections.abc import Collection, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from gear_kinematics.bag.limits import Limits
from gear_kinematics.bag.storage import Message, Storage, check_encoding, in_batches
from gear_kinematics.bag.topics import Topic

_STEPS = 1000
_REASONS = {
    sqlite3.SQLITE_AUTH: 'a view in place of a table',
    sqlite3.SQLITE_INTERRUPT: 'there are more rows than a file of this size can hold',
}


class Sqlite(Storage):
    """An sqlite3 file."""

    def __init__(self, path: Path, limits: Limits) -> None:
        super().__init__(limits)
        with ExitStack() as stack:
            path = _whole_pages(path, stack)
            # Without a journal nothing changes, so no locks are needed; read-only media have none.
            journal = path.with_name(f'{path.name}-wal')
            options = '?mode=ro' if journal.exists() else '?mode=ro&immutable=1'
            uri = path.absolute().as_uri() + options
            self._database = sqlite3.connect(uri, uri=True, check_same_thread=False)
            stack.enter_context(closing(self._database))
            # With this, sqlite reads as much as possible of a truncated file.
            self._database.execute('PRAGMA writable_schema=ON')
            self._database.set_authorizer(_only_tables)
            # Pages that occur repeatedly in a tree make an endless number of rows.
            self._size = sum(file.stat().st_size for file in (path, journal) if file.exists())
            self._steps = 100_000 + 10 * self._size
            self._database.set_progress_handler(self._spend, _STEPS)
            for table in ('topics', 'message_definitions', 'messages'):
                columns = self._database.execute(f'PRAGMA table_xinfo({table})')
                if any(hidden for *_, hidden in columns):
                    raise ValueError(f'{table} has computed columns')
            self._resources = stack.pop_all()

    def close(self) -> None:
        """Close the file, and remove the copy if there is one."""
        self._resources.close()

    def _rows(self, table: str) -> list[dict[str, Any]]:
        rows = []
        with _reasons():
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
            known = definitions.get(row['type'], {}) | row
            topic = Topic(
                known['name'],
                known['type'],
                known['serialization_format'],
                known.get('encoding', ''),
                known.get('encoded_message_definition', ''),
                known.get('type_description_hash', ''),
                known.get('offered_qos_profiles', ''),
            )
            if not all(isinstance(text, str) for text in topic):
                raise ValueError('the description of a topic is not text')
            topics[known['id']] = topic
        return topics

    def count(self) -> int | None:
        """Count the rows; None if the file is too damaged."""
        with suppress(sqlite3.Error):
            # Of a column: count(*) takes a single step, which cannot be stopped.
            return int(
                self._database.execute('SELECT count(timestamp) FROM messages').fetchone()[0]
            )
        return None

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages in the order of reception."""
        wanted = {key: topic for key, topic in self._topics().items() if topic.name in topics}
        for topic in wanted.values():
            check_encoding(topic)
        names = {key: topic.name for key, topic in wanted.items()}
        return in_batches(self._messages(names))

    def _messages(self, names: dict[int, str]) -> Iterator[Message]:
        places, left = ','.join('?' * len(names)), self._size
        with _reasons():
            for key, received, data in self._database.execute(
                'SELECT topic_id, timestamp, data FROM messages'  # noqa: S608, placeholders
                f' WHERE topic_id IN ({places}) ORDER BY timestamp',
                tuple(names),
            ):
                if type(data) is not bytes or type(received) is not int:
                    raise ValueError('a message without a time or data')
                left -= len(data)
                if left < 0:  # messages that share pages
                    raise ValueError('the messages are longer than the file')
                yield names[key], received, data


def _only_tables(_action: int, _1: object, _2: object, _database: object, view: object) -> int:
    """Refuse views, whose rows are computed and may be endless."""
    return sqlite3.SQLITE_DENY if view else sqlite3.SQLITE_OK


@contextmanager
def _reasons() -> Iterator[None]:
    """Name the cause where sqlite was stopped."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        reason = _REASONS.get(getattr(error, 'sqlite_errorcode', -1))
        if reason:
            raise ValueError(reason) from error
        raise


def _whole_pages(path: Path, stack: ExitStack) -> Path:
    """Return the path, or that of a copy without the last page if that is truncated.

    sqlite would pad the page, and thus messages, with zeros.
    """
    with path.open('rb') as source:
        (page_size,) = struct.unpack('>16xH', source.read(18))
        size = os.fstat(source.fileno()).st_size
        excess = size % (page_size if page_size > 1 else 2**16)
        if not excess:
            return path
        source.seek(0)
        copy = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
        with copy.open('wb') as target:
            shutil.copyfileobj(source, target)
            target.truncate(size - excess)
        return copy
