"""What the files of a bag have in common: their interface, compression, and bounds of both.

What comes out of a bag is what its size on disk explains, and little more. Chunks of a recording
expand to up to 20 times their size, and a message takes a byte of a compressed file or more. What
expands further is blank images and maps: few, or small.
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
"""Topic, reception in ns, CDR. A named tuple would take 15 times as long to make."""
Decompressor = Callable[[bytes, int], tuple[bytes, bool]]
"""Decompresses at most so many bytes of a frame, and tells whether that was all of it."""

FileOpener = Callable[[IO[bytes]], Any]

MAX_RECORD = 2**30
"""Bytes of a record on disk."""
MAX_DEFINITIONS = 2**19
"""Bytes of the types of ROS 1: rosbags takes 25 µs for each."""
CHUNK_EXPANSION, FILE_EXPANSION = 20, 100
"""How many times its size a chunk or message, and a file, may expand to; see `expanded_size`."""

_SPARE_SIZE = 2**25  # bytes
_SPARE_TOTAL = 2**30  # bytes
_SPARE_RECORDS = 100_000
_MAX_DESCRIBED = 2**25  # bytes
_DESCRIPTION = 256  # bytes that one counts for beside its texts


def expanded_size(size: int, factor: int) -> int:
    """The size in bytes that something compressed may expand to."""
    return _SPARE_SIZE + factor * size


class Budget:
    """What may come out of the files of a bag while they are read once."""

    def __init__(self, size: int) -> None:
        """Begin with files of so many bytes on disk."""
        self._records = _SPARE_RECORDS + size
        self._expanded = _SPARE_TOTAL + FILE_EXPANSION * size

    def count(self, records: int) -> None:
        """Take records.

        Raises:
            ValueError: if there are more than there may be.
        """
        self._records -= records
        if self._records < 0:
            raise ValueError('there are more records than a bag of this size can hold')

    def expand(self, size: int) -> None:
        """Take bytes that were compressed.

        Raises:
            ValueError: if there are more than there may be.
        """
        self._expanded -= size
        if self._expanded < 0:
            raise ValueError('more is compressed in it than a bag of this size can hold')


class Descriptions:
    """The descriptions of topics and types, which are all kept."""

    def __init__(self) -> None:
        """Begin with none."""
        self._size = 0

    def add(self, size: int) -> None:
        """Take one whose texts have so many bytes.

        Raises:
            ValueError: if that makes more than any recorder writes.
        """
        self._size += _DESCRIPTION + size
        if self._size > _MAX_DESCRIBED:
            raise ValueError(f'it describes its topics by more than {_MAX_DESCRIBED} bytes')


def _unzstd(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = zstd.ZstdDecompressor()
    return decompressor.decompress(data, limit), decompressor.eof


def _unlz4(data: bytes, limit: int) -> tuple[bytes, bool]:
    # The format cannot do better than 255 to 1, and lz4 allocates the limit at once.
    decompressor = lz4.frame.LZ4FrameDecompressor()
    return decompressor.decompress(data, min(limit, 256 * len(data))), decompressor.eof


def expanded(decompress: Decompressor, data: bytes, budget: Budget) -> tuple[bytes, bool]:
    """Decompress a chunk or message as far as it may expand, and tell whether that was all.

    Raises:
        ValueError: if the bag holds too much.
    """
    content, whole = decompress(data, expanded_size(len(data), CHUNK_EXPANSION))
    budget.expand(len(content))
    return content, whole


def decompress_file(source: IO[bytes], target: Path, opener: FileOpener) -> str:
    """Decompress as much as there is, and tell what stopped it early, if anything."""
    limit = left = expanded_size(os.fstat(source.fileno()).st_size, FILE_EXPANSION)
    with target.open('wb') as output, opener(source) as expanded:
        try:
            while piece := expanded.read1(2**18):  # what there is, unlike read()
                left -= output.write(piece)
                if left < 0:
                    raise ValueError(f'it expands to more than {limit} bytes')
        except Exception as error:  # noqa: BLE001, of two libraries
            return cause(error)
    return ''


_ZSTD_MAGIC, _LZ4_MAGIC = b'\x28\xb5\x2f\xfd', b'\x04\x22\x4d\x18'

DECOMPRESSORS: Mapping[str, Decompressor] = {'zstd': _unzstd, 'lz4': _unlz4}
"""By their names in bags."""

MESSAGE_DECOMPRESSORS: Mapping[bytes, Decompressor] = {_ZSTD_MAGIC: _unzstd, _LZ4_MAGIC: _unlz4}
"""By the first bytes of a message, which are never those of CDR: it begins with a zero."""

FILE_OPENERS: Mapping[bytes, FileOpener] = {
    _ZSTD_MAGIC: zstd.ZstdFile,
    _LZ4_MAGIC: lz4.frame.LZ4FrameFile,
}
"""By the first bytes of a file."""


class Storage:
    """A file of a bag."""

    def __init__(self, budget: Budget) -> None:
        """Begin.

        Args:
            budget: what may come out of the files of the bag.
        """
        self.budget = budget
        self.descriptions = Descriptions()
        self.read = 0
        """Messages that have been taken out; up to date whenever an error is raised."""

    def topics(self) -> list[Topic]:
        """Give what the file says about its topics."""
        raise NotImplementedError

    def count(self) -> int | None:
        """Count the messages; None where only reading all of them would tell."""
        raise NotImplementedError

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read the messages on topics in the order of reception, as far as there are any."""
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def position(self) -> str:
        """Tell where reading is, for errors."""
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
