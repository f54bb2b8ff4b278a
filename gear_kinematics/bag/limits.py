"""How much may come out of a bag: what its size on disk explains, and little more.

Chunks of a recording expand to up to 20 times their size, and a message takes a byte of a
compressed file or more. What expands further is blank images and maps: few, or small.
"""

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
