"""Torque ramps of gears that are known, stepped through time; nothing under test is used.

The load on the spring is the state: friction holds it until the torque differs from it by more
than the friction, and then lets it follow just so far. Play is a step of the spring's curve, a
table. Gears with inertia move by Newton's law instead, and speed up in their play. All recordings
of a scenario step together: arrays are (time, recordings).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

INTERVAL = 2.5e-3  # s
STEP = 2.0 * math.pi / 65536.0  # rad, of the encoder
SMALL, LARGE = 4.0, 40.0  # N·m
_CORNERS = np.array([0.0, 1.0, 1.0, -1.0, -1.0, 0.0])
"""Of the torque in a loop, with pauses at its peaks."""
_REPEATS = 100
"""Recordings whose mean is the hysteresis of a gear."""

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


def soft_middle(load: np.ndarray) -> np.ndarray:
    """60 N·m/rad within 1 N·m, as of tooth flanks that are not yet fully in contact."""
    return load / 300.0 + 0.0133 * np.tanh(load)


@dataclass(frozen=True)
class Scenario:
    """A gear and its sensors; angles in rad at the output."""

    name: str
    contained: bool = True
    """Whether the family of models contains it."""
    play: float = 0.0
    spring: Spring = linear
    friction: float = 1.0
    """N·m."""
    load_friction: float = 0.0
    """Share of the load that adds to it."""
    creeps: tuple[tuple[float, float], ...] = ()
    """Share of the twist, and time constant, s, of each."""
    bristle: float = 0.0
    """N·m over which friction builds up after a reversal."""
    slip: float = 0.0
    """Share of the friction by which it falls once the gear moves (stick-slip)."""
    inertia: float = 0.0
    """kg·m², at the output."""
    damping: float = 0.0
    """N·m·s/rad; of gears with inertia."""
    drift: float = 0.0
    """rad/s, of the encoder."""
    thermal: tuple[float, float] = (0.0, 60.0)
    """Amplitude, rad, and period, s, of a wandering zero."""
    lag: float = 0.0
    """s, by which the readings of the encoder are late."""
    pause: float = 0.0
    """Share of the time for which the torque stays at its peaks."""
    noise: float = 0.1
    """N·m, of the torque sensor."""
    repeat: float = 0.01
    """Relative scatter of the friction from loop to loop."""
    loops: Loops = SMALL_AND_LARGE
    """Those of the first amplitude are judged."""


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
    Scenario('soft middle', contained=False, spring=soft_middle),
    Scenario(
        'creep with two times', contained=False, play=0.01, creeps=((0.05, 1.0), (0.08, 20.0))
    ),
    Scenario(
        'creep, softening spring',
        contained=False,
        play=0.01,
        spring=softening,
        creeps=((0.1, 5.0),),
    ),
    Scenario('friction that builds up', contained=False, play=0.01, bristle=0.5),
    Scenario('stick-slip', contained=False, play=0.01, slip=0.3),
    Scenario(
        'creep, drift and growing friction',
        contained=False,
        play=0.01,
        creeps=((0.05, 5.0),),
        load_friction=0.05,
        drift=2e-5,
    ),
    Scenario('inertia, no play', contained=False, inertia=0.01, damping=0.5),
    Scenario('inertia, play', contained=False, play=0.01, inertia=0.01, damping=0.5),
)


def drawn(scenario: Scenario, random: np.random.Generator) -> Scenario:
    """Draw a gear and its sensors: each figure is that of the scenario or up to twice or half."""

    def about(value: float) -> float:
        return value * 2.0 ** random.uniform(-1.0, 1.0)

    softer, friction = about(1.0), about(scenario.friction)
    return replace(
        scenario,
        play=about(scenario.play),
        spring=lambda load: softer * scenario.spring(load),
        friction=friction,
        load_friction=about(scenario.load_friction),
        creeps=tuple((about(share), about(constant)) for share, constant in scenario.creeps),
        bristle=about(scenario.bristle) * friction,
        slip=about(scenario.slip),
        inertia=about(scenario.inertia),
        damping=about(scenario.damping),
        drift=about(scenario.drift) * random.choice([-1.0, 1.0]),
        thermal=(about(scenario.thermal[0]), about(scenario.thermal[1])),
        lag=about(scenario.lag),
        noise=about(scenario.noise),
        repeat=about(scenario.repeat),
    )


class Ramps(NamedTuple):
    """Recordings of a scenario."""

    time: np.ndarray
    """(time,), s."""
    torque: np.ndarray
    """(time, recordings), N·m, measured."""
    angle: np.ndarray
    """(time, recordings), rad, measured."""


def hysteresis(scenario: Scenario) -> float:
    """Return the hysteresis of the first amplitude by definition, without the errors of sensors.

    It is the mean over many recordings, as the steps of stick-slip lie elsewhere in each.
    """
    first = tuple(loop for loop in scenario.loops if loop == scenario.loops[0])
    angle = _motion(replace(scenario, loops=first), _REPEATS, np.random.default_rng(0))
    rows = round(first[0][1] / INTERVAL)
    ends = np.arange(1, len(first)) * rows
    return float(np.mean(angle[ends + rows // 2] - angle[ends + rows]))


def simulate(scenario: Scenario, count: int, random: np.random.Generator) -> Ramps:
    """Record a gear many times."""
    time, torque = _torque(scenario)
    angle = _motion(scenario, count, random)
    size, period = scenario.thermal
    phase = random.uniform(-np.pi, np.pi, count)
    angle = angle + scenario.drift * time[:, None]
    angle += size * np.sin(2.0 * np.pi * time[:, None] / period + phase)
    if scenario.lag:
        late = time - scenario.lag
        angle = np.stack([np.interp(late, time, column) for column in angle.T], axis=1)
    zero = random.uniform(0.0, STEP, count)
    noise = scenario.noise * random.standard_normal(angle.shape)
    return Ramps(time, torque[:, None] + noise, np.round((angle + zero) / STEP) * STEP)


def _torque(s: Scenario) -> tuple[np.ndarray, np.ndarray]:
    parts = []
    for amplitude, duration in s.loops:
        quarter = round(0.25 * duration / INTERVAL)
        still = round(s.pause * quarter)
        times = quarter * np.array([0, 1, 1, 3, 3, 4]) + still * np.array([0, -1, 1, -1, 1, 0])
        parts.append(np.interp(np.arange(4 * quarter), times, amplitude * _CORNERS))
    torque = np.concatenate([*parts, [0.0]])
    return INTERVAL * np.arange(len(torque)), torque


def _loops_of_rows(loops: Loops) -> np.ndarray:
    rows = [round(duration / INTERVAL) for _, duration in loops]
    return np.append(np.repeat(np.arange(len(rows)), rows), len(rows) - 1)


def _motion(s: Scenario, count: int, random: np.random.Generator) -> np.ndarray:
    """Angle, (time, recordings), without the errors of the encoder."""
    _, torque = _torque(s)
    # The curve of the spring with its play: twist at loads, and loads at twists.
    loads = np.linspace(-1.5 * LARGE, 1.5 * LARGE, 240001)
    twists = s.spring(loads) + 0.5 * s.play * np.sign(loads)
    strength = s.friction * (1.0 + s.repeat * random.standard_normal((len(s.loops), count)))
    if s.inertia:
        return _moved(s, torque, strength, lambda twist: np.interp(twist, twists, loads))
    loop = _loops_of_rows(s.loops)
    twist = np.zeros(count)
    load = np.zeros(count)
    built = np.zeros(count)  # N·m, friction that has built up, with its sign
    late = np.zeros((len(s.creeps), count))
    angles = np.empty((len(torque), count))
    for k, applied in enumerate(torque):
        held = strength[loop[k]] + s.load_friction * np.abs(load)
        if s.bristle:
            load, built = _bristles(applied, load, built, held, s.bristle)
        else:
            net = applied - load
            moves = np.abs(net) > held
            sliding = held * (1.0 - s.slip)
            # A load that grows makes its own friction grow.
            towards = np.sign(net)
            growing = towards * np.sign(applied - towards * sliding) * s.load_friction
            fresh = strength[loop[k]] * (1.0 - s.slip)
            load = np.where(moves, (applied - towards * fresh) / (1.0 + growing), load)
        twist = np.interp(load, loads, twists)
        for j, (share, constant) in enumerate(s.creeps):
            late[j] += (share * s.spring(load) - late[j]) * -math.expm1(-INTERVAL / constant)
        angles[k] = twist + late.sum(axis=0)
    return angles


def _moved(s: Scenario, torque: np.ndarray, strength: np.ndarray, spring: Spring) -> np.ndarray:
    """Angle of a gear with inertia, and friction by Haessig and Friedland's bristles."""
    substeps, bristle = 10, 2e4  # N·m/rad
    step = INTERVAL / substeps
    loop = _loops_of_rows(s.loops)
    damping = s.damping + math.sqrt(bristle * s.inertia)  # of the bristles as well
    angle, speed, bent = np.zeros((3, strength.shape[1]))
    angles = np.empty((len(torque), len(angle)))
    for k in range(len(torque)):
        angles[k] = angle
        most = strength[loop[k]] / bristle
        ahead = np.interp(k + np.arange(substeps) / substeps, np.arange(len(torque)), torque)
        for applied in ahead:
            before = bent
            bent = np.clip(bent + step * speed, -most, most)
            sticking = bent != before
            net = applied - spring(angle) - bristle * bent
            net -= np.where(sticking, damping, s.damping) * speed
            speed = speed + step / s.inertia * net
            angle = angle + step * speed
    return angles


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
