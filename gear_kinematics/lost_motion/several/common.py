"""The figures of several recordings at one common torque, so that they can be compared."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from gear_kinematics.lost_motion.report import HysteresisReport, LostMotionReport
from gear_kinematics.lost_motion.static import hysteresis
from gear_kinematics.lost_motion.static.hysteresis import STIFFNESS_SHARES, Figures
from gear_kinematics.lost_motion.wording import ARC_MINUTES, play, rate_and_duration, torque
from gear_kinematics.state.uncertainty import Estimate

LOST_MOTION = 'lost motion'
"""Name of that of ramps."""
_ALIKE = 1.5
"""Ratio up to which the amplitudes of ramps may differ for their figures to be compared."""
_NAMED = 3
"""Most recordings that a sentence names."""
_CLOSE = 1.02
"""Ratio up to which an amplitude counts as reached."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """One figure of several recordings."""

    name: str
    unit: str
    scale: float
    """Of the unit, per SI unit."""
    values: tuple[Estimate | None, ...]
    """One per recording, SI; None where it has no such figure."""
    relative: bool = False
    """Whether changes are told in percent."""


def at_common_torque(
    reports: Sequence[LostMotionReport],
    rated_torque: float | None,
    corners: Sequence[float] | None,
) -> list[LostMotionReport]:
    """Take the figures of all recordings at one rated torque, over the same ranges of torque.

    Args:
        reports: with or without ramps.
        rated_torque: N·m; None: the least of those of the recordings.
        corners: N·m, between ranges of stiffness; None: shares of the rated torque.
    """
    found = [report.hysteresis for report in reports if report.hysteresis]
    if len(found) < 2:  # noqa: PLR2004, nothing to compare
        return list(reports)
    rated = rated_torque or min(ramps.settings.rated_torque for ramps in found)
    reach = _reach(found, rated)
    limits = corners or [share * rated for share in STIFFNESS_SHARES]
    limits = (*sorted(limit for limit in limits if limit < reach), reach)

    def again(ramps: HysteresisReport) -> HysteresisReport:
        settings = replace(ramps.settings, rated_torque=rated, corners=limits)
        return replace(
            ramps,
            settings=settings,
            rated_by='given' if rated_torque else 'least of the recordings',
            figures=hysteresis.figures(
                ramps.ramps, settings, [figures.play_model for figures in ramps.figures]
            ),
        )

    return [
        replace(report, hysteresis=again(report.hysteresis)) if report.hysteresis else report
        for report in reports
    ]


def _reach(found: Sequence[HysteresisReport], rated: float) -> float:
    """Greatest torque up to the rated one that all recordings reach, N·m."""
    return min(rated, *(ramps.largest.amplitude for ramps in found))


@dataclass(frozen=True, eq=False, slots=True)
class Basis:
    """The ramps on which several recordings are compared; None where a recording has none."""

    least: float
    """N·m, amplitude of those for hysteresis, backlash and friction."""
    reach: float
    """N·m, up to which lost motion and stiffness are compared."""
    small: tuple[int | None, ...]
    """Numbers of the ramps of each recording with about the least amplitude."""
    loaded: tuple[int | None, ...]
    """Numbers of the smallest ramps that reach `reach`."""


def basis(reports: Sequence[LostMotionReport]) -> Basis | None:
    """Choose the ramps of recordings at a common torque; None if none has ramps."""
    found = [report.hysteresis for report in reports]
    known = [ramps for ramps in found if ramps]
    if not known:
        return None
    least = max(ramps.smallest.amplitude for ramps in known)
    reach = _reach(known, known[0].settings.rated_torque)
    return Basis(
        least,
        reach,
        tuple(_like(ramps, least) if ramps else None for ramps in found),
        tuple(_loaded(ramps, reach) if ramps else None for ramps in found),
    )


def quantities(reports: Sequence[LostMotionReport], common: Basis | None) -> list[Quantity]:
    """Return what can be compared among recordings at a common torque, at least two each."""
    listed: list[Quantity] = []
    if common:
        small, loaded = chosen(reports, common.small), chosen(reports, common.loaded)
        listed += [
            _angle('hysteresis', small, lambda figures: figures.hysteresis),
            backlash(reports, common),
            _of(small, lambda figures: figures.friction, 'friction', 'N·m'),
            _angle(LOST_MOTION, loaded, lambda figures: figures.lost_motion),
            *(_stiffness(loaded, low, high) for low, high in _ranges(loaded, common.reach)),
        ]
    listed += [
        _transmission(reports, 'lost motion on reversals', 'lost_motion'),
        _transmission(reports, 'transmission accuracy', 'forward'),
    ]
    return [q for q in listed if sum(value is not None for value in q.values) > 1]


def backlash(reports: Sequence[LostMotionReport], common: Basis) -> Quantity:
    """Return the backlash of recordings at a common torque, where it has a value."""
    return _angle('backlash', leaving(reports, common), lambda figures: figures.play)


def doubts(reports: Sequence[LostMotionReport], common: Basis) -> list[str]:
    """Say in sentences which recordings can be compared with others in part only."""
    said = [
        f'{report.recording.name} has no ramps to about {torque(common.least)} N·m, on which '
        'others are compared: hysteresis, backlash and friction depend on the amplitude, and are '
        'left out.'
        for report, place in zip(reports, common.small, strict=True)
        if report.hysteresis and place is None
    ]
    loaded = chosen(reports, common.loaded)
    wider = [
        report.recording.name
        for report, figures in zip(reports, loaded, strict=True)
        if figures and figures.amplitude > _ALIKE * common.reach
    ]
    if wider:
        said.append(
            f'Lost motion and stiffness are compared up to {torque(common.reach)} N·m, to which '
            f'all recordings load the gear. {_listed(wider)} went much further: that widens a '
            'curve.'
        )
    everything = range(len(reports))
    if unknown := without_play(reports, common, everything):
        listed = ', '.join(f'{name} ({found})' for name, found in unknown)
        said.append(f'Backlash is not compared where it has no value, in arcmin: {listed}.')
    return [*said, *rate_doubts(reports, common, everything)]


def without_play(
    reports: Sequence[LostMotionReport], common: Basis, members: Sequence[int]
) -> list[tuple[str, str]]:
    """Return which recordings of some, by number, have no value of backlash, and what instead."""
    found = leaving(reports, common)
    return [
        (reports[number].recording.name, play(figures.play_model))
        for number in members
        if (figures := found[number]) and figures.play_model and not figures.play
    ]


def rate_doubts(
    reports: Sequence[LostMotionReport], common: Basis, members: Sequence[int]
) -> list[str]:
    """Say in sentences which recordings of some, by number, had much faster or slower ramps."""
    said: list[str] = []
    for places, figures in (
        (common.small, 'hysteresis, backlash and friction'),
        (common.loaded, 'lost motion and stiffness'),
    ):
        found = [
            (rate, reports[number].recording.name)
            for number in members
            if (ramps := reports[number].hysteresis)
            and (place := places[number]) is not None
            and (rate := ramps.rates[place])
        ]
        if not found:
            continue
        slowest, fastest = (way(found, key=lambda pair: pair[0].rate) for way in (min, max))
        if fastest[0].differs_from(slowest[0]):
            said.append(
                f'The ramps for {figures} were not equally fast: {slowest[1]} with '
                f'{rate_and_duration(slowest[0])}, {fastest[1]} with '
                f'{rate_and_duration(fastest[0])}. These figures can differ by the rate alone.'
            )
    return said


def _listed(names: Sequence[str]) -> str:
    more = f' and {len(names) - _NAMED} more' if len(names) > _NAMED else ''
    return ', '.join(names[:_NAMED]) + more


def highest_range(loaded: Sequence[Figures | None], reach: float) -> tuple[float, float]:
    """Return the highest range of stiffness, N·m; zeros if there is none clear of zero."""
    return max(_ranges(loaded, reach), default=(0.0, 0.0))


def chosen(
    reports: Sequence[LostMotionReport], places: Sequence[int | None]
) -> list[Figures | None]:
    """Return the figures of the ramps with these numbers."""
    return [
        report.hysteresis.figures[place] if report.hysteresis and place is not None else None
        for report, place in zip(reports, places, strict=True)
    ]


def leaving(reports: Sequence[LostMotionReport], common: Basis) -> list[Figures | None]:
    """Return the figures of the small ramps, or where these stay within the backlash, larger."""
    return [
        report.hysteresis.leaving if report.hysteresis and figures and figures.within else figures
        for report, figures in zip(reports, chosen(reports, common.small), strict=True)
    ]


def _like(ramps: HysteresisReport, amplitude: float) -> int | None:
    """Number of the ramps nearest to an amplitude."""
    ratios = [max(f.amplitude / amplitude, amplitude / f.amplitude) for f in ramps.figures]
    nearest = min(ratios)
    return ratios.index(nearest) if nearest <= _ALIKE else None


def _loaded(ramps: HysteresisReport, reach: float) -> int | None:
    """Number of the smallest ramps that reach a torque."""
    reaching = (k for k, f in enumerate(ramps.figures) if f.amplitude * _CLOSE >= reach)
    return next(reaching, None)


def _ranges(loaded: Sequence[Figures | None], reach: float) -> list[tuple[float, float]]:
    """Ranges of stiffness that exclude zero torque, and with it the play."""
    return sorted(
        {
            (stiffness.low, stiffness.high)
            for figures in loaded
            if figures
            for stiffness in figures.stiffness
            if stiffness.low > 0.0 and stiffness.high <= reach
        }
    )


def _stiffness(loaded: Sequence[Figures | None], low: float, high: float) -> Quantity:
    def of(figures: Figures) -> Estimate | None:
        same = (s.both for s in figures.stiffness if (s.low, s.high) == (low, high))
        return next(same, None)

    return _of(loaded, of, f'stiffness {torque(low)} to {torque(high)} N·m', 'N·m/rad')


def _of(
    found: Sequence[Figures | None],
    figure: Callable[[Figures], Estimate | None],
    name: str,
    unit: str,
) -> Quantity:
    values = tuple(figure(figures) if figures else None for figures in found)
    return Quantity(name, unit, 1.0, values, relative=True)


def _angle(
    name: str,
    found: Sequence[Figures | None],
    figure: Callable[[Figures], Estimate | None],
) -> Quantity:
    values = tuple(figure(figures) if figures else None for figures in found)
    return Quantity(name, 'arcmin', ARC_MINUTES, values)


def _transmission(reports: Sequence[LostMotionReport], name: str, figure: str) -> Quantity:
    values = tuple(
        getattr(report.transmission, figure) if report.transmission else None for report in reports
    )
    return Quantity(name, 'arcmin', ARC_MINUTES, values)
