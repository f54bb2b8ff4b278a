# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads mcap files."""

import os
import struct
from bisect import bisect_left
from collections.abc import Collection, Iterator
from contextlib import suppress
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from zlib import crc32

import numpy as np

from gear_kinematics.bag.codecs import CODECS, ReadLimits
from gear_kinematics.bag.runs import Array, may_restart, starts_of_runs
from gear_kinematics.bag.storage import Message, Published, Storage, Topic, UnsortedError

MCAP_MAGIC = b'\x89MCAP0\r\n'
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _INDEX, _DATA_END = 2, 3, 4, 5, 6, 7, 15
_DATA = frozenset({_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK})
_NO_SCHEMA = ('', '', '')  # type, syntax, definition
_RECORD = struct.Struct('<BQ')  # opcode, length of the body
_MESSAGE_START = struct.Struct('<BQH4xQ')  # opcode, length, channel, time of reception
_PUBLISHED = struct.Struct('<Q')  # time of publication, which follows
_CHUNK_START = struct.Struct('<BQQQQ')  # opcode, length, times of the first and last message, size
_PADDING = bytes(_MESSAGE_START.size)  # appended to the last record, which may be shorter
_CUT_OFF = 'cut off within a record; mcap recover saves what is before it'
_LATEST = 2**63 - 1  # ns
_PIECE, _PIECE_SIZE = 4096, 2**22  # messages outside of chunks that are read at once; bytes
_INDEX_START = 6  # bytes before the times and places of messages
_MAX_OPEN, _PER_CHUNK = 2**28, 2**18  # bytes of open chunks, and those added for each
_RECEIVED = itemgetter(1)


