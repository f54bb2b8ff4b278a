"""The interface of a file of a bag, and decompression within limits."""

import os
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import IO, Any

import lz4.frame  # type: ignore[import-untyped]

from gear_kinematics.bag.errors import cause
from gear_kinematics.bag.limits import Limits
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


def _unzstd(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = zstd.ZstdDecompressor()
    return decompressor.decompress(data, limit), decompressor.eof


def _unlz4(data: bytes, limit: int) -> tuple[bytes, bool]:
    # The format expands to 255 times the size at most, and lz4 allocates the limit at once.
    decompressor = lz4.frame.LZ4FrameDecompressor()
    return decompressor.decompress(data, min(limit, 256 * len(data))), decompressor.eof


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


def decompressed(data: bytes, decompress: Decompressor, limits: Limits, what: str) -> bytes:
    """Decompress a chunk or message.

    Raises:
        ValueError: if it is cut off, or expands too far; `what` it is begins the text.
    """
    content, whole = decompress(data, limits.expanded_chunk(len(data)))
    limits.expand(len(content))
    if not whole:
        raise ValueError(f'{what} is cut off or too large')
    return content


def decompress_file(source: IO[bytes], target: Path, opener: FileOpener) -> str:
    """Decompress as much as possible; returns the cause of an early end, or an empty text."""
    limit = left = Limits.expanded_file(os.fstat(source.fileno()).st_size)
    with target.open('wb') as output, opener(source) as expanded:
        try:
            while piece := expanded.read1(2**18):  # returns partial data, unlike read()
                left -= output.write(piece)
                if left < 0:
                    raise ValueError(f'it expands to more than {limit} bytes')
        except Exception as error:  # noqa: BLE001, raised by two libraries
            return cause(error)
    return ''


class Storage:
    """A file of a bag."""

    def __init__(self, limits: Limits) -> None:
        """Start with the limits on the files of the bag."""
        self.limits = limits
        self.read = 0
        """Number of messages that the caller has taken from `pieces`."""

    def topics(self) -> list[Topic]:
        """Return the topics of the file."""
        raise NotImplementedError

    def count(self) -> int | None:
        """Return the number of messages; None if unknown without reading all of them."""
        raise NotImplementedError

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read the messages on the given topics, some at a time, in the order of reception.

        Those before an error are yielded before it is raised.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def position(self) -> str:
        """Position of reading, for error messages."""
        return f'after message {self.read}: ' if self.read else ''


def in_batches(
    messages: Iterable[Message], count: int = 256, size: int = 2**20
) -> Iterator[list[Message]]:
    """Group messages into batches of up to `count` messages, and of about `size` bytes at most.

    Messages before an exception are yielded before it is raised.
    """
    batch, taken = list[Message](), 0
    try:
        for message in messages:
            batch.append(message)
            taken += len(message[2])
            if len(batch) == count or taken >= size:
                yield batch
                batch, taken = [], 0
    except Exception:
        if batch:
            yield batch
        raise
    if batch:
        yield batch


def check_encoding(topic: Topic) -> None:
    """Make sure that the messages on a topic are CDR.

    Raises:
        ValueError: if they are not.
    """
    if topic.encoding != 'cdr':
        raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')
