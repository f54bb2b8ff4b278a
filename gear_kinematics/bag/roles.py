"""Finds the topics of the rotor, the outputs and the encoder in a recording."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, Self

from gear_kinematics.bag.errors import BagError
from gear_kinematics.bag.reading import Bag
from gear_kinematics.bag.topics import listed, missing_topic
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_TOPICS,
    OUTPUT_ENCODER,
    OUTPUT_STATE,
    ROTOR_STATE,
    TOPICS,
)

_PARTS = {'output': OUTPUT_STATE, 'poses': BODY_POSES, 'rotor': ROTOR_STATE}
"""Topics by their parts in a validation; the rotor is found last, among the remaining topics."""


class Topics(NamedTuple):
    """Names of topics in a recording."""

    rotor: str = f'/{ROTOR_STATE}'
    output: str = f'/{OUTPUT_STATE}'
    poses: str = f'/{BODY_POSES}'

    @classmethod
    def beside(cls, rotor: str) -> Self:
        """The topics of the node in the namespace of the rotor's topic."""
        namespace, _, _ = rotor.rpartition('/')
        return cls(rotor, f'{namespace}/{OUTPUT_STATE}', f'{namespace}/{BODY_POSES}')


def find_topics(
    bag: Bag,
    given: Mapping[str, str | None] = MappingProxyType({}),
    *,
    outputs: bool = True,
    poses: bool = True,
) -> Topics:
    """Find the topics by type and name, in any namespace; that of the rotor's topic comes first.

    Args:
        bag: an open bag.
        given: names of known topics by their parts.
        outputs: whether the outputs must exist too.
        poses: whether the poses are one of the outputs.

    Raises:
        BagError: if a topic is missing or ambiguous.
    """
    left_out = {'output': not outputs, 'poses': not (outputs and poses)}
    parts = [part for part in _PARTS if not left_out.get(part)]
    found = {part: topic for part in parts if (topic := given.get(part))}
    left = dict(bag.topics)
    if 'rotor' in found:
        for part, topic in Topics.beside(found['rotor'])._asdict().items():
            if part in parts and bag.topics.get(topic) == TOPICS[_PARTS[part]].type:
                found.setdefault(part, topic)
    for part, topic in found.items():
        if left.get(topic) != (wanted := TOPICS[_PARTS[part]].type):
            raise missing_topic(bag.path, left, topic, wanted)
        del left[topic]
    for part in parts:
        if part not in found:
            found[part] = _find_topic(bag, left, _PARTS[part])
            del left[found[part]]
    return Topics(**found)


def find_rotor_topic(bag: Bag, given: str | None = None) -> str:
    """Return the rotor's topic: the given one, or else by type and name.

    Raises:
        BagError: if it is missing or ambiguous.
    """
    return find_topics(bag, {'rotor': given}, outputs=False).rotor


def find_encoder_topic(bag: Bag, given: str | None = None) -> str | None:
    """Return the topic of the output encoder: the given one, or else by name; None without one.

    Raises:
        BagError: if the given one is missing, or several have the name.
    """
    wanted = TOPICS[OUTPUT_ENCODER].type
    if given:
        bag.type_of(given, wanted)
        return given
    named = [topic for topic in _of_type(bag.topics, wanted) if _base(topic) == OUTPUT_ENCODER]
    return _only(bag.path, named, OUTPUT_ENCODER) if named else None


def corrected_beside(output: str = Topics().output) -> dict[str, str]:
    """Return the names of CORRECTED_TOPICS in the namespace of the topic of output_state."""
    namespace, _, _ = output.rpartition('/')
    return {name: f'{namespace}/{name}' for name in CORRECTED_TOPICS}


def find_corrected_topics(bag: Bag, output: str) -> dict[str, str]:
    """Return those of `corrected_beside` that a bag has.

    Args:
        bag: an open bag.
        output: the topic of output_state.
    """
    return {
        name: topic
        for name, topic in corrected_beside(output).items()
        if bag.topics.get(topic) == CORRECTED_TOPICS[name]
    }


def _find_topic(bag: Bag, available: Mapping[str, str], name: str) -> str:
    of_type = _of_type(available, TOPICS[name].type)
    candidates = [topic for topic in of_type if _base(topic) == name] or [
        topic for topic in of_type if _base(topic) not in TOPICS
    ]
    if not candidates:
        raise missing_topic(bag.path, bag.topics, name, TOPICS[name].type, suggest=False)
    return _only(bag.path, candidates, name)


def _only(path: Path, candidates: list[str], name: str) -> str:
    if len(candidates) > 1:
        raise BagError(f'{path}: which topic is {name}? {listed(candidates)}')
    return candidates[0]


def _of_type(topics: Mapping[str, str], wanted: str) -> list[str]:
    return [topic for topic, kind in topics.items() if kind == wanted]


def _base(topic: str) -> str:
    """The name without its namespace."""
    return topic.rpartition('/')[2]