class Mcap(Storage):
    """An mcap file: https://mcap.dev/spec.

    It is read from front to back, unless its chunks overlap in time. The index only gives the
    topics without reading everything, so a file without an index is read like any other.
    """

    def __init__(self, path: Path, limits: ReadLimits) -> None:
        super().__init__(limits)
        self._stream = path.open('rb')
        self._size = os.fstat(self._stream.fileno()).st_size
        self._offset = 0
        self._schemas: dict[int, tuple[str, str, str]] = {}
        self._channels: dict[int, Topic] = {}
        self._chunked = True  # whether all messages that were found are in chunks
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
        self._channels = self._channels or dict(self.found)
        if not self._channels:
            try:
                for _ in self._unsorted():
                    pass
            except Exception:
                if not self._channels:
                    raise
            self.found |= self._channels
        if self._channels and all(topic.encoding == 'ros1' for topic in self._channels.values()):
            raise ValueError('it holds messages of ROS 1; give the .bag that it was made from')
        return list(self._channels.values())

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages, sorted within chunks or pieces; UnsortedError if that is not enough."""
        self._read_summary()
        chunks, may_restart = self._overlapping_chunks()
        if chunks:
            self.topics()  # a channel may be described in a chunk that is read later
        self._wanted = topics
        for channel, topic in self._channels.items():
            self._want(channel, topic)
        starts: list[int] | None = [] if chunks else None
        if may_restart:
            starts = starts_of_runs(self._times(), after=self.after)
        last = 0
        for piece in self._nearly_sorted(starts) if starts or not chunks else self._merged(chunks):
            if piece and piece[0][1] < last:
                raise UnsortedError
            last = piece[-1][1] if piece else 0  # an empty one ends a run
            if piece:
                yield piece

    def _times(self) -> Iterator[tuple[str, int]]:
        """Yield topic and time of each wanted message, in the order of the file, up to damage."""
        with suppress(Exception):  # reading the messages raises it again
            for piece in self._unsorted():
                for topic, received, _ in piece:
                    yield topic, received

    def _parts(self, starts: list[int] | None) -> Iterator[list[Message]]:
        """Yield sorted pieces of the file, and an empty one before each run but the first."""
        read, before = 0, list[Message]()
        for piece in filter(None, self._unsorted()):
            ordered = sorted(piece, key=_RECEIVED)
            begin = [start - read for start in starts or () if 0 <= start - read < len(piece)]
            if starts is None and (ordered != piece or (before and piece[0][1] < before[-1][1])):
                # Messages outside of chunks are written one by one, in the order of reception.
                rows = [message[:2] for message in (*before, *piece)]
                found = starts_of_runs(rows, mixed=self._chunked, after=self.after)
                begin = [start - len(before) for start in found if start >= len(before)]
            for first, end in pairwise([0, *begin, len(piece)]):
                if first in begin:
                    yield []
                if first < end:
                    yield sorted(piece[first:end], key=_RECEIVED) if begin else ordered
            read += len(piece)
            before = [] if self._chunked else piece

    def _nearly_sorted(self, starts: list[int] | None) -> Iterator[list[Message]]:
        """Yield the messages from front to back; a piece is held back to sort them.

        Messages that begin another run of the recording are given, or are sought in each piece.
        An empty piece comes before each run but the first.
        """
        pending: list[Message] = []
        try:
            for piece in self._parts(starts):
                if pending and piece and piece[0][1] < pending[-1][1]:
                    merged = sorted(pending + piece, key=_RECEIVED)
                    pending, piece = merged[: len(pending)], merged[len(pending) :]  # noqa: PLW2901
                yield pending
                pending = piece
        except Exception:
            yield pending
            raise
        yield pending

    def _overlapping_chunks(self) -> tuple[list[tuple[int, int, int, int]], bool]:
        """Return first time, position, length and size of all chunks, if any overlap.

        Without overlaps in time, or with messages outside of chunks, the list is empty. Also
        return whether another run may begin in them.
        """
        chunks, latest, overlap = list[tuple[int, int, int, int]](), 0, False
        indexes: list[tuple[int, int]] = []
        offset = self._stream.seek(len(MCAP_MAGIC))
        while len(header := self._stream.read(_CHUNK_START.size)) == _CHUNK_START.size:
            opcode, length, start, end, size = _CHUNK_START.unpack(header)
            after = offset + _RECORD.size + length
            if opcode in {0, _FOOTER, _DATA_END} or after > self._size:
                break
            if opcode == _MESSAGE:
                self._chunked = False
                return [], False
            if opcode == _CHUNK:
                chunks.append((start, offset, length, size))
                overlap |= bool(end) and start < latest  # the times of an empty chunk are 0
                latest = max(latest, end)
            if opcode == _INDEX and _INDEX_START + 16 <= length <= self.limits.max_record:
                indexes.append((offset + _RECORD.size, length))
            offset = self._stream.seek(after)
        return (chunks, may_restart(self._times_of_index(indexes))) if overlap else ([], False)

    def _times_of_index(self, places: list[tuple[int, int]]) -> Iterator[tuple[bytes, Array]]:
        """Read the channels and times of indexes of messages, by their places and lengths."""
        for place, length in places:
            self._stream.seek(place)
            index = self._stream.read(length)
            count = (length - _INDEX_START) // 16  # further bytes are of a later version
            yield index[:2], np.frombuffer(index, '<i8', 2 * count, _INDEX_START)[::2]

    def _merged(self, chunks: list[tuple[int, int, int, int]]) -> Iterator[list[Message]]:
        """Merge chunks by time; messages of the same time stay in the order of the file."""
        opened, sizes = dict[int, list[Message]](), dict[int, int]()
        chunks.sort()
        whole = max(offset + _RECORD.size + length for _, offset, length, _ in chunks)
        starts = [start for start, *_ in chunks]
        for (_, offset, length, size), until in zip(
            chunks, [*starts[1:], _LATEST + 1], strict=True
        ):
            sizes[offset] = size + _PER_CHUNK
            if sum(map(sizes.__getitem__, opened), sizes[offset]) > _MAX_OPEN:
                raise UnsortedError
            if length > self.limits.max_record:
                raise ValueError(f'a record of {length} bytes is too large')
            self._offset = offset
            self._stream.seek(offset + _RECORD.size)
            opened[offset] = piece = list[Message]()
            self._walk(self._chunk_records(self._stream.read(length)), piece)
            piece.sort(key=_RECEIVED)
            ready: list[Message] = []
            for position in sorted(opened):
                messages = opened[position]
                before = bisect_left(messages, until, key=_RECEIVED)
                ready += messages[:before]
                del messages[:before]
            opened = {position: messages for position, messages in opened.items() if messages}
            if ready:
                yield sorted(ready, key=_RECEIVED)
        yield from self._unsorted(whole)  # finds how the file ends

    def _unsorted(self, start: int = len(MCAP_MAGIC)) -> Iterator[list[Message]]:
        """Yield the messages as they are in the file; on damage, those before it, then raise."""
        stream, piece, size = self._stream, list[Message](), 0
        self._offset = stream.seek(start)
        try:
            while header := stream.read(_RECORD.size):
                if len(header) < _RECORD.size:
                    raise ValueError(_CUT_OFF)
                opcode, length = _RECORD.unpack(header)
                if opcode in {_FOOTER, _DATA_END}:
                    break
                if not opcode:
                    raise ValueError('there is no record')
                if self._offset + _RECORD.size + length > self._size:
                    raise ValueError(_CUT_OFF)
                if opcode in _DATA:
                    if length > self.limits.max_record:
                        raise ValueError(f'a record of {length} bytes is too large')
                    body = stream.read(length)
                    records = self._chunk_records(body) if opcode == _CHUNK else header + body
                    self._walk(records, piece)
                    size += length
                if opcode == _CHUNK or len(piece) >= _PIECE or size >= _PIECE_SIZE:
                    yield piece
                    piece, size = [], 0
                self._offset += _RECORD.size + length
                stream.seek(self._offset)
            else:
                self.unclosed = True  # there is no record of the end of the data
        except Exception:
            yield piece
            raise
        yield piece

    def _walk(self, records: bytes, piece: list[Message]) -> None:
        """Append the wanted messages among records, up to the first damage."""
        wanted, unpack = self._wanted_channels.get, _MESSAGE_START.unpack_from
        dated = self.publish_times
        end, size = 0, len(records)
        whole = size - _MESSAGE_START.size
        while end < size:
            opcode, length, channel, received = (
                unpack(records, end) if end <= whole else unpack(records[end:] + _PADDING)
            )
            start = end + _RECORD.size
            end = start + length
            if end > size:
                raise ValueError(_CUT_OFF)
            if opcode == _MESSAGE:
                if topic := wanted(channel):
                    if received > _LATEST:
                        raise ValueError('a time of reception is out of range')
                    data = records[start + 22 : end]
                    if dated:
                        (published,) = _PUBLISHED.unpack_from(records, start + 14)
                        data = data if published == received else Published.at(published, data)
                    piece.append((topic, received, data))
            elif opcode in {_SCHEMA, _CHANNEL}:
                self._learn(opcode, records[start:end])
            elif not opcode:
                raise ValueError('there is no record')

    def _learn(self, opcode: int, body: bytes) -> None:
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
            if encoding == b'cdr' and message_type.count('/') == 1:  # as other writers shorten it
                message_type = message_type.replace('/', '/msg/')
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
            self.check_encoding(topic)
            self._wanted_channels[channel] = topic.name

    def _read_summary(self) -> None:
        """Read the index, if there is one and it is valid."""
        try:
            end = self._stream.seek(-37, os.SEEK_END)
            opcode, _, start, _, _, magic = struct.unpack('<BQQQI8s', self._stream.read())
            found = start and (opcode, magic) == (_FOOTER, MCAP_MAGIC)  # 0: there is no summary
            if found and 0 < end - start < self.limits.max_record:
                self._stream.seek(start)
                self._walk(self._stream.read(end - start), [])
        except Exception:  # noqa: BLE001, arbitrary bytes
            self._schemas, self._channels = {}, {}

    def _chunk_records(self, body: bytes) -> bytes:
        size, crc, name_length = struct.unpack_from('<16xQII', body)
        name = body[32 : 32 + name_length].decode()
        (length,) = struct.unpack_from('<Q', body, 32 + name_length)
        data = body[40 + name_length : 40 + name_length + length]
        records = data
        if name:
            if name not in CODECS:
                raise ValueError(f'unsupported compression {name!r}')
            if size > self.limits.expanded_chunk(len(data)):
                raise ValueError(f'a chunk of {size} bytes is too large')
            records, _ = CODECS[name].decompress(data, size + 1)
            self.limits.count(len(records))
        if len(records) != size:
            raise ValueError('a chunk does not have the size that it states')
        if crc and crc32(records) != crc:
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
