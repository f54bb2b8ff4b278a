# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How fast the kinematics are, against what no implementation can avoid and against Pinocchio.

    python benchmark/kinematics.py [--samples 1000000] [--rounds 9] [--json]

Batches go through `solve`, position only and with both derivatives. The bound is the time that
numpy needs for the sines and cosines of the rotor's and the output shaft's angle; what it takes
to write as many numbers as the results have into new memory is printed beside it. There are two
motions: angles at random, and a steady speed, where the processor foresees the branches that a
sine takes, so that the bound is half as high.

Pinocchio's compiled forward kinematics of the same bodies and joints are called in a loop, on
data made beforehand. They get the angles within the turn and the slides for nothing. What the
same calls cost for a model without joints is the calls' own share; without it there is a second
comparison.

One by one, samples go through what the node computes for a message, on plain floats, and through
`solve`.

The ways take turns, so that what else the machine does befalls all of them. Times are of the
processor and per sample; what is printed is the median over the rounds, of ratios too. Memory is
the peak of what numpy allocates for a batch, against what its results keep.
"""

import argparse
import json
import math
import statistics
import time
import tracemalloc
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from gear_kinematics.kinematics import solve, split_turns
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.parameters import NodeParameters

Array = NDArray[np.float64]

_MECHANISM = NodeParameters.load().mechanism
_LOOPED = 20_000  # samples of what goes through a loop
_SPEED, _ACCELERATION = 314.0, 6500.0  # rad/s, rad/s²
_MILLISECOND = 1e-3  # s


class Motion(NamedTuple):
    """The rotor's angle (rad), velocity (rad/s) and acceleration (rad/s²)."""

    angle: Array
    velocity: Array
    acceleration: Array


class Way(NamedTuple):
    """Something that goes through so many samples."""

    samples: int
    run: Callable[[], object]


class Figure(NamedTuple):
    """A measured number, and its target if it has one."""

    name: str
    value: float
    unit: str
    at_most: float = math.inf
    at_least: float = -math.inf

    def __str__(self) -> str:
        line = f'  {self.name:48}{self.value:8.2f} {self.unit}'
        for sign, limit in (('<=', self.at_most), ('>=', self.at_least)):
            if math.isfinite(limit):
                line += f'   (target {sign} {limit:g}: {"met" if self.met else "not met"})'
        return line

    @property
    def met(self) -> bool:
        """Whether the number is within its target; it is without one."""
        return self.at_least <= self.value <= self.at_most


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--samples', type=int, default=1_000_000)
    parser.add_argument('--rounds', type=int, default=9)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    steady = _steady(options.samples)
    groups = {
        'batch, angles at random': _batches(_at_random(options.samples), options.rounds),
        'batch, steady speed': _batches(steady, options.rounds),
        'one by one': _one_by_one(steady, options.rounds),
        'memory of a batch': [
            _memory('position only', steady[:1]),
            _memory('both derivatives', steady),
        ],
    }
    if options.json:
        values = {name: {f.name: f.value for f in figures} for name, figures in groups.items()}
        print(json.dumps(values, indent=2))
        return
    for name, figures in groups.items():
        print(name, *figures, sep='\n')


def _at_random(samples: int) -> Motion:
    """1600 turns either way, and anything that a servo does."""
    shares = np.random.default_rng(1).uniform(-1.0, 1.0, (3, samples))
    return Motion(1e4 * shares[0], _SPEED * shares[1], _ACCELERATION * shares[2])


def _steady(samples: int) -> Motion:
    """3000 rpm, sampled at 1 kHz."""
    velocity = np.full(samples, _SPEED)
    return Motion(np.arange(samples) * _MILLISECOND * velocity, velocity, np.zeros(samples))


def _batches(motion: Motion, rounds: int) -> list[Figure]:
    samples, branches = len(motion.angle), len(_MECHANISM.branches)
    _, angle = split_turns(motion.angle)
    output_angle = solve(_MECHANISM, motion.angle).output_turn_angle.copy()

    def sines_and_cosines() -> tuple[Array, ...]:
        return np.sin(angle), np.cos(angle), np.sin(output_angle), np.cos(output_angle)

    times = _measure(
        {
            'bound': Way(samples, sines_and_cosines),
            'position': Way(samples, lambda: solve(_MECHANISM, motion.angle)),
            'numbers, position': Way(samples, lambda: np.ones((samples, 2 + 6 * branches))),
            'derivatives': Way(samples, lambda: solve(_MECHANISM, *motion)),
            'numbers, derivatives': Way(samples, lambda: np.ones((samples, 4 + 16 * branches))),
            **_pinocchio(motion),
        },
        rounds,
    )
    figures = [Figure('sines and cosines', _median(times['bound']) * 1e9, 'ns')]
    for name, calculation, bound, faster in (
        ('position only', 'position', 2.0, 4.0),
        ('both derivatives', 'derivatives', 5.0, -math.inf),
    ):
        taken, calls = times[calculation], times[f'calls, {calculation}']
        in_loop = times[f'pinocchio, {calculation}']
        compiled = [loop - call for loop, call in zip(in_loop, calls, strict=True)]
        figures += [
            Figure(name, _median(taken) * 1e9, 'ns'),
            Figure(f'{name}, writing', _median(times[f'numbers, {calculation}']) * 1e9, 'ns'),
            Figure(f'{name}, Pinocchio in a loop', _median(in_loop) * 1e9, 'ns'),
            Figure(f'{name}, Pinocchio less the calls', _median(compiled) * 1e9, 'ns'),
            Figure(f'{name} / sines and cosines', _ratio(taken, times['bound']), 'x', bound),
            Figure(f'Pinocchio in a loop / {name}', _ratio(in_loop, taken), 'x', at_least=faster),
            Figure(f'Pinocchio less the calls / {name}', _ratio(compiled, taken), 'x'),
        ]
    return figures


