"""sqlite3 files."""

import os
import shutil
import sqlite3
import struct
import tempfile
from collections.abc import Collection, Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import Any

from gear_kinematics.bag.storage import RawMessage, Storage
from gear_kinematics.bag.topics import Topic, check_encoding


class Sqlite(Storage):
    """An sqlite3 file."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        with ExitStack() as stack:
            path = _whole_pages(path, stack)
            # Without a journal nothing changes: no need for locks, which read-only media lack.
            journal = path.with_name(f'{path.name}-wal').exists()
            options = '?mode=ro' if journal else '?mode=ro&immutable=1'
            uri = path.absolute().as_uri() + options
            self._database = sqlite3.connect(uri, uri=True, check_same_thread=False)
            stack.enter_context(closing(self._database))
            self._resources = stack.pop_all()

    def close(self) -> None:
        """Close the file, and remove the copy if there is one."""
        self._resources.close()

    def _execute(self, query: str, parameters: Collection[object] = ()) -> sqlite3.Cursor:
        # So asked, sqlite reads a file that is shorter than it should be as far as it goes.
        self._database.execute('PRAGMA writable_schema=ON')
        return self._database.execute(query, tuple(parameters))

    def _rows(self, table: str) -> list[dict[str, Any]]:
        cursor = self._execute(f'SELECT * FROM {table}')  # noqa: S608, our own names
        return [dict(zip((c[0] for c in cursor.description), row, strict=True)) for row in cursor]

    def topics(self) -> list[Topic]:
        """Give the rows of the table of topics."""
        return list(self._topics().values())

    def _topics(self) -> dict[int, Topic]:
        definitions = {}
        with suppress(sqlite3.Error):  # there were none before version 4 of the schema
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
                raise ValueError('a topic is not described by texts')
            topics[known['id']] = topic
        return topics

    def count(self) -> int | None:
        """Count the rows; None where the file is too damaged for it."""
        with suppress(sqlite3.Error):
            return int(self._execute('SELECT count(*) FROM messages').fetchone()[0])
        return None

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """Read messages in the order of reception."""
        wanted = {key: topic for key, topic in self._topics().items() if topic.name in topics}
        for topic in wanted.values():
            check_encoding(topic)
        names = {key: topic.name for key, topic in wanted.items()}
        places = ','.join('?' * len(names))
        number = 0
        try:
            for key, received, data in self._execute(
                'SELECT topic_id, timestamp, data FROM messages'  # noqa: S608, question marks
                f' WHERE topic_id IN ({places}) ORDER BY timestamp',
                names,
            ):
                if type(data) is not bytes or type(received) is not int:
                    raise ValueError('a message without a time or data')
                yield names[key], received, data
                number += 1
        finally:
            self.read = number


def _whole_pages(path: Path, stack: ExitStack) -> Path:
    """Give the path of a copy without the last page if that is cut off.

    sqlite would fill it up with zeros, and messages with them.
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
