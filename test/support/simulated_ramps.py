# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Torque ramps of gears that are known, stepped through time, and how often their figures hold.

The load on the spring is the state: friction holds it until the torque differs from it by more
than the friction, and then lets it follow just so far. Play is a step of the spring's curve. Gears
with inertia move by Newton's law instead, and speed up in their play. All gears of a scenario step
together: their figures are arrays (gears,), and what is recorded of them arrays (time, gears).
No simulation uses anything under test.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.figures import GearFigures, gear_figures
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.statistics.uncertainty import Estimate

INTERVAL = 2.5e-3  # s
STEP = 2.0 * math.pi / 65536.0  # rad, of the encoder
SMALL, LARGE = 4.0, 40.0  # N·m
_CORNERS = np.array([0.0, 1.0, 1.0, -1.0, -1.0, 0.0])
"""Torque at the corners of a loop, in units of its amplitude, with pauses at its peaks."""
_REPEATS = 100
"""Recordings whose mean is the hysteresis of a gear."""

Value = float | np.ndarray
"""A property of one gear, or of each of many, (gears,)."""
Loops = tuple[tuple[float, float], ...]
"""Amplitude, N·m, and duration, s, of the loops of a recording."""
SMALL_AND_LARGE: Loops = 5 * ((SMALL, 4.0),) + 3 * ((LARGE, 20.0),)
LARGE_ONLY: Loops = 5 * ((LARGE, 20.0),)

Spring = Callable[[np.ndarray], np.ndarray]
"""Twist, rad, under a load, N·m, of either sign, without the play."""


def linear(load: np.ndarray) -> np.ndarray:
    return load / 300.0


def softening(load: np.ndarray) -> np.ndarray:
    """600 N·m/rad at no load, and softer the larger the load."""
    return load / 600.0 + np.sign(load) * (load / 110.0) ** 2


def hardening(load: np.ndarray) -> np.ndarray:
    """150 N·m/rad at no load, 600 N·m/rad far above 5 N·m."""
    return load / 600.0 + 0.025 * np.tanh(load / 5.0)


def hertzian(load: np.ndarray) -> np.ndarray:
    """As of two bodies in contact: no stiffness at no load."""
    return np.sign(load) * 0.02 * (np.abs(load) / 10.0) ** (2.0 / 3.0)


def soft_middle(load: np.ndarray) -> np.ndarray:
    """60 N·m/rad within 1 N·m, as of tooth flanks that are not yet fully in contact."""
    return load / 300.0 + 0.0133 * np.tanh(load)


@dataclass(frozen=True)
class Scenario:
    """A gear and its sensors; angles in rad at the output."""

    name: str
    contained: bool = True
    """Whether a middle line with a straight or a smoothly bent spring describes it."""
    play: Value = 0.0
    spring: Spring = linear
    softness: Value = 1.0
    """Factor of its twist."""
    friction: Value = 1.0
    """N·m."""
    load_friction: Value = 0.0
    """Share of the load that adds to it."""
    creeps: tuple[tuple[Value, Value], ...] = ()
    """Share of the twist, and time constant, s, of each."""
    bristle: Value = 0.0
    """N·m over which friction builds up after a reversal."""
    slip: Value = 0.0
    """Share of the friction by which it falls once the gear moves (stick-slip)."""
    inertia: Value = 0.0
    """kg·m², at the output."""
    damping: Value = 0.0
    """N·m·s/rad; of gears with inertia."""
    drift: Value = 0.0
    """rad/s, of the encoder."""
    thermal: tuple[Value, Value] = (0.0, 60.0)
    """Amplitude, rad, and period, s, of a wandering zero."""
    lag: Value = 0.0
    """s, by which the readings of the encoder are late."""
    pause: Value = 0.0
    """Share of the time for which the torque stays at its peaks."""
    noise: Value = 0.1
    """N·m, of the torque sensor."""
    repeat: Value = 0.01
    """Relative scatter of the friction from loop to loop."""
    loops: Loops = SMALL_AND_LARGE
    """Those of the first amplitude are judged."""

    def twist(self, load: np.ndarray) -> np.ndarray:
        """Twist of the spring under a load, N·m, without the play, rad."""
        return self.softness * self.spring(load)


