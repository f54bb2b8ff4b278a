# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Questions to the user about which of the joints in live or recorded messages is meant."""

import sys
from collections.abc import Callable, Sequence
from itertools import groupby
from operator import attrgetter
from typing import Literal, TypeVar

from gear_kinematics.commands.output import complain
from gear_kinematics.measurement.commissioning.analysis import Channel
from gear_kinematics.report.document import printable
from gear_kinematics.wire.nearest import among, listed, nearest
from gear_kinematics.wire.topics import OUTPUT_ENCODER, ROTOR_STATE, TOPICS, base_name

_T = TypeVar('_T')
_NO_JOINTS = f'There is none on topics of type {TOPICS[ROTOR_STATE].type}.'


def can_ask() -> bool:
    """Return whether a person is at a terminal."""
    return sys.stdin.isatty() and sys.stdout.isatty()


def ask(question: str, meaning: Callable[[str], _T]) -> _T:
    """Return the meaning of an answer; where that raises ValueError, say why and ask again.

    Raises ValueError if the input ends, as by Ctrl-D.
    """
    while True:
        try:
            answer = input(question).strip()
        except EOFError as error:
            print()
            raise ValueError('no answer was given, and nothing is written') from error
        try:
            return meaning(answer)
        except ValueError as error:
            complain(error)


def choose_joint(
    joints: Sequence[Channel], given: Channel, role: Literal['rotor', 'output'], hint: str = ''
) -> Channel:
    """Return the joint that is given, the only one on its usual topic, or the one the user names.

    Topic and name are given as far as they are known. `hint` says what else to do where there are
    several joints. Raises ValueError if there is none, or there are several and nobody to ask.
    """
    usual = {'rotor': ROTOR_STATE, 'output': OUTPUT_ENCODER}[role]
    found = _candidates(joints, given, usual)
    if len(found) == 1:
        topic, joint = found[0]
        if role == 'output' and not given.joint and base_name(topic) != usual:
            taken = f'{printable(joint)} on {topic} is taken as the encoder at the output'
            complain(f'{taken}; --encoder-joint names another')
        return found[0]
    if not (found and can_ask()):
        names = [joint.joint for joint in joints]
        question = _no_topic(joints, given.topic) or f'which joint is the {role}?'
        if given.joint and given.joint not in names:
            question = f'no joint {given.joint!r}{nearest(given.joint, names) or "."}'
        there = groupby(found or joints, key=attrgetter('topic'))
        remedy = '; '.join(f'{listed([j.joint for j in on])} on {topic}' for topic, on in there)
        option = {'rotor': '--joint', 'output': '--encoder-joint'}[role]
        remedy = f'Repeat with {option}, and its topic if needed: {printable(remedy)}{hint}'
        raise ValueError(f'{question} {remedy if names else _NO_JOINTS}')
    for number, (topic, joint) in enumerate(found, 1):
        print(f'{number:3}  {printable(joint)} on {topic}')

    def meant(answer: str) -> Channel:
        if answer.isdecimal() and 1 <= int(answer) <= len(found):
            return found[int(answer) - 1]
        if len(named := [joint for joint in found if joint.joint == answer]) == 1:
            return named[0]
        raise ValueError(f'{answer!r} is not a number from 1 to {len(found)}')

    return ask(f'Number of the joint of the {role}{hint}: ', meant)


def joints_of_arm(
    joints: Sequence[Channel], topic: str, names: Sequence[str] = ()
) -> list[Channel]:
    """Return an arm's rotor joints: those named, or all, on the given or only topic with them.

    Raises ValueError if there is no such topic, or it lacks a joint that is named.
    """
    found = _candidates(joints, Channel(topic, ''), ROTOR_STATE)
    known = [joint.joint for joint in found]
    if unknown := [name for name in names if name not in known]:
        raise ValueError(f'no joint {unknown[0]!r}{among(unknown[0], known)}')
    found = [joint for joint in found if not names or joint.joint in names]
    if len(topics := {joint.topic for joint in found}) == 1:
        return found
    there = listed(topics or {joint.topic for joint in joints}) or 'none with joints'
    remedy = f'Repeat with --topic, or remap all drivers to one: {there}'
    question = _no_topic(joints, topic) or 'which topic has the joints of the arm?'
    raise ValueError(f'{question} {remedy}')


def _no_topic(joints: Sequence[Channel], topic: str) -> str:
    """Say that a given topic has no joints, with the nearest one that has; '' if it has some."""
    topic, topics = _full(topic), {joint.topic for joint in joints}
    known = not topic or topic in topics
    return '' if known else f'no joint on {topic}{nearest(topic, sorted(topics)) or "."}'


def _full(topic: str) -> str:
    return topic and f'/{topic.removeprefix("/")}'


def _candidates(joints: Sequence[Channel], given: Channel, base: str) -> list[Channel]:
    """Find the given joints on their usual topic, or else on topics of other packages.

    Other topics of this package count only if something is given.
    """
    topic = _full(given.topic)
    found = [j for j in joints if topic in {'', j.topic} and given.joint in {'', j.joint}]
    usual = [joint for joint in found if base_name(joint.topic) == base]
    others = [joint for joint in found if base_name(joint.topic) not in TOPICS]
    return usual or others or (found if any(given) else [])
