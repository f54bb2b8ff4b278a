# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads mcap files."""

import os
import struct
from collections.abc import Collection, Iterator
from contextlib import nullcontext, suppress
from operator import itemgetter
from pathlib import Path
from zlib import crc32

from gear_kinematics.bag.codecs import CODECS
from gear_kinematics.bag.limits import Limits
from gear_kinematics.bag.storage import Message, Storage, check_encoding
from gear_kinematics.bag.topics import Topic

MCAP_MAGIC = b'\x89MCAP0\r\n'
_FOOTER, _SCHEMA, _CHANNEL, MESSAGE, _CHUNK, _STATISTICS, _DATA_END = 2, 3, 4, 5, 6, 11, 15
_DATA = frozenset({_SCHEMA, _CHANNEL, MESSAGE, _CHUNK})
_DESCRIPTIONS = frozenset({_SCHEMA, _CHANNEL})
_NO_SCHEMA = ('', '', '')  # type, syntax, definition
MESSAGE_START = struct.Struct('<BQHIQQ')  # opcode, length of the body, channel, number, two times
RECORD = struct.Struct('<BQ')  # the first two of them, with which each record starts
_WANTED_START = struct.Struct('<BQH4xQ')  # of a message, without what is not needed
_PADDING = bytes(_WANTED_START.size)  # behind the last record, which may be shorter
_CUT_OFF = 'cut off within a record'
_LATEST = 2**63 - 1  # ns
_AT_ONCE = 65_536  # records of a chunk; recorders write fewer
_PIECE, _PIECE_SIZE = 4096, 2**22  # messages outside of chunks that are read at once, bytes
_RECEIVED = itemgetter(1)


