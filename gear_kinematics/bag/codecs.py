# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Decompression within limits, so that a crafted bag is refused before it fills the memory.

Its libraries are imported where a bag needs them.
"""

import os
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import IO, Any, NamedTuple, Self

from gear_kinematics.bag.errors import cause

Decompressor = Callable[[bytes, int], tuple[bytes, bool]]
"""Takes a frame and a limit; returns at most that many bytes, and whether they are all."""


@cache
def _zstd() -> Any:
    try:
        if sys.version_info >= (3, 14):
            from compression import zstd  # noqa: PLC0415
        else:
            from backports import zstd  # noqa: PLC0415
    except ModuleNotFoundError:
        return _Zstandard()
    return zstd


class _Zstandard:
    """The needed part of Python's zstd, based on zstandard, which Debian and Ubuntu package."""

    def __init__(self) -> None:
        import zstandard  # noqa: PLC0415

        self._library = zstandard
        self.ZstdFile = zstandard.open

    def ZstdDecompressor(self) -> Self:
        return self

    def decompress(self, data: bytes, limit: int) -> bytes:
        size = self._library.frame_content_size(data)  # -1 if its writer did not know it
        reader = self._library.ZstdDecompressor().stream_reader(data)
        content: bytes = reader.read(min(limit, size) if size >= 0 else limit)
        self.eof = size in {-1, len(content)}  # the only sign that a frame is cut off
        return content


def _decompress_zstd(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = _zstd().ZstdDecompressor()
    return decompressor.decompress(data, limit), decompressor.eof


@cache
def _lz4() -> Any:
    import lz4.frame  # type: ignore[import-untyped]  # noqa: PLC0415

    return lz4.frame


def _decompress_lz4(data: bytes, limit: int) -> tuple[bytes, bool]:
    # The format expands to 255 times the size at most, and lz4 allocates the limit at once.
    decompressor = _lz4().LZ4FrameDecompressor()
    return decompressor.decompress(data, min(limit, 256 * len(data))), decompressor.eof


class ReadLimits:
    """The bytes and descriptions that may still be read from the files of a bag.

    Chunks of a recording expand to up to 20 times their size, and a message takes at least a byte
    of a compressed file. Only blank images and maps expand further: they are few, or small.
    """

    max_record = 2**30  # largest record on disk, bytes
    max_descriptions = 2**25  # largest descriptions of topics and types together, bytes
    chunk_expansion, file_expansion = 20, 100
    """Greatest expansion of a chunk or message, and of a file."""
    spare_size, spare_total = 2**25, 2**30
    """Allowance in addition, bytes: of a chunk or file, and of the whole bag."""
    _description = 256  # bytes counted for a description in addition to its texts

    def __init__(self, size: int) -> None:
        """Start with the size of the files on disk, bytes."""
        self._expanded = self.spare_total + self.file_expansion * size
        self._known: set[int] = set()
        self._described = 0

    @classmethod
    def expanded_chunk(cls, size: int) -> int:
        """Return the size, bytes, to which a compressed chunk or message may expand."""
        return cls.spare_size + cls.chunk_expansion * size

    def count(self, expanded: int) -> None:
        """Count decompressed bytes; raises ValueError if there are too many."""
        self._expanded -= expanded
        if self._expanded < 0:
            raise ValueError('its compressed data expand to more than a bag of this size can hold')

    def describe(self, *texts: str | bytes) -> None:
        """Count the description of a topic or type once; ValueError if all are too large."""
        if (key := hash(texts)) in self._known:
            return
        self._known.add(key)
        self._described += self._description + sum(map(len, texts))
        if self._described > self.max_descriptions:
            raise ValueError(
                f'the descriptions of its topics exceed {self.max_descriptions} bytes'
            )


class Codec(NamedTuple):
    """A kind of compression."""

    magic: bytes  # first bytes of a frame; CDR begins with a zero
    decompress: Decompressor
    open: Callable[[IO[bytes]], Any]  # opens a compressed file for reading


CODECS: Mapping[str, Codec] = {
    'zstd': Codec(b'\x28\xb5\x2f\xfd', _decompress_zstd, lambda file: _zstd().ZstdFile(file)),
    'lz4': Codec(b'\x04\x22\x4d\x18', _decompress_lz4, lambda file: _lz4().open(file)),
}
"""Kinds by their names in bags."""


def codec_of(data: bytes) -> Codec | None:
    """Recognise how data are compressed by the first bytes; None if they are not."""
    return next((codec for codec in CODECS.values() if data.startswith(codec.magic)), None)


def decompressed(data: bytes, decompress: Decompressor, limits: ReadLimits, what: str) -> bytes:
    """Decompress a chunk or message, `what`; raises ValueError if it is cut off or too large."""
    content, whole = decompress(data, limits.expanded_chunk(len(data)))
    limits.count(len(content))
    if not whole:
        raise ValueError(f'{what} is cut off or too large')
    return content


def decompress_file(source: IO[bytes], target: Path, codec: Codec) -> str:
    """Decompress as much as possible; returns the cause of an early end, or an empty text."""
    size = os.fstat(source.fileno()).st_size
    limit = left = ReadLimits.spare_size + ReadLimits.file_expansion * size
    with target.open('wb') as output, codec.open(source) as expanded:
        try:
            while piece := expanded.read1(2**18):  # returns partial data, unlike read()
                left -= output.write(piece)
                if left < 0:
                    raise ValueError(f'it expands to more than {limit} bytes')
        except Exception as error:  # noqa: BLE001, raised by two libraries
            return cause(error)
    return ''
