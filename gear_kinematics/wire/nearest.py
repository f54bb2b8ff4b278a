"""What to answer to a name that is not known."""

from collections.abc import Iterable
from difflib import get_close_matches


def nearest(name: str, known: Iterable[str]) -> str:
    """The end of a message on an unknown name: a question with the nearest known one, or ''."""
    matches = get_close_matches(name, known, n=1)
    return f'; did you mean `{matches[0]}`?' if matches else ''
