"""The settings of the preload at which recordings were made, by their names."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from gear_kinematics.kinematics import Gear, Mechanism, vernier
from gear_kinematics.measurement.comparison import expression
from gear_kinematics.measurement.encoder_step import UNITS

DEFAULT_PATTERNS = (
    r'pins?[_ -](\d+)[_ -](\d+)[_ -](\d+)',
    r'(?:preload|setting|turn|pre)[_ -]?(\d+(?:\.\d+)?)',
)
"""Such as pins_0_78_1 (tooth, ring hole, chassis hole), preload_2 or turn_0.15."""
_PINS = 3
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,2})?', re.IGNORECASE)


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
    needed = 'one group in parentheses, or three for pins'
    patterns = [re.compile(own) for own in DEFAULT_PATTERNS]
    if pattern:
        patterns = [expression('--preloads', pattern, needed, (1, _PINS))]
    matches = [[own.search(name) for name in names] for own in patterns]
    complete = next((found for found in matches if all(found)), None)
    if complete is None:
        without = next(n for n in names if not any(e.search(n) for e in patterns))
        raise ValueError(f'--preloads: there is no setting in the name {without}')
    found = [match.groups('') for match in complete if match]
    if bad := next((t for groups in found for t in groups if not _NUMBER.fullmatch(t)), None):
        raise ValueError(f'--preloads {pattern}: {bad!r} is no setting')
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
