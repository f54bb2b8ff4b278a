# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Simulated gears that are recorded and measured as a user would."""

import json
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import redirect_stdout
from fractions import Fraction
from io import StringIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from gear_recordings import Samples, write_csv, write_recording
from simulated_encoders import START, TURN, stepped
from twins import PutIn

from gear_kinematics.commands.cli import main
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.twin.driver import Command, Driver
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.parameters import TwinParameters

MILLISECOND = 1e-3  # s, between the samples of a recording
RATED = 10.0  # N·m
OUTPUT_COUNTS, ROTOR_COUNTS = 2**20, 2**16  # of a turn
STEP = TURN / OUTPUT_COUNTS  # rad
NOISE = 0.01  # N·m, of the torque sensor: 0.1 % of the rated torque

Simulate = Callable[[TwinGear], TwinModel]


class Figure(NamedTuple):
    """A figure, and the interval in which it was measured to be."""

    name: str
    put_in: float
    low: float
    high: float

    @classmethod
    def of(cls, name: str, put_in: float, measured: dict) -> 'Figure':
        half = measured['expanded_uncertainty']
        return cls(name, put_in, measured['value'] - half, measured['value'] + half)

    @property
    def value(self) -> float:
        """The middle of the interval."""
        return 0.5 * (self.low + self.high)

    @property
    def half(self) -> float:
        """Half its width."""
        return 0.5 * (self.high - self.low)

    @property
    def deviation(self) -> float:
        """What was measured less what was put in."""
        return self.value - self.put_in

    @property
    def holds(self) -> bool:
        """Whether what was put in lies in the interval."""
        return self.low <= self.put_in <= self.high


def report(*arguments: object) -> dict:
    """Give the JSON of a command."""
    with redirect_stdout(StringIO()) as out:
        assert main([*map(str, arguments), '--quiet', '--json', '-']) <= 1
    return json.loads(out.getvalue())


def driver_of(model: TwinModel) -> Driver:
    """Switch on a driver of the rotor."""
    counts = {'rotor_counts': ROTOR_COUNTS, 'output_counts': OUTPUT_COUNTS}
    return Driver(model, TwinParameters.of({'max_rotor_torque': 10.0, **counts}))


# Torque ramps


class Bench:
    """Twists the output at a speed through a torque sensor with a stiffness and a damping.

    A torque that is ramped itself would throw the output across its play into the opposite flank,
    where friction holds it at another load than the ramp alone would leave.
    """

    _STIFFNESS, _DAMPING = 300.0, 0.5  # N·m/rad, N·m·s/rad
    _PERIODS = 5  # of the sensor in a sample

    def __init__(self, model: TwinModel) -> None:
        self._model, self._ahead, self._torque = model, 0.0, 0.0
        self.torque: list[float] = []
        self.angle: list[float] = []

    def twist(self, amplitude: float, duration: float, yielding: float) -> None:
        """Go to a torque, N·m, to the opposite one and back to 0, in about a duration, s."""
        speed = (4.0 * amplitude / self._STIFFNESS + 2.0 * yielding) / duration
        for way, end in ((1.0, amplitude), (-1.0, amplitude), (1.0, 0.0)):
            while way * self._torque < end:
                self._advance(way * speed)

    def _advance(self, speed: float) -> None:
        model, period = self._model, MILLISECOND / self._PERIODS
        for _ in range(self._PERIODS):
            self._ahead += period * speed
            self._torque = self._STIFFNESS * (self._ahead - model.output_angle)
            self._torque += self._DAMPING * (speed - model.output_velocity)
            model.advance(period, 0.0, self._torque)
        self.torque.append(self._torque)
        self.angle.append(model.output_angle)


def ramps(put_in: PutIn, simulate: Simulate, folder: Path) -> list[Figure]:
    """Measure five ramps of three times the friction and three of the rated torque."""
    # While the rotor is locked, its errors are a constant, which need not be computed each step.
    model = simulate(put_in._replace(errors=()).gear)
    model.rotor_locked = True
    bench = Bench(model)
    for amplitude, duration in [*5 * [(3.0 * put_in.friction, 0.6)], *3 * [(RATED, 0.9)]]:
        yielding = float(np.ptp(put_in.turn(np.array([-amplitude, amplitude]))))
        bench.twist(amplitude, duration, yielding)
    noise = NOISE * np.random.default_rng(1).standard_normal(len(bench.torque))
    file = write_csv(
        folder / 'ramps.csv',
        angle_rad=stepped(np.array(bench.angle), STEP),
        torque_Nm=bench.torque + noise,
    )
    [found] = report('lost-motion', file)['recordings']
    friction, backlash = put_in.friction, found['backlash']
    width = float(np.ptp(put_in.turn(np.array([-friction, friction]))))
    figures = [
        Figure.of('hysteresis', width, found['hysteresis']),
        Figure.of('friction', friction, found['friction']),
        Figure('backlash', put_in.remaining, backlash['low'], backlash['high']),
    ]
    names = 'stiffness up to 15 %', 'stiffness up to 50 %', 'stiffness up to 100 %'
    for name, each in zip(names, found['stiffness'], strict=True):
        if put_in.remaining and not each['low']:
            continue  # a line through the jump of the play is no stiffness
        torque = np.linspace(each['low'], each['high'], 1001)
        slopes = [
            np.polynomial.polynomial.polyfit(
                torque, way * put_in.turn(way * (torque - friction)), 1
            )
            for way in (1.0, -1.0)
        ]
        figures.append(Figure.of(name, 1.0 / float(np.mean(slopes, axis=0)[1]), each))
    return figures


