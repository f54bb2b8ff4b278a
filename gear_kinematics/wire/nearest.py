"""Suggestions for unknown names."""

from collections.abc import Iterable
from difflib import get_close_matches


def nearest(name: str, known: Iterable[str]) -> str:
    """End of a message on an unknown name: a question about the nearest known one, or ''."""
    matches = get_close_matches(name, known, n=1)
    return f'; did you mean `{matches[0]}`?' if matches else ''
