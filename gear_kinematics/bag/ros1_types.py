"""The types of ROS 1 messages, which are needed to convert them to CDR."""

from functools import cache
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Typesdict
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

MAX_PARTS = 10_000
"""Most parts of all types together: rosbags takes up to a millisecond to prepare each."""
_MAX_PARTS_FOR_BYTES = 8
_TEXTS = {'string', 'wstring'}


@cache
def ros1_types(message_type: str, definition: str) -> tuple[Typestore, int]:
    """Create a store of the types of a definition, as they are in ROS 2.

    Returns:
        The store, and the number of parts in which rosbags converts a message.

    Raises:
        ValueError: if the conversion of a small message could take long.
    """
    types = get_types_from_msg(definition, message_type)
    jazzy = get_typestore(Stores.ROS2_JAZZY).fielddefs
    types['std_msgs/msg/Header'] = jazzy['std_msgs/msg/Header']  # ROS 1 has a sequence number
    for name in ('builtin_interfaces/msg/Time', 'builtin_interfaces/msg/Duration'):
        types.setdefault(name, jazzy[name])  # primitive types in ROS 1
    parts, _ = _extent((Nodetype.NAME, message_type), types, {})
    store = get_typestore(Stores.EMPTY)
    store.register(types)
    return store, parts


def _extent(
    field: tuple[Nodetype, Any], types: Typesdict, known: dict[str, tuple[int, int]]
) -> tuple[int, int]:
    """The parts that rosbags converts one by one, and how many of them are never empty."""
    kind, detail = field
    if kind == Nodetype.BASE:
        return 1, 1
    if kind == Nodetype.NAME:
        if detail not in known:
            extents = [_extent(inner, types, known) for _, inner in types[detail][1]]
            known[detail] = 1 + sum(parts for parts, _ in extents), sum(n for _, n in extents)
        return known[detail]
    element, count = detail
    parts, filled = _extent(element, types, known)
    if kind == Nodetype.SEQUENCE:
        # A message can claim any number of elements that take no bytes.
        if parts > _MAX_PARTS_FOR_BYTES * filled:
            raise ValueError('a sequence of nearly empty messages')
        return 1 + parts, 1
    if element[0] == Nodetype.BASE and element[1][0] not in _TEXTS:
        return 1, 1
    return count * parts, count * filled
