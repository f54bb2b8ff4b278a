# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What reading a bag may take, so that a crafted one is refused before it fills the memory."""


class Limits:
    """The records, bytes and descriptions that may still be read from the files of a bag.

    Chunks of a recording expand to up to 20 times their size, and a message takes at least a byte
    of a compressed file. Only blank images and maps expand further: they are few, or small.
    """

    max_record = 2**30
    """Largest record on disk, bytes."""
    max_descriptions = 2**25
    """Largest descriptions of topics and types together, bytes; all are kept in memory."""
    chunk_expansion, file_expansion = 20, 100
    """Greatest expansion of a chunk or message, and of a file."""
    spare_records, spare_size, spare_total = 100_000, 2**25, 2**30
    """What small bags may have in addition: records, bytes of a chunk or file, bytes of all."""
    _description = 256  # bytes that a description counts for in addition to its texts

    def __init__(self, size: int) -> None:
        """Start with the size of the files on disk, bytes."""
        self._records = self.spare_records + size
        self._expanded = self.spare_total + self.file_expansion * size
        self._known: set[int] = set()
        self._described = 0

    @classmethod
    def expanded_chunk(cls, size: int) -> int:
        """The size, bytes, to which a compressed chunk or message may expand."""
        return cls.spare_size + cls.chunk_expansion * size

    @classmethod
    def expanded_file(cls, size: int) -> int:
        """The size, bytes, to which a compressed file may expand."""
        return cls.spare_size + cls.file_expansion * size

    def count(self, *, records: int = 0, expanded: int = 0) -> None:
        """Count records and decompressed bytes.

        Raises:
            ValueError: if there are too many.
        """
        self._records -= records
        self._expanded -= expanded
        if self._records < 0:
            raise ValueError('there are more records than a bag of this size can hold')
        if self._expanded < 0:
            raise ValueError('its compressed data expand to more than a bag of this size can hold')

    def describe(self, *texts: str | bytes) -> None:
        """Count the description of a topic or type, with its number: once for several files.

        Raises:
            ValueError: if they are larger than any recorder writes.
        """
        if (key := hash(texts)) in self._known:
            return
        self._known.add(key)
        self._described += self._description + sum(map(len, texts))
        if self._described > self.max_descriptions:
            raise ValueError(
                f'the descriptions of its topics exceed {self.max_descriptions} bytes'
            )
