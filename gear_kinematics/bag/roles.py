# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the topics of the rotor, the outputs and the encoder in a recording."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, Self

from gear_kinematics.bag.errors import BagError
from gear_kinematics.bag.reading import Bag
from gear_kinematics.bag.storage import missing_topic
from gear_kinematics.wire.batches import JointStateBatch
from gear_kinematics.wire.joint_reader import joints_of
from gear_kinematics.wire.nearest import among, listed
from gear_kinematics.wire.topics import (
    BODY_POSES,
    OUTPUT_ENCODER,
    OUTPUT_STATE,
    ROTOR_STATE,
    TOPICS,
    base_name,
)

_PARTS = {'rotor': ROTOR_STATE, 'output': OUTPUT_STATE, 'poses': BODY_POSES}
"""Topics by their parts in a validation."""
_OPTIONS = {topic: part for part, topic in _PARTS.items()} | {OUTPUT_ENCODER: 'encoder'}
_OTHER_WAYS = {
    OUTPUT_STATE: ', or its node with --node',
    BODY_POSES: ', or give the parameter file of an arm with --config',
}
"""To choose the topic otherwise than by its option."""
_NOT_CDR = ' (not CDR)'  # after a topic or its type, whose messages are in JSON or the like
_PEEKED = 20  # topics whose joints are looked up
_JUDGED = 1000  # messages that are searched for other joints


class Topics(NamedTuple):
    """Names of topics in a recording."""

    rotor: str = f'/{ROTOR_STATE}'
    output: str = f'/{OUTPUT_STATE}'
    poses: str = f'/{BODY_POSES}'

    @classmethod
    def in_namespace_of(cls, rotor: str) -> Self:
        """Return the topics of the node in the namespace of the rotor's topic."""
        return cls(rotor, *in_namespace([OUTPUT_STATE, BODY_POSES], rotor).values())


def find_topics(
    bag: Bag,
    given: Mapping[str, str | None] = MappingProxyType({}),
    *,
    outputs: bool = True,
    poses: bool = True,
    joints: Collection[str] = (),
    namespace: str | None = None,
) -> Topics:
    """Find the topics by type and name; those in the namespace of the rotor's topic come first.

    The names of some parts may be given. The rotor's topic is the one with most of the `joints`;
    of several that are alike, it is the one whose namespace has the outputs. The outputs are those
    in the `namespace` of the node, by default in that of a given output. Without `outputs`, only
    the rotor's topic must exist. Poses neither recorded nor given have an empty name.

    Raises:
        BagError: if a topic is missing or ambiguous.
    """
    if outputs and poses and not given.get('poses'):
        poses = TOPICS[BODY_POSES].type in bag.topics.values()
    left_out = {'output': not outputs, 'poses': not (outputs and poses)}
    parts = [part for part in _PARTS if not left_out.get(part)]
    found = {part: topic for part in parts if (topic := given.get(part))}
    left = {name: kind + _NOT_CDR * (name in bag.not_cdr) for name, kind in bag.topics.items()}
    for part, topic in found.items():
        if left.get(topic) != (wanted := TOPICS[_PARTS[part]].type):
            raise missing_topic(bag.path, left, topic, wanted)
        del left[topic]
    node_known = namespace is not None
    if namespace is None and (output := found.get('output') or found.get('poses')):
        namespace = output.rpartition('/')[0]
    if 'rotor' not in found:
        found['rotor'] = _find_topic(bag, left, ROTOR_STATE, joints, namespace, outputs=outputs)
        del left[found['rotor']]
    chosen = found['rotor'] if namespace is None else f'{namespace}/{ROTOR_STATE}'
    expected = Topics.in_namespace_of(chosen)._asdict()
    for part in [part for part in parts if part not in found]:
        topic, kind = expected[part], TOPICS[_PARTS[part]].type
        if left.get(topic) != kind:
            alike = [other for other in _of_type(left, kind) if base_name(other) == _PARTS[part]]
            # Outputs without a namespace can be of any node, as `gearkin compute` writes them.
            anyones = {f'/{_PARTS[part]}'} if found.get('output', '/').count('/') == 1 else set()
            if node_known and not anyones.issuperset(alike):
                if part == 'output':
                    raise missing_topic(bag.path, left, topic, kind)
                continue
            topic = _find_topic(bag, left, _PARTS[part])
        found[part] = topic
        del left[topic]
    if outputs:
        found.setdefault('poses', '')
    return Topics(**found)


def find_rotor_topic(bag: Bag, given: str | None = None, *joints: str) -> str:
    """Return the rotor's topic: the given one, or else by type and name; see `find_topics`."""
    return find_topics(bag, {'rotor': given}, outputs=False, joints=joints).rotor


def outputs_of(bag: Bag, rotor: str) -> Topics:
    """Return the output topics for a rotor topic, in its namespace, or as recorded of one node."""
    kind = TOPICS[OUTPUT_STATE].type
    near = Topics.in_namespace_of(rotor)
    recorded = [
        topic
        for topic in _of_type(bag.topics, kind)
        if base_name(topic) == OUTPUT_STATE
        and f'{topic.removesuffix(OUTPUT_STATE)}{ROTOR_STATE}' not in bag.topics
    ]
    if near.output in bag.topics or len(recorded) != 1:
        return near
    return Topics.in_namespace_of(recorded[0])._replace(rotor=rotor)


def only_joint(bag: Bag, topic: str, joint: str) -> str:
    """Return the joint to read on a topic of joint states: the only one, or else the given one."""
    found = joints_on(bag, [topic])[topic]
    return found[0] if len(found) == 1 else joint