SCENARIOS = (
    Scenario('play, linear spring', play=0.02),
    Scenario('little play, linear spring', play=0.003),
    Scenario('no play, linear spring'),
    Scenario('no play, softening spring', spring=softening),
    Scenario('no play, hardening spring', spring=hardening),
    Scenario('play, softening spring', play=0.01, spring=softening),
    Scenario('play, hardening spring', play=0.01, spring=hardening),
    Scenario('creep of 10 %', play=0.01, creeps=((0.1, 5.0),)),
    Scenario('slow creep of 10 %', play=0.01, creeps=((0.1, 20.0),)),
    Scenario('friction that grows by 10 % of the load', play=0.01, load_friction=0.1),
    Scenario('drift', play=0.01, drift=3e-5),
    Scenario('thermal sine', play=0.01, thermal=(1e-3, 60.0)),
    Scenario('encoder 20 ms late', play=0.01, lag=0.02),
    Scenario('encoder 20 ms late, pauses', play=0.01, lag=0.02, pause=0.5),
    Scenario('creep of 10 %, pauses', play=0.01, creeps=((0.1, 5.0),), pause=0.5),
    Scenario('creep of 10 %, large loops only', play=0.01, creeps=((0.1, 5.0),), loops=LARGE_ONLY),
    Scenario(
        'play, hardening spring, large loops only', play=0.01, spring=hardening, loops=LARGE_ONLY
    ),
    Scenario('no play, Hertzian spring', spring=hertzian),
    Scenario('play, Hertzian spring', play=0.01, spring=hertzian),
    Scenario('soft middle', spring=soft_middle),
    Scenario('creep with two times', play=0.01, creeps=((0.05, 1.0), (0.08, 20.0))),
    Scenario('creep, softening spring', play=0.01, spring=softening, creeps=((0.1, 5.0),)),
    Scenario('friction that builds up', play=0.01, bristle=0.5),
    Scenario('stick-slip', contained=False, play=0.01, slip=0.3),
    Scenario(
        'creep, drift and growing friction',
        play=0.01,
        creeps=((0.05, 5.0),),
        load_friction=0.05,
        drift=2e-5,
    ),
    Scenario('inertia, no play', contained=False, inertia=0.01, damping=0.5),
    Scenario('inertia, play', contained=False, play=0.01, inertia=0.01, damping=0.5),
)


def drawn(
    scenario: Scenario, count: int, random: np.random.Generator, spread: float = 1.0
) -> Scenario:
    """Draw gears and their sensors: each figure is that of the scenario or up to twice or half."""

    def about(value: float) -> np.ndarray:
        return value * 2.0 ** random.uniform(-spread, spread, count)

    friction = about(scenario.friction)
    return replace(
        scenario,
        play=about(scenario.play),
        softness=about(1.0),
        friction=friction,
        load_friction=about(scenario.load_friction),
        creeps=tuple((about(share), about(constant)) for share, constant in scenario.creeps),
        bristle=about(scenario.bristle) * friction,
        slip=about(scenario.slip),
        inertia=about(scenario.inertia),
        damping=about(scenario.damping),
        drift=about(scenario.drift) * random.choice([-1.0, 1.0], count),
        thermal=(about(scenario.thermal[0]), about(scenario.thermal[1])),
        lag=about(scenario.lag),
        noise=about(scenario.noise),
        repeat=about(scenario.repeat),
    )


class Ramps(NamedTuple):
    """Recordings of a gear, or of many."""

    time: np.ndarray
    """(time,), s."""
    torque: np.ndarray
    """(time, gears), N·m, measured; (time,) of one gear."""
    angle: np.ndarray
    """(time, gears), rad, measured; (time,) of one gear."""


