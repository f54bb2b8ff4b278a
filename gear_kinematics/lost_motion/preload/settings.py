"""The settings of the preload at which recordings were made, by their names."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from gear_kinematics.kinematics import Gear, Mechanism, vernier
from gear_kinematics.lost_motion.recorded.encoder_step import UNITS

DEFAULT_PATTERNS = (
    r'pins?[_ -](\d+)[_ -](\d+)[_ -](\d+)',
    r'(?:preload|setting|turn|pre)[_ -]?(\d+(?:\.\d+)?)',
)
"""Such as pins_0_78_1 (tooth, ring hole, chassis hole), preload_2 or turn_0.15."""
_PINS = 3


@dataclass(frozen=True, slots=True)
class Scale:
    """What a setting is."""

    unit: str
    """In which settings are shown; empty for plain numbers."""
    size: float
    """rad; 1 for plain numbers."""
    play: float | None
    """rad of play that a turn of the ring gear by 1 rad closes; None for plain numbers."""


def settings_of(
    names: Sequence[str], pattern: str, unit: str | None, gear: Gear
) -> tuple[list[float], Scale]:
    """Read the settings in names.

    Args:
        names: of the recordings.
        pattern: a regular expression with one group in parentheses, the setting, or three: tooth,
            ring hole and chassis hole. Empty: the first default pattern that all names match.
        unit: of a turn of the ring gear, a key of UNITS; None for plain numbers and pins.
        gear: turns of the ring gear need its teeth.

    Returns:
        Settings, plain numbers or turns of the ring gear in rad.

    Raises:
        ValueError: if names contain no settings, or if the teeth are not known.
    """
    patterns = (pattern,) if pattern else DEFAULT_PATTERNS
    found = next(filter(None, (_matches(names, text) for text in patterns)), None)
    if found is None:
        without = next(n for n in names if not any(re.search(text, n) for text in patterns))
        raise ValueError(f'--preloads: there is no setting in the name {without}')
    pinned = len(found[0]) == _PINS
    if not pinned and unit is None:
        return [float(text) for (text,) in found], Scale('', 1.0, None)
    if not isinstance(gear, Mechanism):
        raise ValueError('--preloads: turns of a ring gear need its teeth')  # noqa: TRY004
    scale = Scale(unit or 'deg', UNITS[unit or 'deg'], gear.ring_teeth / gear.satellite_teeth)
    if not pinned:
        return [float(text) * scale.size for (text,) in found], scale
    start = vernier.pin_setting(gear.ring_teeth, 0, 0, 0)
    pins = [vernier.pin_setting(gear.ring_teeth, *map(int, holes)) for holes in found]
    return [abs(vernier.angle_between(start.turn, pin.turn)) for pin in pins], scale


def _matches(names: Sequence[str], pattern: str) -> list[tuple[str, ...]] | None:
    """The groups of a pattern in all names; None if one does not match."""
    try:
        expression = re.compile(pattern)
    except re.error as error:
        raise ValueError(f'--preloads {pattern}: {error}') from error
    if expression.groups not in {1, _PINS}:
        raise ValueError(
            f'--preloads {pattern}: a regular expression needs one group in parentheses, or three '
            f'for pins, not {expression.groups}'
        )
    matches = [expression.search(name) for name in names]
    found = [match.groups('') for match in matches if match]
    if len(found) < len(names):
        return None
    if bad := next((text for groups in found for text in groups if not _is_number(text)), None):
        raise ValueError(f'--preloads {pattern}: {bad!r} is no setting')
    return found


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False
