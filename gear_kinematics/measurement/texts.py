# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Texts of any size: their encoding, one row in n, and what programs write around numbers."""

import codecs
import io
import re
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
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
    r'(?m)^(?:\[(?=[^]\n]*\d:\d\d)([^]\n]*)\][ \t]*'
    r'(?:(?:<\w+>|\[[\w.-]+\])[ \t]+)*(?:[\w.-]+: +)?|'
    r'(\d\d:\d\d:\d\d[.:]\d+) -?>[ \t]*|'
    r'[A-Z][a-z]{2} [ \d]\d (\d\d:\d\d:\d\d(?:\.\d+)?) \S+ [\w./-]+(?:\[\d+\])?: |'
    rf'(\d{{4}}-\d\d-\d\d[ T]\d\d:\d\d:\d\d[.,]\d+)(?:[^\n\d]|[A-Za-z_]-?\d+)*?\b{_LEVEL}\b'
    r'(?: +\| \S+(?= -))?(?: -|[:\]])? +|'
    rf'(?:\[[\w.-]+-\d+\] )?\[{_LEVEL}\] \[(\d+\.\d+)\] \[[^]\n]*\]: |'
    rf'[EWIDV] \((\d+)\) [\w.-]+: |\[{_LEVEL}\]:?()[ \t]+(?!\[)|'
    r'(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d[.,]\d+) +(?![AP]M|UTC|Z|[-+](\d\d:|0\d{3})|\+1\d{3})'
    r'(?=[^ ,;\t\n]+[,;\t]))'
)
"""Stamps that terminals, such as Tera Term and the Arduino IDE, and the logs of Python, ROS,
ESP-IDF, Zephyr, spdlog and journald write before each line, or a level without a stamp."""
_LABEL = re.compile(r'(?m)(?:(?<=[\s,;|])|^)([^\W\d]\w*) ?[:=] ?(?=[-+.\d])')
"""Names before each number, as sketches print them for the plotter of the Arduino IDE."""
_STAMP = re.compile(
    r'(?:\d{4}-\d\d-\d\d[ T])?\d\d:\d\d:\d\d(?:[.,:]\d+)*|(?<!\w)[(\[] *(\d+(?:\.\d+)?)[)\]]|'
    r'^[ \t]*(\d+(?:\.\d+)?)[\s,;|]*$'
)
"""Times before such names: those of journald and Zephyr, of Linux and ESP-IDF, or a number."""
_NUMBERS = re.compile(r'(?:^|[,;|\t])[ \t]*[-+.\d]+(?:[eE][-+]?\d+)?\s*(?=[,;|\t]|$)')
"""Cells with a number before such names: with several, it is a table with these in a column."""
_WORDS = re.compile(r'\s+[^\W\d]\w*[:=].*')  # behind a number, such as state=running
_TELEPLOT = re.compile(r'(?m)^>([^:\n]+):(?:(\d+):)?([-+.\deE]+)(?:§([^|\n]*))?(?:\|.*)?$')
_COLOURS = re.compile(r'\x1b\[[\d;]*m')
_PYTHON = re.compile(r"\b(?:np\.\w+|array|tensor)\((?:'\w', ?)?([^()=]*?)(?:, \w+=[\w.':]+)*\)")
"""Numbers and arrays as Python shows them, such as np.float64(1.5)."""
_LINES, _LEAST_SHARE = 100, 0.1  # lines whose labels are compared; share that has the same


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
    rules: list[tuple[re.Pattern[str], Any]] = [
        (pattern, new)
        for pattern, new in ((_PYTHON, r'\1'), (_COLOURS, ''))
        if pattern.search(text)
    ]
    if 2 * len(_TELEPLOT.findall(text)) > text.count('\n'):
        return _values, ['name', 'time [ms]', 'value', 'unit']
    lines = _replaced(rules, text).split('\n')[1:_LINES]
    found = [(*_LABEL.findall(line),) for line in lines]
    (labels, count), *_ = Counter(one for one in found if one[1:]).most_common(1) or [((), 0)]
    alike = (line for line, one in zip(lines, found, strict=True) if one == labels)
    heads = [_LABEL.split(line, 1)[0] for line in alike]
    if count > _LEAST_SHARE * len(lines) and not _NUMBERS.findall(heads[0])[1:]:
        words = {' '.join(re.findall(r'[^\W\d_]+', _STAMP.sub('', head))) for head in heads}
        if len(words) > 1:
            kinds = ' and '.join(map(repr, sorted(words)[:2]))
            raise ValueError(
                f'lines with the same labels begin with {kinds}: save those of each in a file, or '
                'write these words into the labels'
            )
        timed = bool(_STAMP.search(heads[0]))
        names = ['time of the line'] * timed + [*labels]
        return lambda text: _labelled(_replaced(rules, text), labels, timed=timed), names
    if 2 * len(_LOGGED.findall(text)) > text.count('\n'):
        rest = _LOGGED.sub('', text[: text.rfind('\n')])
        mark = max(separators, key=rest.count)
        joint = 'T' if mark == ' ' else ' '
        rules.append((_LOGGED, lambda at: _plain(at).replace(' ', joint) + mark))
    return partial(_replaced, rules), []


def _replaced(rules: Sequence[tuple[re.Pattern[str], Any]], text: str) -> str:
    for pattern, new in rules:
        text = pattern.sub(new, text)
    return text


def _values(text: str) -> str:
    """Return what lines of Teleplot contain, without all other lines."""
    return _joined(_TELEPLOT.findall(text), text)


def _labelled(text: str, labels: Sequence[str], *, timed: bool) -> str:
    """Return the numbers behind labels, and the stamps before them, without all other lines."""
    rows = []
    for line in text.split('\n'):
        before, *parts = _LABEL.split(line)
        if (*parts[::2],) == labels:
            cells = [_WORDS.sub('', part).strip(' \t,;|') for part in parts[1::2]]
            if timed:
                stamp = _STAMP.search(before)
                cells.insert(0, _plain(stamp) if stamp else '')
            rows.append(cells)
    return _joined(rows, text)


def _joined(rows: Sequence[Sequence[str]], text: str) -> str:
    """Return rows of cells as lines, of which the last one ends if that of their text does."""
    return '\n'.join(map('\t'.join, rows)) + '\n' * text.endswith('\n') or '\n'


def _plain(stamp: re.Match[str]) -> str:
    """Return a stamp with decimals behind a point: 00:00:01.234,567 is 00:00:01.234567."""
    whole, _, decimals = stamp[stamp.lastindex or 0].replace(',', '.').partition('.')
    return f'{whole}.{decimals.replace(".", "")}' if decimals else whole
