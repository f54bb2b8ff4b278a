"""The rotor's motion over time, as recorded or at a constant speed."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.fleet import find_topics
from gear_kinematics.kinematics import Mechanism, MotionState, solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.messages import JOINT_STATE, SECOND
from gear_kinematics.rotor_input import InputSettings, RotorInput

Array = NDArray[np.float64]

_BATCH = 8192  # messages


class Trajectory(NamedTuple):
    """The rotor angle φ2 over time; arrays (n,)."""

    time: Array
    """s from the start, increasing."""
    turns: Array
    """Whole turns of the rotor."""
    angle: Array
    """rad: φ2 is 2π turns + angle."""
    velocity: Array
    """rad/s."""

    @classmethod
    def at_constant_speed(cls, speed: float, duration: float, count: int) -> Self:
        """Turn from φ2 = 0.

        Args:
            speed: rad/s.
            duration: s.
            count: of samples, the last one at the end.
        """
        time = np.linspace(0.0, duration, count)
        return cls(time, *split_turns(speed * time), np.full(count, speed))

    def state(self, mechanism: Mechanism) -> MotionState:
        """The motion of all bodies, (n, ...)."""
        return solve(mechanism, self.angle, self.velocity, rotor_turns=self.turns)

    def between(self, start: float, end: float) -> Self:
        """The samples in a part of the time, s."""
        inside = (self.time >= start) & (self.time <= end)
        return self._make(column[inside] for column in self)

    def at(self, time: Array) -> Self:
        """Interpolate linearly."""
        position = np.interp(time, self.time, self.turns * TURN + self.angle)
        return type(self)(
            time, *split_turns(position), np.interp(time, self.time, self.velocity)
        )


def read_trajectory(
    path: Path,
    parameters: Mapping[str, Any],
    rotor_topic: str | None = None,
    progress: Callable[[int, int | None], None] = lambda _count, _total: None,
) -> Trajectory:
    """Read the rotor's topic of a bag, up to where its stamps begin anew, if they do.

    Args:
        path: of the bag.
        parameters: of the node, as `parameters.load` gives them.
        rotor_topic: its name; None: by type and name.
        progress: called with the messages of each batch, and of the whole bag if that is known.

    Returns:
        Where messages have no velocity, it is that of the differences of positions.

    Raises:
        BagError: if the bag cannot be read, or has no states of the rotor at two times.
    """
    messages, received = [], []
    with Bag(path) as bag:
        topic = rotor_topic or find_topics(bag, outputs=False).rotor
        if bag.topics.get(topic) != JOINT_STATE:
            raise BagError(f'{path}: no topic {topic} of type {JOINT_STATE} in it')
        for _, stamp, data in bag.messages([topic]):
            messages.append(data)
            received.append(stamp)
            if len(messages) % _BATCH == 0:
                progress(_BATCH, bag.message_count)
        progress(len(messages) % _BATCH, bag.message_count)
    samples = RotorInput(InputSettings.from_mapping(parameters)).accept_batch(messages, received)
    anew = np.flatnonzero(np.diff(samples.stamp) < 0)
    _, used = np.unique(samples.stamp[: anew[0] + 1 if len(anew) else None], return_index=True)
    if len(used) < 2:  # noqa: PLR2004, what a motion takes
        raise BagError(f'{path}: {topic} has no states of the rotor at two times')
    stamp, turns, angle, velocity, _ = (column[used] for column in samples)
    time = (stamp - stamp[0]) / SECOND
    positions = (turns - turns[0]) * TURN + angle
    velocity = np.where(np.isnan(velocity), np.gradient(positions, time), velocity)
    return Trajectory(time, turns, angle, velocity)
