"""Checks of a recording beyond the errors of the fields.

A new check is a class derived from `Check` and an entry in `CHECKS`; CONTRIBUTING.md has an
example.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from numpy.typing import NDArray

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.report import Finding, InputReport

Columns = Mapping[str, NDArray[Any]]


class Check:
    """Looks at a recording batch by batch and judges it at the end."""

    def __init__(self, parameters: NodeParameters) -> None:
        """Start with a recording.

        Args:
            parameters: of the node.
        """
        self.parameters = parameters

    def update(self, output: Columns, poses: Columns) -> None:
        """Process the compared messages of a batch.

        Args:
            output: of output_state: `stamp` (ns), `rotor_angle`, `output_angle` as recorded and
                `error` (rad), each (n,).
            poses: of body_poses: `stamp` (ns) and `error` of the position (m), each (n,).
        """

    def judge(self, rotor: InputReport) -> Iterator[Finding]:
        """Yield the findings about the whole recording."""
        raise NotImplementedError


class MostlyRejected(Check):
    """Fails a bag if the node rejects most of its inputs."""

    def judge(self, rotor: InputReport) -> Iterator[Finding]:
        """Yield the causes of rejection."""
        rejected = sum(rotor.rejected.values())
        if 2 * rejected > rotor.messages:
            causes = ', '.join(f'{cause} {count}' for cause, count in rotor.rejected.items())
            yield Finding(
                f'{rejected} of {rotor.messages} messages of {rotor.topic} were rejected '
                f'({causes}): too few are left to pass',
                fails=True,
            )


class InputCounts(Check):
    """Explains the counts of the input that are not 0."""

    def judge(self, rotor: InputReport) -> Iterator[Finding]:
        """Yield a sentence for each count."""
        for count, sentence in _SENTENCES.items():
            if getattr(rotor, count):
                yield Finding(sentence.format(rotor=rotor))


_SENTENCES = {
    'jumps': '{rotor.jumps} gaps of {rotor.topic} could hide a turn of the single-turn encoder: '
    'after each, its turns are taken from the outputs',
    'overspeed': '{rotor.overspeed} steps of {rotor.topic} are faster than max_rotor_speed, at '
    'most {rotor.max_speed:.4g} rad/s',
    'zero_stamps': '{rotor.zero_stamps} messages of {rotor.topic} have no stamp: the node stamped '
    'their outputs itself, and they cannot be matched',
    'unnormalised_stamps': '{rotor.unnormalised_stamps} stamps of {rotor.topic} have a second or '
    'more of nanoseconds: the node stamps outputs with the same time, normalised',
}
"""Sentences by the names of the counts in `InputReport`."""

CHECKS: Sequence[Callable[[NodeParameters], Check]] = (MostlyRejected, InputCounts)
