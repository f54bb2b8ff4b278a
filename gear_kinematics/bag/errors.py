"""What is raised about a bag, whichever library noticed it."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager


class BagError(ValueError):
    """A bag that cannot be used; the text is one line that names it and the cause."""


class DamagedBagError(BagError):
    """A bag that is damaged behind messages that could be read; the text also says where."""


class TopicError(BagError):
    """A topic that cannot be copied; the text names it, its bag and the cause."""


def cause(error: BaseException) -> str:
    """Put an error of any library into one line."""
    if isinstance(error, KeyError):
        return f'{error} is missing'
    # Some errors of the operating system's kind come from elsewhere and have no such text.
    text = str(getattr(error, 'strerror', None) or error)
    return ' '.join(text.split()) or type(error).__name__


def unexpected(error: Exception, *, debug: bool) -> str:
    """Describe an error that nothing foresaw, in one line.

    Args:
        error: being handled.
        debug: whether to write its traceback to stderr.
    """
    if debug:
        traceback.print_exception(error)
    hint = '' if debug else '; --debug shows where'
    return f'unexpected {type(error).__name__}: {cause(error)}{hint}'


@contextmanager
def bag_errors(name: object, kind: type[BagError] = BagError) -> Iterator[None]:
    """Turn whatever a library raises about bytes on disk into a BagError that names the file."""
    try:
        yield
    except BagError:
        raise
    except Exception as error:
        raise kind(f'{name}: {cause(error)}') from error