# Both encoders


class Encoded(NamedTuple):
    """What both encoders tell of a gear."""

    ratio: Fraction
    """The ratio of the gear."""
    senses: int
    """1, or -1 if one of the encoders counts backwards."""
    zero: float
    """rad at the output: what the zeros are off, less the mean of the true deviation."""
    mean: float
    """rad: that mean, of which the encoders do not know."""
    errors: dict[str, tuple[complex, float]]
    """By name: what an order is off, cos + sin j, and the ± of its amplitude, rad."""
    others: float
    """rad: the greatest amplitude of an order that was not put in, less its ±."""


def strokes(put_in: PutIn, simulate: Simulate, folder: Path) -> Encoded:
    """Move the rotor to and fro three times, by a little more than a turn of the output."""
    parameters, model = put_in.parameters, simulate(put_in.gear)
    driver, ratio = driver_of(model), put_in.gear.ratio
    shares = [np.linspace(0.0, 1.0, round(each / MILLISECOND)) for each in (1.0, 1.0, 1.3)]
    ways = [0.5 - 0.5 * np.cos(math.pi * (share + k % 2)) for k, share in enumerate(shares)]
    angle = ratio * 7.0 * np.concatenate(ways)
    readings, deviations = [], []
    for position, velocity in zip(angle, np.gradient(angle, MILLISECOND), strict=True):
        sense = parameters.rotor_direction
        encoded = parameters.rotor_zero + sense * float(position)
        driver.follow(Command(encoded, sense * float(velocity), None))
        driver.advance(MILLISECOND, 0.0)
        rotor, _, effort = driver.rotor()
        readings.append((rotor, effort, driver.output()[0]))
        deviations.append(model.output_angle - model.rotor_angle / ratio)
    rotor, effort, output = np.array(readings[::2]).T
    stamps = START + np.arange(len(rotor)) * 2_000_000
    bag = write_recording(
        folder / 'strokes', Samples(stamps, rotor, effort), Samples(stamps, output)
    )
    return _encoded(put_in, bag, float(np.mean(deviations)))


def _encoded(put_in: PutIn, bag: Path, mean: float) -> Encoded:
    parameters, folder = put_in.parameters, bag.parent
    config, made = folder / 'put_in.yaml', folder / 'calibration.yaml'
    config.write_text(parameters.as_file(), encoding='utf-8')
    terms = report('calibrate', bag, '--config', config, '-o', made)['terms']
    found = report('commission', bag, '-o', folder / 'commissioned.yaml')
    values = {each['name']: each['value'] for each in found['values']}
    orders = {order.name: order for order in Calibration.load(made).orders}
    half = {each['name']: each['amplitude']['expanded_uncertainty'] for each in terms}
    put = {order.name: order for order in put_in.errors}
    # The zeros that are found are those of encoders that count as the output's does.
    senses = parameters.rotor_direction * parameters.output_encoder_direction
    ratio = senses * Fraction(values['gear_ratio'])
    expected = parameters.rotor_zero - float(senses * ratio) * parameters.output_encoder_zero
    zero = (values['rotor_zero'] - expected) / float(ratio)
    zero += parameters.rotor_direction * mean
    return Encoded(
        ratio,
        senses,
        math.remainder(zero, TURN),
        mean,
        {
            name: (complex(orders[name].cos - order.cos, orders[name].sin - order.sin), half[name])
            for name, order in put.items()
        },
        max(
            (
                math.hypot(each.cos, each.sin) - half[name]
                for name, each in orders.items()
                if name not in put
            ),
            default=0.0,
        ),
    )


# A history of loads


class Moment(NamedTuple):
    """A time in which a branch was out of mesh, in samples."""

    first: int
    last: int
    branch: str


def moments(put_in: PutIn, simulate: Simulate, folder: Path) -> tuple[list[Moment], list[Moment]]:
    """Load the turning gear, which has a preload, beyond both thresholds.

    Returns:
        The moments that `gearkin loads` finds, and those in which a branch has no torque.
    """
    parameters, model = put_in.parameters, simulate(put_in.gear)
    driver, rows, torques = driver_of(model), [], []
    high, low = sorted(put_in.thresholds, reverse=True)
    driver.follow(Command(None, 20.0, None))
    for number in range(2000):
        load = 1.2 * math.sin(2.0 * math.pi * number / 800)
        driver.advance(MILLISECOND, load * (high if load > 0.0 else -low))
        rows.append(driver.rotor())
        torques.append(model.branch_torques)
    stamps = START + np.arange(len(rows)) * 1_000_000
    rotor, velocity, effort = np.array(rows).T
    bag = write_recording(folder / 'loaded', Samples(stamps, rotor, effort, velocities=velocity))
    (folder / 'loaded' / 'actuator.yaml').write_text(parameters.as_file(), encoding='utf-8')
    found = []
    for each in report('loads', bag)['recordings'][0]['moments']:
        first = round((each['stamp'] - START) / 1_000_000)
        found.append(Moment(first, first + round(each['duration'] / MILLISECOND), each['branch']))
    return found, sorted(_without_torque(torques))


def _without_torque(torques: Sequence[Sequence[float]]) -> Iterator[Moment]:
    """Find the moments of each branch; one that ends for a sample or two is not over."""
    for name, own in zip('ab', np.transpose(torques), strict=True):
        apart = np.flatnonzero(own == 0.0)
        for rows in np.split(apart, np.flatnonzero(np.diff(apart) > 3) + 1):
            if len(rows):
                yield Moment(int(rows[0]), int(rows[-1]) + 1, name)
