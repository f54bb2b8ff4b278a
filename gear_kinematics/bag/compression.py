"""Decompression. The output is bounded, whatever size the input claims."""

import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, Any

import lz4.frame  # type: ignore[import-untyped]

from gear_kinematics.bag.errors import cause
from gear_kinematics.bag.limits import CHUNK_EXPANSION, FILE_EXPANSION, Budget, expanded_size

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

Decompressor = Callable[[bytes, int], tuple[bytes, bool]]
"""Decompresses at most so many bytes of a frame, and tells whether that was all of it."""

FileOpener = Callable[[IO[bytes]], Any]


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