def _pinocchio(motion: Motion) -> dict[str, Way]:
    """Its forward kinematics, and the same calls for a model without joints."""
    model, couplings = _chains()
    data = model.createData()
    nothing = pin.Model()
    nothing_data = nothing.createData()
    angle = motion.angle[:_LOOPED]
    state = solve(_MECHANISM, angle)
    rotor, shaft = split_turns(angle)[1], state.output_turn_angle
    columns = [rotor, shaft]
    for k in range(len(_MECHANISM.branches)):
        columns += [shaft - rotor, state.satellite_slide[:, k], state.arm_slide[:, k]]
    joints = list(np.column_stack(columns))
    none = list(np.empty((len(joints), 0)))

    def loop(model: pin.Model, data: pin.Data, rows: Sequence[Array]) -> None:
        for row in rows:
            pin.forwardKinematics(model, data, row)

    def loop_with_derivatives(model: pin.Model, data: pin.Data, rows: Sequence[Array]) -> None:
        for row in rows:  # the time does not depend on what the rates are
            pin.forwardKinematics(model, data, row, row, row)

    loop(model, data, joints)
    reached = [data.oMi[joint].translation[:2] for joint in couplings]
    if not np.allclose(reached, state.oldham_centre[-1], rtol=0.0, atol=1e-12):
        raise RuntimeError(f'Pinocchio arrives at {reached}, not {state.oldham_centre[-1]}')
    return {
        'pinocchio, position': Way(len(joints), lambda: loop(model, data, joints)),
        'calls, position': Way(len(joints), lambda: loop(nothing, nothing_data, none)),
        'pinocchio, derivatives': Way(
            len(joints), lambda: loop_with_derivatives(model, data, joints)
        ),
        'calls, derivatives': Way(
            len(joints), lambda: loop_with_derivatives(nothing, nothing_data, none)
        ),
    }


def _chains() -> tuple[pin.Model, list[int]]:
    """Two open chains to each coupling, and the joints at the end of those by the satellites."""

    def at(x: float, y: float, z: float) -> pin.SE3:
        return pin.SE3(np.eye(3), np.array([x, y, z]))

    model, couplings = pin.Model(), []
    rotor = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), 'rotor')
    shaft = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), 'output_shaft')
    e = _MECHANISM.eccentricity
    for branch in _MECHANISM.branches:
        name, phase, z = branch.name, branch.cam_phase, branch.axial_position
        cam = at(-e * math.sin(phase), e * math.cos(phase), z)
        satellite = model.addJoint(rotor, pin.JointModelRZ(), cam, f'satellite_{name}')
        slide = pin.JointModelPX()
        couplings.append(model.addJoint(satellite, slide, pin.SE3.Identity(), f'oldham_{name}'))
        model.addJoint(shaft, pin.JointModelPY(), at(0.0, 0.0, z), f'arm_{name}')
    return model, couplings


def _one_by_one(motion: Motion, rounds: int) -> list[Figure]:
    form, ratio = closed_form(_MECHANISM), _MECHANISM.gear_ratio
    samples = [
        tuple(map(float, sample)) for sample in zip(*(v[:_LOOPED] for v in motion), strict=True)
    ]
    few = samples[:1000]

    def as_the_node() -> None:
        for position, velocity, _ in samples:
            turns, angle = split_turns(position)
            _, output_angle = ratio.output_angle(turns, angle, math)
            ratio.output_rate(velocity)
            for branch in form.branches(angle, output_angle, math):
                form.slide_velocities(branch, velocity)

    def position() -> None:
        for angle, _, _ in few:
            solve(_MECHANISM, angle)

    def derivatives() -> None:
        for sample in few:
            solve(_MECHANISM, *sample)

    times = _measure(
        {
            'node': Way(len(samples), as_the_node),
            'position': Way(len(few), position),
            'derivatives': Way(len(few), derivatives),
        },
        rounds,
    )
    return [
        Figure('what the node computes for a message', _median(times['node']) * 1e6, 'µs', 4.0),
        Figure('solve, position only', _median(times['position']) * 1e6, 'µs'),
        Figure('solve, both derivatives', _median(times['derivatives']) * 1e6, 'µs'),
    ]


def _memory(name: str, inputs: Sequence[Array]) -> Figure:
    tracemalloc.start()
    state = solve(_MECHANISM, *inputs)
    held, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    del state
    return Figure(f'{name}, peak', peak / held, 'x its results', at_most=1.3)


def _measure(ways: Mapping[str, Way], rounds: int) -> dict[str, list[float]]:
    """Seconds per sample of every way in every round."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(rounds):
        for name, way in ways.items():
            way.run()  # a virtual machine's memory is slow at its first touch
            start = time.process_time()
            way.run()
            times[name].append((time.process_time() - start) / way.samples)
    return times


def _median(times: Sequence[float]) -> float:
    return statistics.median(times)


def _ratio(times: Sequence[float], others: Sequence[float]) -> float:
    return statistics.median(t / other for t, other in zip(times, others, strict=True))


if __name__ == '__main__':
    main()