def hysteresis(scenario: Scenario) -> Value:
    """Return the hysteresis of the first amplitude by definition, without the errors of sensors.

    It is the mean over many recordings, as the steps of stick-slip lie elsewhere in each.
    """
    first = tuple(loop for loop in scenario.loops if loop == scenario.loops[0])
    repeats = (_REPEATS, *np.shape(scenario.friction))
    if _is_timeless(scenario):
        first = tuple((amplitude, 4.0 * INTERVAL) for amplitude, _ in first)
    rows = round(first[0][1] / INTERVAL)
    motion = _motion(replace(scenario, loops=first), repeats, np.random.default_rng(0))
    at_zero = [angle for row, angle in enumerate(motion) if row % (rows // 2) == 0]
    falls, rises = at_zero[3::2], at_zero[4::2]  # after the first loop
    return np.mean(np.subtract(falls, rises), axis=(0, 1))


def simulate(scenario: Scenario, random: np.random.Generator) -> Ramps:
    """Record each gear of a scenario."""
    time, torque = _torque(scenario)
    shape = np.shape(scenario.friction)
    angle = np.array(list(_motion(scenario, shape, random)))
    size, period = scenario.thermal
    phase = random.uniform(-np.pi, np.pi, shape)
    angle += np.multiply.outer(time, scenario.drift)
    angle += size * np.sin(2.0 * np.pi * np.divide.outer(time, period) + phase)
    for gear, lag in np.ndenumerate(scenario.lag):
        angle[:, *gear] = np.interp(time - lag, time, angle[:, *gear])
    zero = random.uniform(0.0, STEP, shape)
    noise = scenario.noise * random.standard_normal(angle.shape)
    return Ramps(time, (noise.T + torque).T, np.round((angle + zero) / STEP) * STEP)


def _torque(s: Scenario) -> tuple[np.ndarray, np.ndarray]:
    parts = []
    for amplitude, duration in s.loops:
        quarter = round(0.25 * duration / INTERVAL)
        still = round(s.pause * quarter)
        times = quarter * np.array([0, 1, 1, 3, 3, 4]) + still * np.array([0, -1, 1, -1, 1, 0])
        parts.append(np.interp(np.arange(4 * quarter), times, amplitude * _CORNERS))
    torque = np.concatenate([*parts, [0.0]])
    return INTERVAL * np.arange(len(torque)), torque


def _motion(
    s: Scenario, shape: tuple[int, ...], random: np.random.Generator
) -> Iterator[np.ndarray]:
    """Yield the angles, of a shape (..., gears), without the errors of the encoder."""
    _, torque = _torque(s)
    rows = [round(duration / INTERVAL) for _, duration in s.loops]
    loop = np.append(np.repeat(np.arange(len(rows)), rows), len(rows) - 1)
    strength = s.friction * (1.0 + s.repeat * random.standard_normal((len(s.loops), *shape)))
    if np.any(s.inertia):
        yield from _moved(s, torque, strength[loop])
        return
    if _is_timeless(s):
        loads = _held(torque, loop, strength)
        yield from s.twist(loads) + 0.5 * s.play * np.sign(loads)
        return
    load = np.zeros(shape)
    built = np.zeros(shape)  # N·m, friction that has built up, with its sign
    late = np.zeros((len(s.creeps), *shape))
    creeps = [(share, -np.expm1(-INTERVAL / constant)) for share, constant in s.creeps]
    builds_up, changes = np.any(s.bristle), np.any(s.load_friction) or np.any(s.slip)
    for k, applied in enumerate(torque):
        fresh = strength[loop[k]]
        held = fresh + s.load_friction * np.abs(load)
        if builds_up:
            load, built = _bristles(applied, load, built, held, s.bristle)
        elif changes:
            net = applied - load
            moves = np.abs(net) > held
            sliding = held * (1.0 - s.slip)
            # A load that grows makes its own friction grow.
            towards = np.sign(net)
            growing = towards * np.sign(applied - towards * sliding) * s.load_friction
            fresh = fresh * (1.0 - s.slip)
            load = np.where(moves, (applied - towards * fresh) / (1.0 + growing), load)
        else:
            load = np.minimum(np.maximum(load, applied - held), applied + held)
        twist = s.twist(load)
        for j, (share, gain) in enumerate(creeps):
            late[j] += (share * twist - late[j]) * gain
        yield twist + 0.5 * s.play * np.sign(load) + late.sum(axis=0)


def _is_timeless(s: Scenario) -> bool:
    """Say whether Coulomb friction alone acts, so that only the turns of the torque matter."""
    return not (s.creeps or any(map(np.any, (s.inertia, s.bristle, s.load_friction, s.slip))))


def _held(torque: np.ndarray, loop: np.ndarray, strength: np.ndarray) -> np.ndarray:
    """Hold the load within the friction of the torque: (time, ..., gears), N·m."""
    turns = np.flatnonzero(np.diff(np.sign(np.diff(torque)))) + 2  # a way ends at its peak
    starts = np.union1d(turns, np.flatnonzero(np.diff(loop)) + 1)
    loads = np.zeros((len(torque), *strength.shape[1:]))
    for way in np.split(np.arange(len(torque)), starts):
        friction = strength[loop[way[0]]]
        applied = torque[way].reshape(-1, *[1] * friction.ndim)
        loads[way] = np.clip(loads[way[0] - 1], applied - friction, applied + friction)
    return loads


def _moved(s: Scenario, torque: np.ndarray, strength: np.ndarray) -> Iterator[np.ndarray]:
    """Angles of gears with inertia, and friction by Haessig and Friedland's bristles."""
    substeps, bristle = 10, 2e4  # N·m/rad
    step = INTERVAL / substeps
    damping = s.damping + np.sqrt(bristle * s.inertia)  # of the bristles as well
    loads = np.linspace(0.0, 1.5 * LARGE, 120001)
    twists = s.spring(loads)
    angle, speed, bent = np.zeros((3, *strength.shape[1:]))
    for k, most in enumerate(strength / bristle):
        yield angle
        ahead = np.interp(k + np.arange(substeps) / substeps, np.arange(len(torque)), torque)
        for applied in ahead:
            before = bent
            bent = np.clip(bent + step * speed, -most, most)
            sticking = bent != before
            beyond = np.maximum(np.abs(angle) - 0.5 * s.play, 0.0) / s.softness
            load = np.sign(angle) * np.interp(beyond, twists, loads)
            net = applied - load - bristle * bent
            net -= np.where(sticking, damping, s.damping) * speed
            speed = speed + step / s.inertia * net
            angle = angle + step * speed


def _bristles(
    applied: float, load: np.ndarray, built: np.ndarray, held: np.ndarray, width: float
) -> tuple[np.ndarray, np.ndarray]:
    """Dahl's friction, solved for the load by small steps: its slope falls as it builds up."""
    for _ in range(8):
        short = applied - load - built  # what pulls the gear on
        way = np.sign(short)
        slope = held / width * (1.0 - way * built / held)
        step = short / (1.0 + np.maximum(slope, 0.0))
        load = load + step
        built = np.clip(built + slope * step, -held, held)
    return load, built


class Judged(NamedTuple):
    """Shares of recordings in which a figure is held by its interval, and how wide that is."""

    hysteresis: float
    friction: float
    """NaN where a gear has no one friction, or where time adds to the width of the loop."""
    backlash: float
    width: float
    """rad, median of the interval of the backlash."""
    widest: float
    """rad, of 95 of 100 intervals."""
    above_zero: float
    """Share of recordings that are told to have backlash."""


def judge(scenario: Scenario, count: int, seed: int = 1, *, alike: bool = False) -> Judged:
    """Measure simulated recordings and compare with the gears, which all differ unless alike."""
    random = np.random.default_rng(seed)
    gears = drawn(scenario, count, random, spread=0.0 if alike else 1.0)
    recorded = simulate(gears, random)
    found = [measured(recorded.torque[:, k], recorded.angle[:, k]) for k in range(count)]
    backlash = [figures.backlash for figures in found]
    widths = [(math.inf if one.high is None else one.high) - one.low for one in backlash]
    held = [
        one.low <= play and (one.high is None or play <= one.high)
        for one, play in zip(backlash, gears.play * np.ones(count), strict=True)
    ]
    return Judged(
        hysteresis=_share((one.hysteresis for one in found), hysteresis(gears)),
        friction=math.nan
        if scenario.slip or scenario.creeps or np.any(scenario.lag) or scenario.inertia
        else _share((one.friction for one in found), gears.friction),
        backlash=float(np.mean(held)),
        width=float(np.median(widths)),
        widest=float(np.quantile(widths, 0.95)),
        above_zero=float(np.mean([one.low > 0.0 for one in backlash])),
    )


def measured(torque: np.ndarray, angle: np.ndarray) -> GearFigures:
    return gear_figures(find_ramps(torque, angle, STEP))


def _share(found: Iterable[Estimate], true: Sequence[float]) -> float:
    """Share of the estimates that hold."""
    pairs = zip(found, true, strict=True)
    return float(np.mean([abs(one.value - value) <= one.uncertainty for one, value in pairs]))
