"""What the node says of its rotor input once a second, without ROS."""

from collections import Counter
from dataclasses import dataclass, field

from gear_kinematics.kinematics import Mechanism, loop_closure, solve
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.rotor_input import RotorInput

OK, WARN, ERROR = 0, 1, 2
"""Levels of diagnostic_msgs/DiagnosticStatus."""


@dataclass(frozen=True, slots=True)
class Report:
    """One status: its level, its message, and values by name."""

    level: int
    message: str
    values: dict[str, str]


@dataclass(slots=True)
class InputMonitor:
    """Watches the rotor input; times are of a steady clock, s."""

    started: float
    published: int = 0
    drivers: int = 0
    """Publishers on rotor_state."""
    lost: int = 0
    """Inputs that the middleware knows it did not deliver."""
    unsent: int = 0
    """Messages that the middleware did not take."""
    last_input: float | None = None
    """When the last message came, valid or not."""
    incompatible_qos: dict[str, str] = field(default_factory=dict)
    """The offending policy by topic, as long as the node runs."""
    _reported: float = 0.0
    _received: int = 0
    _lost: int = 0
    _unsent: int = 0
    _rejected: Counter[str] = field(default_factory=Counter)

    def report(
        self, rotor_input: RotorInput, mechanism: Mechanism, timeout: float, now: float
    ) -> Report:
        """Report on the time since the last report.

        Args:
            rotor_input: the input to report on.
            mechanism: for the loop-closure residual at the last sample.
            timeout: s without input, after which it is an error.
            now: s.
        """
        elapsed = now - max(self._reported, self.started)
        rate = (rotor_input.received - self._received) / elapsed if elapsed > 0.0 else 0.0
        newly_rejected = rotor_input.rejected - self._rejected
        self._reported, self._received = now, rotor_input.received
        self._rejected = Counter(rotor_input.rejected)
        newly_lost, self._lost = self.lost - self._lost, self.lost
        newly_unsent, self._unsent = self.unsent - self._unsent, self.unsent

        age = now - (self.started if self.last_input is None else self.last_input)
        errors, warnings = [], []
        if age > timeout:
            errors.append(f'no input for {age:.1f} s')
        if not rotor_input.referenced:
            errors.append('not referenced')
        for topic, policy in self.incompatible_qos.items():
            errors.append(f'incompatible QoS on {topic}: {policy}')
        if newly_rejected:
            causes = ', '.join(f'{cause} {count}' for cause, count in newly_rejected.items())
            warnings.append(f'rejected: {causes}')
        if newly_lost:
            warnings.append(f'lost {newly_lost}')
        if newly_unsent:
            warnings.append(f'not sent {newly_unsent}')
        if self.drivers > 1:
            warnings.append(f'{self.drivers} drivers')
        level = ERROR if errors else WARN if warnings else OK
        values = {
            'rate (Hz)': f'{rate:.1f}',
            'received': str(rotor_input.received),
            'published': str(self.published),
            **{f'rejected: {cause}': str(n) for cause, n in sorted(rotor_input.rejected.items())},
            'lost messages': str(self.lost),
            'not sent': str(self.unsent),
            'drivers': str(self.drivers),
            'duplicate stamps': str(rotor_input.duplicates),
            'zero stamps': str(rotor_input.zero_stamps),
            'clock resets': str(rotor_input.resets),
            'age of last input (s)': 'none' if self.last_input is None else f'{age:.3f}',
            'referenced': str(rotor_input.referenced).lower(),
            'loop-closure residual (m)': _residual(rotor_input, mechanism),
        }
        return Report(level, '; '.join(errors + warnings) or 'ok', values)


def _residual(rotor_input: RotorInput, mechanism: Mechanism) -> str:
    if rotor_input.last is None:
        return 'none'
    turns, angle = rotor_input.last.position
    # The poses repeat after the numerator's number of rotor turns, a small and exact angle.
    rotor_angle = TURN * (turns % mechanism.gear_ratio.numerator) + angle
    state = solve(mechanism, rotor_angle)
    return f'{loop_closure.residual(mechanism, rotor_angle, state).max():.3g}'