def joints_on(bag: Bag, topics: Sequence[str]) -> dict[str, list[str]]:
    """Return the joints, safe to print, in the first readable messages on JointState topics.

    They are looked up once, as this reads the whole bag where a topic has no messages.
    """
    if (key := tuple(topics)) in bag.joints:
        return dict(bag.joints[key])
    first: dict[str, list[bytes]] = {topic: [] for topic in topics}
    left = set(topics)
    with suppress(BagError):
        for number, (topic, _, data) in enumerate(bag.messages(topics) if topics else ()):
            if number < _JUDGED or topic in left:
                left.discard(topic)
                first[topic].append(data)
            if number >= _JUDGED and not left:
                break
    joints = bag.joints[key] = {}
    for topic, messages in first.items():
        rows = sorted(rows[0] for rows, *_ in JointStateBatch(messages).tables)  # of each layout
        names = (name for row in rows for name in joints_of(messages[row]))
        joints[topic] = [*dict.fromkeys(names)]
    return dict(joints)


def find_encoder_topic(bag: Bag, rotor: str, given: str | None = None, *joints: str) -> str:
    """Return the output encoder's topic, given or by name, near the rotor's if possible, or ''.

    Without one of that name, it is `topic_with_joint`.

    Raises BagError if the given one is missing, or several in other namespaces have the name.
    """
    wanted = TOPICS[OUTPUT_ENCODER].type
    if given:
        bag.type_of(given, wanted)
        return given
    if found := find_in_namespace(bag, [OUTPUT_ENCODER], rotor):
        return found[OUTPUT_ENCODER]
    named = [topic for topic in _of_type(bag.topics, wanted) if base_name(topic) == OUTPUT_ENCODER]
    if named:
        return _only(bag.path, named, OUTPUT_ENCODER)
    return topic_with_joint(bag, rotor, *joints)


def topic_with_joint(bag: Bag, rotor: str, *joints: str) -> str:
    """Return the only topic with joints that the rotor's topic does not have, or ''."""
    there = _of_type(bag.topics, TOPICS[OUTPUT_ENCODER].type)
    others = [topic for topic in there if base_name(topic) not in TOPICS]
    names = joints_on(bag, [rotor, *others[:_PEEKED]]) if any(joints) else {rotor: []}
    own = {*joints}.difference(['', *names.pop(rotor)])
    found_by_joint = [topic for topic in names if own.intersection(names[topic])]
    return found_by_joint[0] if len(found_by_joint) == 1 else ''


def missing_encoder(bag: Bag) -> str:
    """Say that a bag has no topic of the output encoder, and which topics it might be."""
    topics = _of_type(bag.topics, TOPICS[OUTPUT_ENCODER].type)
    hint = among(OUTPUT_ENCODER, topics)
    return f'no {OUTPUT_ENCODER}; name its topic with --encoder-topic{hint}'


def in_namespace(names: Iterable[str], other: str = Topics().output) -> dict[str, str]:
    """Return the names of the node's topics in the namespace of another topic of it."""
    namespace, _, _ = other.rpartition('/')
    return {name: f'{namespace}/{name}' for name in names}


def find_in_namespace(bag: Bag, names: Iterable[str], output: str) -> dict[str, str]:
    """Return the topics of `in_namespace` that a bag has; names may be those of an actuator."""
    return {
        name: topic
        for name, topic in in_namespace(names, output).items()
        if bag.topics.get(topic) == TOPICS[base_name(name)].type
    }


def _find_topic(
    bag: Bag,
    available: Mapping[str, str],
    name: str,
    wanted: Collection[str] = (),
    namespace: str | None = None,
    *,
    outputs: bool = False,
) -> str:
    of_type = _of_type(available, TOPICS[name].type)
    candidates = [topic for topic in of_type if base_name(topic) == name] or [
        topic for topic in of_type if base_name(topic) not in TOPICS
    ]
    if not candidates:
        wanted_type = TOPICS[name].type
        unread = {t for t in bag.not_cdr if bag.topics[t] == wanted_type}
        there = {t + _NOT_CDR * (t in unread): kind for t, kind in bag.topics.items()}
        raise missing_topic(bag.path, there, name, wanted_type, suggest=False)
    candidates = [t for t in candidates if t.rpartition('/')[0] == namespace] or candidates
    joints: dict[str, list[str]] = {}
    if len(candidates) > 1 and name == ROTOR_STATE:
        joints = joints_on(bag, candidates[:_PEEKED])
        count = {topic: len({*wanted}.intersection(there)) for topic, there in joints.items()}
        if most := max(count.values()):
            candidates = [topic for topic in joints if count[topic] == most]
        if outputs and len(candidates) > 1:
            # In the root there may be states of anything.
            spaces = {t.removesuffix(OUTPUT_STATE) for t in of_type} - {'/', *of_type}
            beside = [t for t in candidates if f'{t.rpartition("/")[0]}/' in spaces]
            candidates = beside if len(beside) == 1 else candidates
    return _only(bag.path, candidates, name, joints)


def _only(
    path: Path,
    candidates: list[str],
    name: str,
    joints: Mapping[str, list[str]] = MappingProxyType({}),
) -> str:
    if len(candidates) > 1:
        topics = [topic + described(joints.get(topic, [])) for topic in candidates]
        option = f'--{_OPTIONS[name]}-topic{_OTHER_WAYS.get(name, "")}'
        raise BagError(f'{path}: which topic is {name}? {listed(topics)}; name it with {option}')
    return candidates[0]


def described(joints: Sequence[str], most: int = 10) -> str:
    """Return the joints of a topic in words, to follow its name; only some if there are many."""
    if len(joints) == 1:
        return f' (joint {joints[0]})'
    return f' (joints {listed(joints, most=most)})' if joints else ''


def _of_type(topics: Mapping[str, str], wanted: str) -> list[str]:
    return [topic for topic, kind in topics.items() if kind == wanted]
