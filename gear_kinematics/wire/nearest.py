# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Texts for messages on unknown names: the nearest known name, and all known names."""

from collections.abc import Collection, Iterable
from difflib import get_close_matches

_SHOWN = 10  # names
_LONGEST = 100  # characters of a name
_COMPARED = 1000  # names; a bag can have tens of thousands


def nearest(name: str, known: Iterable[str]) -> str:
    """Ask whether the nearest known name is meant, as the end of a message; '' if none is near."""
    names = list(known)[:_COMPARED]
    part = name.strip('/')  # of the full name of a node or topic
    matches = [other for other in names if part and part in other.split('/')]
    if len(matches) != 1:
        matches = get_close_matches(name, names, n=1)
    if not matches:
        folded = {other.casefold(): other for other in names}
        matches = [folded[other] for other in get_close_matches(name.casefold(), folded, n=1)]
    return f'; did you mean `{matches[0]}`?' if matches else ''


def listed(names: Collection[str], first: Collection[str] = (), most: int = _SHOWN) -> str:
    """List a limited number of names in one line, with those in `first` before the others."""
    shown, more = sorted(names, key=lambda name: (name not in first, name)), len(names) - most
    text = ', '.join(f'{name:.{_LONGEST}}' for name in shown[:most])
    return f'{text} and {more} more' if more > 0 else text


def among(name: str, known: Collection[str], most: int = _SHOWN) -> str:
    """Suggest the nearest known name and list all, as the end of a message."""
    there = f'there are: {listed(known, most=most)}' if known else 'there are none'
    hint = nearest(name, sorted(known))
    return f'{hint} {there}' if hint else f'; {there}'
