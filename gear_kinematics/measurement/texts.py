# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Texts of any size: their encoding, and one row in n."""

import codecs
import io
import re
from collections.abc import Callable
from typing import IO

BLOCK = 2**17  # characters that are read at a time
_BOMS = {b'\xef\xbb\xbf': 'utf-8-sig', b'\xff\xfe': 'utf-16', b'\xfe\xff': 'utf-16'}
_OTHERS = {
    'cp932': re.compile(rb'(\x83[\x40-\x96]|\x81\x5b){2}'),
    'cp949': re.compile('모터|출력|각도|위치|토크'.encode('cp949')),
    'big5': re.compile('馬達|輸出|角度|位置|扭矩|轉矩'.encode('big5')),
    'cp1251': re.compile(rb'[\xe0-\xff]{4}'),
    'gb18030': re.compile(rb'([\xb0-\xf7][\xa1-\xfe]){2}'),
}
"""Encodings of Windows: Katakana, words in Korean or traditional Chinese, which may look like
simplified Chinese, four letters in Cyrillic, or two Chinese characters."""


class Rows(io.TextIOBase):
    """Passes on one row in `every`, so that pandas need not parse the others."""

    def __init__(self, file: IO[str], every: int, plain: Callable[[str], str] = str) -> None:
        """Read a file, of which `plain` rewrites several lines at once."""
        self._file, self._every, self._plain, self._skip = file, every, plain, 0

    def read(self, _size: int | None = None) -> str:
        """Return some of the chosen rows, or nothing at the end."""
        chosen: list[str] = []
        while not chosen and (text := self._file.read(BLOCK) + self._file.readline()):
            *rows, last = io.StringIO(self._plain(text), newline=None)
            if last.endswith('\n') or len(last) + 1 >= min(map(len, rows), default=0):
                rows.append(last)  # otherwise it was cut
            chosen = rows[self._skip :: self._every]
            self._skip = (self._skip - len(rows)) % self._every
        return ''.join(chosen)


def encoding_of(head: bytes) -> str:
    """Return the encoding of a text; ValueError if it is not text."""
    if encoding := next((_BOMS[mark] for mark in _BOMS if head.startswith(mark)), ''):
        return encoding
    if 0 in head.rstrip(b'\0'):  # with which a crash can leave the end
        zeros = head[::2].count(0), head[1::2].count(0)
        if min(zeros) == 0 and max(zeros) > len(head) // 4:
            return 'utf-16-le' if zeros[1] else 'utf-16-be'
        raise ValueError('not text')
    try:
        codecs.getincrementaldecoder('utf-8')().decode(head)
    except UnicodeDecodeError:
        return next((code for code in _OTHERS if _OTHERS[code].search(head)), 'cp1252')
    return 'utf-8'