class Mcap(Storage):
    """An mcap file, read from front to back: https://mcap.dev/spec.

    The index only gives topics and counts without reading everything, so a file without an index
    is read like any other.
    """

    def __init__(self, path: Path, limits: Limits) -> None:
        super().__init__(limits)
        self._stream = path.open('rb')
        self._size = os.fstat(self._stream.fileno()).st_size
        self._offset = 0
        self._schemas: dict[int, tuple[str, str, str]] = {}
        self._channels: dict[int, Topic] = {}
        self._total: int | None = None
        self._counts: dict[int, int] = {}
        self._wanted: Collection[str] = ()
        self._wanted_channels: dict[int, str] = {}

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def position(self) -> str:
        """Position of reading, for error messages."""
        return f'at byte {self._offset}: '

    def topics(self) -> list[Topic]:
        """Return the topics of the index, or else of the readable part of the file."""
        self._read_summary()
        if not self._channels:
            try:
                for _ in self._unsorted():
                    pass
            except Exception:
                if not self._channels:
                    raise
        return list(self._channels.values())

    def count(self) -> int | None:
        """Return the number in the index, if there is one; call `topics` first."""
        return self._total

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages, sorted if they are out of order by at most a chunk."""
        # Recorders with several threads or several open chunks write messages out of order by up
        # to a chunk: a chunk is held back to sort them.
        number = 0
        held: list[Message] = []
        self._read_summary()
        self._wanted = topics
        for channel, topic in self._channels.items():
            self._want(channel, topic)
        try:
            for piece in filter(None, self._unsorted()):
                piece.sort(key=_RECEIVED)
                if held:
                    if piece[0][1] < held[-1][1]:
                        merged = sorted(held + piece, key=_RECEIVED)
                        held, piece = merged[: len(held)], merged[len(held) :]  # noqa: PLW2901
                    yield held
                held = piece
                number += len(piece)
        except Exception:
            if held:
                yield held
            raise
        if held:
            yield held
        expected = sum(self._counts.get(channel, 0) for channel in self._wanted_channels)
        if number < expected:
            raise ValueError(f'the index lists {expected} messages, there are {number}')

    def _unsorted(self) -> Iterator[list[Message]]:
        """Yield the messages as they are in the file; on damage, those before it, then raise."""
        stream, piece, size = self._stream, list[Message](), 0
        self._offset = stream.seek(len(MCAP_MAGIC))
        try:
            while header := stream.read(RECORD.size):  # an unfinished file has no footer
                if len(header) < RECORD.size:
                    raise ValueError(_CUT_OFF)
                opcode, length = RECORD.unpack(header)
                left = self._size - self._offset - RECORD.size
                if opcode in {_FOOTER, _DATA_END}:
                    break
                if not opcode:
                    raise ValueError('there is no record')
                if opcode in _DATA:
                    if min(length, left) > self.limits.max_record:
                        raise ValueError(f'a record of {length} bytes is too large')
                    body = stream.read(min(length, left))
                    if opcode != _CHUNK:
                        self._walk(header + body, 0, piece)
                        size += len(body)
                    else:
                        with suppress(Exception) if length > left else nullcontext():
                            yield from self._fill(piece, body, whole=length <= left)
                if length > left:
                    raise ValueError(_CUT_OFF)
                if opcode == _CHUNK or len(piece) >= _PIECE or size >= _PIECE_SIZE:
                    yield piece
                    piece, size = [], 0
                self._offset += RECORD.size + length
                stream.seek(self._offset)
        except Exception:
            yield piece
            raise
        yield piece

    def _fill(self, piece: list[Message], chunk: bytes, *, whole: bool) -> Iterator[list[Message]]:
        """Fill a list with the messages of a chunk; yield a copy and clear it whenever full."""
        records, end = self._chunk_records(chunk, whole=whole), 0
        while (end := self._walk(records, end, piece)) < len(records):
            yield piece[:]
            piece.clear()

    def _walk(
        self,
        records: bytes,
        end: int,
        piece: list[Message],
        learned: Collection[int] = _DESCRIPTIONS,
    ) -> int:
        """Append the wanted messages among the next records, up to the first damage.

        Returns:
            End of the last record.
        """
        wanted, unpack = self._wanted_channels.get, _WANTED_START.unpack_from
        size, number, padded = len(records), 0, records + _PADDING
        while end < size and number < _AT_ONCE:
            number += 1
            opcode, length, channel, received = unpack(padded, end)
            start = end + RECORD.size
            end = start + length
            if end > size:
                raise ValueError(_CUT_OFF)
            if opcode == MESSAGE:
                if topic := wanted(channel):
                    if received > _LATEST:
                        raise ValueError('a time of reception is out of range')
                    piece.append((topic, received, records[start + 22 : end]))
            elif opcode in learned:
                self._learn(opcode, records[start:end])
            elif not opcode:
                raise ValueError('there is no record')
        self.limits.count(records=number)
        return end

    def _learn(self, opcode: int, body: bytes) -> None:
        if opcode == _STATISTICS:
            self._total, size = struct.unpack_from('<Q34xI', body)
            self._counts = dict(struct.iter_unpack('<HQ', body[46 : 46 + size]))
            return
        number, schema = struct.unpack_from('<HH', body)
        if number in (self._schemas if opcode == _SCHEMA else self._channels):
            return
        self.limits.describe(body)
        if opcode == _SCHEMA:
            # Definitions that are not text belong to unsupported encodings.
            texts = [text.decode(errors='replace') for text in _strings(body[2:], 3)]
            self._schemas[number] = texts[0], texts[1], texts[2]
        else:
            name, encoding, metadata = _strings(body[4:], 3)
            texts = [text.decode() for text in _strings(metadata)]
            known = dict(zip(texts[::2], texts[1::2], strict=True))
            message_type, syntax, definition = self._schemas.get(schema, _NO_SCHEMA)
            topic = Topic(
                name.decode(),
                message_type,
                encoding.decode(),
                syntax,
                definition,
                known.get('topic_type_hash', ''),
                known.get('offered_qos_profiles', ''),
            )
            self._channels[number] = topic
            self._want(number, topic)

    def _want(self, channel: int, topic: Topic) -> None:
        if topic.name in self._wanted:
            check_encoding(topic)
            self._wanted_channels[channel] = topic.name

    def _read_summary(self) -> None:
        """Read the index, if there is one and it is valid."""
        try:
            end = self._stream.seek(-37, os.SEEK_END)
            opcode, _, start, _, _, magic = struct.unpack('<BQQQI8s', self._stream.read())
            found = start and (opcode, magic) == (_FOOTER, MCAP_MAGIC)  # 0: there is no summary
            if found and 0 < end - start < self.limits.max_record:
                self._stream.seek(start)
                records, place = self._stream.read(end - start), 0
                while place < len(records):
                    place = self._walk(records, place, [], {*_DESCRIPTIONS, _STATISTICS})
        except Exception:  # noqa: BLE001, arbitrary bytes
            self._schemas, self._channels, self._counts, self._total = {}, {}, {}, None

    def _chunk_records(self, body: bytes, *, whole: bool) -> bytes:
        """Decompress the records of a chunk; those that there are, if it is not `whole`."""
        size, crc, name_length = struct.unpack_from('<16xQII', body)
        name = body[32 : 32 + name_length].decode()
        (length,) = struct.unpack_from('<Q', body, 32 + name_length)
        data = body[40 + name_length :][:length]
        records = data
        if name:
            if name not in CODECS:
                raise ValueError(f'unsupported compression {name!r}')
            if size > self.limits.expanded_chunk(len(data)):
                raise ValueError(f'a chunk of {size} bytes is too large')
            records, _ = CODECS[name].decompress(data, size + 1)
            self.limits.count(expanded=len(records))
        if whole and len(records) != size:
            raise ValueError('a chunk does not have the size that it states')
        if whole and crc and crc32(records) != crc:
            raise ValueError('a chunk does not match its checksum')
        return records


def _strings(data: bytes, count: int | None = None) -> list[bytes]:
    """Split consecutive strings, each preceded by its length."""
    strings: list[bytes] = []
    end = 0
    while len(strings) < count if count else end < len(data):
        (length,) = struct.unpack_from('<I', data, end)
        start, end = end + 4, end + 4 + length
        if end > len(data):
            raise ValueError('a string is longer than its record')
        strings.append(data[start:end])
    return strings
