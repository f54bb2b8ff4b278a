"""Which topic of a recording plays which part."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

from gear_kinematics.bag.errors import BagError
from gear_kinematics.bag.reading import Bag
from gear_kinematics.bag.topics import listed
from gear_kinematics.wire.cdr import JOINT_STATE, POSE_ARRAY

_CONTRACT = {
    'output': ('output_state', JOINT_STATE),
    'poses': ('body_poses', POSE_ARRAY),
    'rotor': ('rotor_state', JOINT_STATE),
}
"""Name and type of the topics."""
_OURS = {
    *(name for name, _ in _CONTRACT.values()),
    'mechanism_joint_states',
    'output_encoder',
    'transmission_error',
}


@dataclass(frozen=True, slots=True)
class Topics:
    """The names of the topics in the recording."""

    rotor: str = '/rotor_state'
    output: str = '/output_state'
    poses: str = '/body_poses'

    def names(self) -> tuple[str, str, str]:
        """All three."""
        return self.rotor, self.output, self.poses


_TOPICS = Topics()


def find_topics(
    bag: Bag, given: Mapping[str, str | None] = MappingProxyType({}), *, outputs: bool = True
) -> Topics:
    """Find the three topics by type and name: as in the contract, in any namespace.

    Those of the namespace of the rotor's topic come first.

    Args:
        bag: an open bag.
        given: names of topics by their parts, as far as they are known.
        outputs: whether those have to be there.

    Raises:
        BagError: if one is not there, or which one is meant is not clear.
    """
    roles = list(_CONTRACT) if outputs else ['rotor']
    found = {role: topic for role in roles if (topic := given.get(role))}
    left = dict(bag.topics)
    namespace, _, _ = found.get('rotor', '').rpartition('/')
    for role in roles if 'rotor' in found else ():
        beside = f'{namespace}/{_CONTRACT[role][0]}'
        if bag.topics.get(beside) == _CONTRACT[role][1]:
            found.setdefault(role, beside)
    for role, topic in found.items():
        if left.pop(topic, None) != (kind := _CONTRACT[role][1]):
            raise BagError(f'{bag.path}: no topic {topic} of type {kind} in it')
    for role in roles:
        if role not in found:
            found[role] = _find_topic(bag.path, left, *_CONTRACT[role])
            del left[found[role]]
    return replace(_TOPICS, **found)


def find_rotor_topic(bag: Bag, given: str | None = None) -> str:
    """Give the rotor's topic: the given one, or else by type and name.

    Raises:
        BagError: if it is not there, or which one is meant is not clear.
    """
    if not given:
        return find_topics(bag, outputs=False).rotor
    if bag.topics.get(given) != JOINT_STATE:
        raise BagError(f'{bag.path}: no topic {given} of type {JOINT_STATE} in it')
    return given


def _find_topic(path: Path, available: Mapping[str, str], name: str, kind: str) -> str:
    by_type = {
        topic: topic.rpartition('/')[2]
        for topic, its_kind in sorted(available.items())
        if its_kind == kind
    }
    candidates = [topic for topic, base in by_type.items() if base == name] or [
        topic for topic, base in by_type.items() if base not in _OURS
    ]
    if not candidates:
        raise BagError(f'{path}: no topic {name} of type {kind} in it')
    if len(candidates) > 1:
        raise BagError(f'{path}: which topic is {name}? {listed(candidates)}')
    return candidates[0]
