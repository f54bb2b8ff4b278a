# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Errors about bags, whichever library raised them first."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager

_REMEDIES = {
    'rosbags': "pip install 'gear_kinematics[rosbags]'",
    'zstandard': 'apt install python3-zstandard, or pip install backports.zstd',
    'lz4': 'apt install python3-lz4, or pip install lz4',
}
"""How to install libraries that only some recordings need."""
_MEANINGS = {'interrupted': 'there are more rows than a file of this size can hold'}
"""Meanings of error texts of sqlite, which is interrupted for this reason alone."""


class BagError(ValueError):
    """A bag that cannot be used; the text is one line that names it and the cause."""


class DamagedBagError(BagError):
    """A bag that is damaged after some readable messages; the text also says where."""


class TopicError(BagError):
    """A topic that cannot be copied; the text names it, its bag and the cause."""


def cause(error: BaseException) -> str:
    """Describe an error of any library in one line."""
    if isinstance(error, KeyError):
        return f'{error} is missing'
    if isinstance(error, ModuleNotFoundError):
        library = (error.name or '').partition('.')[0]
        if library in _REMEDIES:
            return f'needs {library}: {_REMEDIES[library]}'
    # OSErrors that libraries raise may lack this text.
    text = str(getattr(error, 'strerror', None) or error)
    text = _MEANINGS.get(text, text)
    return ' '.join(text.split()) or type(error).__name__


def unexpected(error: Exception, *, debug: bool) -> str:
    """Describe an unexpected error in one line; prints its traceback to stderr for `debug`."""
    if debug:
        traceback.print_exception(error)
    hint = '' if debug else '; --debug shows where'
    return f'unexpected {type(error).__name__}: {cause(error)}{hint}'


@contextmanager
def bag_errors(name: object, kind: type[BagError] = BagError) -> Iterator[None]:
    """Convert any exception about data on disk to a BagError that names the file."""
    try:
        yield
    except BagError:
        raise
    except Exception as error:
        raise kind(f'{name}: {cause(error)}') from error
