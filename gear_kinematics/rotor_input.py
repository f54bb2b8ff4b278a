"""From the bytes of a rotor_state message to the rotor's position, and what bad input gets."""

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, Self

from gear_kinematics.kinematics import RotorPosition, RotorTurns
from gear_kinematics.messages import JointState, MalformedMessageError, decode_joint_state

_CLOCK_RESET = 1_000_000_000  # ns: a stamp older by more means a new beginning
_MAX_POSITION = 1e300  # rad


class RejectedInputError(ValueError):
    """A message that gives no output; the text says why and is one of few, to be counted by."""


@dataclass(frozen=True, slots=True)
class InputSettings:
    """How to read the rotor's encoder; the parameters of the same names."""

    rotor_joint: str
    rotor_direction: int
    rotor_zero: float
    rotor_encoder: str
    max_rotor_speed: float
    max_rotor_acceleration: float

    @classmethod
    def from_mapping(cls, parameters: Mapping[str, Any]) -> Self:
        """Pick them from the parameters of the node, by name."""
        return cls(**{field.name: parameters[field.name] for field in fields(cls)})

    @property
    def encoder(self) -> tuple[str, str]:
        """What tells one encoder from another: its joint and its kind."""
        return self.rotor_joint, self.rotor_encoder

    @property
    def single_turn(self) -> bool:
        """Whether the position wraps once a turn."""
        return self.rotor_encoder == 'single_turn'


class RotorSample(NamedTuple):
    """A valid rotor state: the mechanism's angle φ2, its rate and torque."""

    stamp: int
    """ns."""
    position: RotorPosition
    velocity: float | None
    """rad/s; None where the message has none."""
    effort: float | None
    """N·m; None where the message has none."""


class RotorInput:
    """Takes rotor_state messages one by one and keeps account of them."""

    def __init__(self, settings: InputSettings) -> None:
        """Start with no position."""
        self.received = 0
        self.rejected: Counter[str] = Counter()
        self.duplicates = 0
        self.zero_stamps = 0
        self.resets = 0
        self.last: RotorSample | None = None
        self._settings = settings
        self._turns = RotorTurns(
            single_turn=settings.single_turn,
            max_speed=settings.max_rotor_speed,
            max_acceleration=settings.max_rotor_acceleration,
        )

    @property
    def settings(self) -> InputSettings:
        """How the encoder is read; set it at any time. For another encoder it starts anew."""
        return self._settings

    @settings.setter
    def settings(self, settings: InputSettings) -> None:
        self._turns.max_speed = settings.max_rotor_speed
        self._turns.max_acceleration = settings.max_rotor_acceleration
        if settings.encoder != self._settings.encoder:
            self._turns.single_turn = settings.single_turn
            self._turns.reset()
        self._settings = settings

    @property
    def referenced(self) -> bool:
        """Whether the number of the rotor's turns is known."""
        return self._turns.referenced

    def accept(self, data: bytes, now: Callable[[], int]) -> RotorSample:
        """Take the next message.

        Args:
            data: a serialised sensor_msgs/JointState.
            now: the clock, ns, for messages that have no stamp.

        Raises:
            RejectedInputError: if the message gives no output. It is counted.
        """
        self.received += 1
        try:
            return self._accept(data, now)
        except RejectedInputError as rejection:
            self.rejected[str(rejection)] += 1
            raise

    def home(self, rotor_angle: float) -> float:
        """Declare that the rotor angle is `rotor_angle` now; returns the new `rotor_zero`.

        Raises:
            RuntimeError: before the first valid message.
        """
        return self._turns.home(rotor_angle, self._settings.rotor_direction)

    def _accept(self, data: bytes, now: Callable[[], int]) -> RotorSample:
        try:
            message = decode_joint_state(data)
        except MalformedMessageError as error:
            raise RejectedInputError('not a JointState') from error
        index = self._index(message)
        if index >= len(message.position):
            raise RejectedInputError('position missing')
        position = message.position[index]
        # NaN compares false; beyond the bound the output angle might not be finite any more.
        if not abs(position) <= _MAX_POSITION:
            raise RejectedInputError('position not finite')
        stamp = message.stamp
        if stamp == 0:
            stamp = now()
            self.zero_stamps += 1
        self._check_order(stamp)
        velocity = _finite_or_none(message.velocity, index)
        effort = _finite_or_none(message.effort, index)
        self._turns.update(position, stamp, velocity)
        direction = self._settings.rotor_direction
        self.last = RotorSample(
            stamp,
            self._turns.relative_to(self._settings.rotor_zero, direction),
            None if velocity is None else direction * velocity,
            None if effort is None else direction * effort,
        )
        return self.last

    def _index(self, message: JointState) -> int:
        joint = self._settings.rotor_joint
        if joint:
            try:
                return message.names.index(joint.encode())
            except ValueError:
                raise RejectedInputError('joint missing') from None
        if len(message.names) != 1:
            raise RejectedInputError('joint missing')
        return 0

    def _check_order(self, stamp: int) -> None:
        if self.last is None or stamp > self.last.stamp:
            return
        if stamp == self.last.stamp:
            self.duplicates += 1
        elif self.last.stamp - stamp <= _CLOCK_RESET:
            raise RejectedInputError('out of order')
        else:
            self.resets += 1
            self._turns.reset()


def _finite_or_none(values: tuple[float, ...], index: int) -> float | None:
    if index < len(values) and math.isfinite(values[index]):
        return values[index]
    return None
