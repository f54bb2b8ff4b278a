# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings of gears that are known, simulated without anything of the code under test."""

import csv
import math
import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import closing
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from shipped_bags import JOINT_STATE, write_bag
from simulated_gear import GearSet, gears, simulate, strokes

from gear_kinematics.measurement.encoder_step import step_of
from gear_kinematics.measurement.recording import Encoders, RotorMotion
from gear_kinematics.wire.cdr import JointStateTemplate


class Gear(NamedTuple):
    """Play and a spring in series, moved against Coulomb friction."""

    play: float  # rad
    stiffness: float  # N·m/rad
    friction: float  # N·m

    def angle(self, torque: float) -> float:
        """The least angle, rad, at which the gear holds a torque, N·m."""
        return torque / self.stiffness + math.copysign(0.5 * self.play, torque or -1.0)


def creep(gear: Gear, torques: Sequence[float], angle: float = 0.0) -> np.ndarray:
    """Angles under torques that change slowly: it creeps as long as friction does not hold it."""
    step, angles = 2e-6, []
    for torque in torques:
        for way in (1.0, -1.0):
            short = gear.angle(way * torque - gear.friction) - way * angle
            angle += way * step * max(0, math.ceil(short / step))
        angles.append(angle)
    return np.array(angles)


def ramps(*tests: tuple[float, int]) -> np.ndarray:
    """Torques 0 → +T → 0 → -T → 0, each test with its T and the samples of a quarter of it."""
    parts = []
    for amplitude, count in tests:
        for start, end, quarters in (
            (0.0, amplitude, 1),
            (amplitude, -amplitude, 2),
            (-amplitude, 0.0, 1),
        ):
            parts.append(np.linspace(start, end, quarters * count, endpoint=False))
    return np.concatenate([*parts, [0.0]])


def write_csv(path: Path, **columns: Sequence[float]) -> Path:
    with path.open('w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*(np.asarray(c).tolist() for c in columns.values()), strict=True))
    return path


def encoders(
    rotor: np.ndarray,
    output: np.ndarray,
    stamp: np.ndarray | None = None,
    counts: int | None = None,
    output_counts: int | None = None,
) -> Encoders:
    """Angles of rotor and output at the same times, rad; without stamps, rows."""
    rows = np.arange(len(rotor))
    return Encoders(
        RotorMotion.of(rows * 10**9 if stamp is None else stamp, rotor),
        timed=stamp is not None,
        before=rows,
        share=np.zeros(len(rows)),
        measured=output,
        rotor_step=step_of(counts, rotor),
        output_step=step_of(output_counts, output),
    )


def two_encoders_at_one_shaft(
    speed: float, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles and times of two encoders that count against each other, up to a speed in rad/s.

    They are read every 10 ms by two messages, the second of which comes 0 to 2 ms later.
    """
    random = np.random.default_rng(seed)
    time = 0.01 * np.arange(2000)
    late = random.uniform(0.0, 2e-3, len(time))
    turned, seen = (0.5 * speed / 20.0 * when**2 for when in (time, time + late))
    return turned, -seen, time


class Samples(NamedTuple):
    """What is recorded of a joint."""

    stamps: Sequence[int]  # ns
    positions: Sequence[float]
    efforts: Sequence[float] | None = None
    received: Sequence[int] | None = None  # ns; None: at the stamps
    velocities: Sequence[float] | None = None


def write_recording(path: Path, rotor: Samples, encoder: Samples | None = None) -> Path:
    """Write a bag with /rotor_state and /output_encoder, in the order of reception."""
    recorded = {'/rotor_state': ('rotor', rotor)}
    if encoder:
        recorded['/output_encoder'] = ('output_shaft', encoder)
    messages = [
        (topic, received, data)
        for topic, (joint, samples) in recorded.items()
        for received, data in _messages(joint, samples)
    ]
    messages.sort(key=itemgetter(1, 0))
    return write_bag(path, messages, dict.fromkeys(recorded, JOINT_STATE))


def _messages(joint: str, samples: Samples):
    rates = samples.velocities, samples.efforts
    velocity, effort = (each is not None for each in rates)
    template = JointStateTemplate([joint], velocity=velocity, effort=effort)
    columns = [samples.positions, *(each for each in rates if each is not None)]
    received = samples.stamps if samples.received is None else samples.received
    for at, stamp, *numbers in zip(received, samples.stamps, *columns, strict=True):
        yield int(at), template.encode(int(stamp), [*map(float, numbers)])


def record_both_encoders(folder: Path, *names: str) -> None:
    """Write recordings of a simulated gear."""
    random = np.random.default_rng(3)
    setting = GearSet(1)
    gear = gears(setting, random)
    for name in names:
        simulated = simulate(setting, gear, strokes(25.0, random), random)
        stamps = 10**18 + np.round(simulated.time * 1e9).astype(np.int64)
        write_recording(
            folder / name,
            Samples(stamps, simulated.rotor[:, 0], simulated.effort[:, 0]),
            Samples(stamps, simulated.measured[:, 0]),
        )


def old_recording(
    path: Path,
    types: Sequence[tuple[str, str]],
    messages: Iterable[tuple[str, int, bytes]],
    qos: str = '',
) -> Path:
    """Write a database as ROS 2 Humble does: without definitions of types, and hashes."""
    numbers = {topic: number for number, (topic, _) in enumerate(types, start=1)}
    with closing(sqlite3.connect(path)) as rows, rows:
        rows.execute(
            'CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,'
            ' serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)'
        )
        rows.execute(
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,'
            ' timestamp INTEGER NOT NULL, data BLOB NOT NULL)'
        )
        topics = [(*each, qos) for each in types]
        rows.executemany("INSERT INTO topics VALUES (NULL, ?, ?, 'cdr', ?)", topics)
        rows.executemany(
            'INSERT INTO messages VALUES (NULL, ?, ?, ?)',
            ((numbers[topic], received, data) for topic, received, data in messages),
        )
    return path
