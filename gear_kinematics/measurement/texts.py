# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Texts of any size: their encoding, one row in n, and what programs write around numbers."""

import codecs
import io
import re
from collections.abc import Callable, Sequence
from typing import IO, Any

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

_LEVEL = r'(?:TRACE|DEBUG|INFO|NOTICE|WARN(?:ING)?|ERROR)'
_LOGGED = re.compile(
    r'(?m)^(?:\[(?=[^]\n]*\d:\d\d)([^]\n]*)\][ \t]*|(\d\d:\d\d:\d\d[.:]\d+) -?>[ \t]*|'
    rf'(\d{{4}}-\d\d-\d\d[ T]\d\d:\d\d:\d\d[.,]\d+)(?:[^\n\d]|[A-Za-z_]-?\d+)*?\b{_LEVEL}\b'
    r'(?: +\| \S+(?= -))?(?: -|[:\]])? +|'
    rf'(?:\[[\w.-]+-\d+\] )?\[{_LEVEL}\] \[(\d+\.\d+)\] \[[^]\n]*\]: |'
    r'[EWIDV] \((\d+)\) [\w.-]+: |'
    r'(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d[.,]\d+) +(?![AP]M|UTC|Z|[-+](\d\d:|0\d{3})|\+1\d{3})'
    r'(?=[^ ,;\t\n]+[,;\t]))'
)
"""Stamps that terminals, such as Tera Term and the Arduino IDE, and the logs of Python, ROS and
ESP-IDF write before each line."""
_LABEL = re.compile(r'(?m)(?:(?<=[\s,;])|^)([^\W\d]\w*) ?[:=] ?(?=[-+.\d])')
"""Names before each number, as sketches print them for the plotter of the Arduino IDE."""
_PYTHON = re.compile(r"\b(?:np\.\w+|array|tensor)\((?:'\w', ?)?([^()=]*?)(?:, \w+=[\w.':]+)*\)")
"""Numbers and arrays as Python shows them, such as np.float64(1.5)."""
_LINES = 100  # lines whose labels are compared


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


def plainer(text: str, separators: Sequence[str]) -> tuple[Callable[[str], str], list[str]]:
    """Find what programs write around numbers in the lines of a text.

    Returns:
        What leaves it out of lines, with stamps in a column of their own; the names of all columns
        if a name is before each number, or else nothing.
    """
    rules: list[tuple[re.Pattern[str], Any]] = [(_PYTHON, r'\1')] * bool(_PYTHON.search(text))
    if logged := 2 * len(_LOGGED.findall(text)) > text.count('\n'):
        rest = _LABEL.sub('', _LOGGED.sub('', text[: text.rfind('\n')]))
        mark = max(separators, key=rest.count)
        joint = 'T' if mark == ' ' else ' '
        rules.append(
            (_LOGGED, lambda at: at[at.lastindex].replace(' ', joint).replace(',', '.') + mark)
        )
    labels = [*map(_LABEL.findall, text.split('\n')[1:_LINES])]
    several = len(labels) > 1 and labels[0] == labels[-2] != labels[0][:1]
    rules += [(_LABEL, '')] * several

    def plain(text: str) -> str:
        for pattern, new in rules:
            text = pattern.sub(new, text)
        return text

    return plain, [*['time of the line'] * logged, *labels[0]] if several else []
