"""The interface of a file of a bag, and decompression within limits set by its size on disk.

Chunks of a recording expand to up to 20 times their size, and a message takes at least a byte of a
compressed file. Only blank images and maps expand further: they are few, or small.
"""

import os
import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import IO, Any

import lz4.frame  # type: ignore[import-untyped]

from gear_kinematics.bag.errors import cause
from gear_kinematics.bag.topics import Topic

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

Message = tuple[str, int, bytes]
"""Topic, time of reception in ns, CDR. A named tuple would take 15 times as long to make."""
Decompressor = Callable[[bytes, int], tuple[bytes, bool]]
"""From a frame and a limit to at most that many bytes, and whether they are all of it."""
FileOpener = Callable[[IO[bytes]], Any]

MAX_RECORD = 2**30
"""Largest record on disk, bytes."""
MAX_DEFINITIONS = 2**19
"""Largest type definitions of ROS 1, bytes: rosbags takes 25 µs for each."""
CHUNK_EXPANSION, FILE_EXPANSION = 20, 100
"""Greatest expansion of a chunk or message, and of a file; see `expanded_size`."""

_SPARE_SIZE = 2**25  # bytes
_SPARE_TOTAL = 2**30  # bytes
_SPARE_RECORDS = 100_000
_MAX_DESCRIBED = 2**25  # bytes
_DESCRIPTION = 256  # bytes that a description counts for in addition to its texts


def expanded_size(size: int, factor: int) -> int:
    """The size, bytes, to which compressed data may expand."""
    return _SPARE_SIZE + factor * size


class Budget:
    """The records and bytes that may still be read from the files of a bag."""

    def __init__(self, size: int) -> None:
        """Start with the size of the files on disk, bytes."""
        self._records = _SPARE_RECORDS + size
        self._expanded = _SPARE_TOTAL + FILE_EXPANSION * size

    def count(self, records: int) -> None:
        """Count records.

        Raises:
            ValueError: if the budget is exceeded.
        """
        self._records -= records
        if self._records < 0:
            raise ValueError('there are more records than a bag of this size can hold')

    def expand(self, size: int) -> None:
        """Count decompressed bytes.

        Raises:
            ValueError: if the budget is exceeded.
        """
        self._expanded -= size
        if self._expanded < 0:
            raise ValueError('its compressed data expand to more than a bag of this size can hold')


class Descriptions:
    """Bounds the descriptions of topics and types, which are all kept in memory."""

    def __init__(self) -> None:
        self._size = 0

    def add(self, size: int) -> None:
        """Count a description whose texts have `size` bytes.

        Raises:
            ValueError: if they are larger than any recorder writes.
        """
        self._size += _DESCRIPTION + size
        if self._size > _MAX_DESCRIBED:
            raise ValueError(f'the descriptions of its topics exceed {_MAX_DESCRIBED} bytes')


def _unzstd(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = zstd.ZstdDecompressor()
    return decompressor.decompress(data, limit), decompressor.eof


def _unlz4(data: bytes, limit: int) -> tuple[bytes, bool]:
    # The format expands to 255 times the size at most, and lz4 allocates the limit at once.
    decompressor = lz4.frame.LZ4FrameDecompressor()
    return decompressor.decompress(data, min(limit, 256 * len(data))), decompressor.eof


def expanded(decompress: Decompressor, data: bytes, budget: Budget) -> tuple[bytes, bool]:
    """Decompress a chunk or message up to its limit; also returns whether that was all.

    Raises:
        ValueError: if the bag expands too far.
    """
    content, whole = decompress(data, expanded_size(len(data), CHUNK_EXPANSION))
    budget.expand(len(content))
    return content, whole


def decompress_file(source: IO[bytes], target: Path, opener: FileOpener) -> str:
    """Decompress as much as possible; returns the cause of an early end, or an empty text."""
    limit = left = expanded_size(os.fstat(source.fileno()).st_size, FILE_EXPANSION)
    with target.open('wb') as output, opener(source) as expanded:
        try:
            while piece := expanded.read1(2**18):  # returns partial data, unlike read()
                left -= output.write(piece)
                if left < 0:
                    raise ValueError(f'it expands to more than {limit} bytes')
        except Exception as error:  # noqa: BLE001, raised by two libraries
            return cause(error)
    return ''


_ZSTD_MAGIC, _LZ4_MAGIC = b'\x28\xb5\x2f\xfd', b'\x04\x22\x4d\x18'

DECOMPRESSORS: Mapping[str, Decompressor] = {'zstd': _unzstd, 'lz4': _unlz4}
"""Decompressors by their names in bags."""
MESSAGE_DECOMPRESSORS: Mapping[bytes, Decompressor] = {_ZSTD_MAGIC: _unzstd, _LZ4_MAGIC: _unlz4}
"""Decompressors by the first bytes of a message; CDR differs, as it begins with a zero."""
FILE_OPENERS: Mapping[bytes, FileOpener] = {
    _ZSTD_MAGIC: zstd.ZstdFile,
    _LZ4_MAGIC: lz4.frame.LZ4FrameFile,
}
"""Openers by the first bytes of a file."""


class Storage:
    """A file of a bag."""

    def __init__(self, budget: Budget) -> None:
        """Start without messages read.

        Args:
            budget: limits on the files of the bag.
        """
        self.budget = budget
        self.descriptions = Descriptions()
        self.read = 0
        """Number of messages read; up to date whenever an error is raised."""

    def topics(self) -> list[Topic]:
        """Return the topics of the file."""
        raise NotImplementedError

    def count(self) -> int | None:
        """Return the number of messages; None if unknown without reading all of them."""
        raise NotImplementedError

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read the messages on the given topics, in the order of reception."""
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def position(self) -> str:
        """Position of reading, for error messages."""
        return f'after message {self.read}: ' if self.read else ''

    def decompressed(
        self, messages: Iterator[Message], decompress: Decompressor
    ) -> Iterator[Message]:
        """Decompress each message."""
        number = 0
        try:
            for topic, received, data in messages:
                message, whole = expanded(decompress, data, self.budget)
                if not whole:
                    raise ValueError('a compressed message is cut off or too large')
                yield topic, received, message
                number += 1
        finally:
            self.read = number


def check_encoding(topic: Topic) -> None:
    """Make sure that the messages on a topic are CDR.

    Raises:
        ValueError: if they are not.
    """
    if topic.encoding != 'cdr':
        raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')
