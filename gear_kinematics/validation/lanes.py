"""When something happened on each topic of a recording, for plots."""

from collections.abc import Iterable, Iterator

from gear_kinematics.validation.matching import OutputTopic
from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.recorder import Missing
from gear_kinematics.validation.report import Lane
from gear_kinematics.wire.cdr import SECOND

_Events = Iterator[tuple[str, Occurrences, bool]]
"""What happened, when, and whether the bag fails because of it."""


def lanes(
    rotor: tuple[str, Occurrences, Occurrences],
    outputs: Iterable[tuple[str, OutputTopic, Missing]],
    start: int | None,
) -> Iterator[Lane]:
    """Yield a lane for everything that happened on the topics; none without a start.

    Args:
        rotor: name of the rotor's topic, its gaps and its rejected messages.
        outputs: name, comparison and missing messages of each output.
        start: stamp at the time 0, ns.
    """
    if start is None:
        return
    topic, gaps, rejected = rotor
    yield from _of(topic, iter([('gaps', gaps, False), ('rejected', rejected, False)]), start)
    for name, output, missing in outputs:
        yield from _of(name, _events(output, missing), start)


def _events(output: OutputTopic, missing: Missing) -> _Events:
    yield 'missing', missing.inputs, True
    yield 'extra', output.matcher.extra, True
    yield 'out of order', output.matcher.out_of_order, True
    for errors in output.errors:
        yield f'{errors.name} not finite', errors.non_finite, True
        yield f'{errors.name} absent', errors.absent, True


def _of(topic: str, events: _Events, start: int) -> Iterator[Lane]:
    for event, when, fails in events:
        if when.count:
            spans = [
                ((first - start) / SECOND, (last - start) / SECOND)
                for first, last in when.spans.tolist()
            ]
            yield Lane(topic, event, when.count, spans, fails)
