# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One fit of the angles of two encoders: ratio, offset, play, delay, and periodic errors of both.

The output angle is slope · rotor angle + offset + play by direction - delay · speed + errors that
repeat with each turn of output or rotor. An error of k cycles per turn has an amplitude of at most
`ENCODER_ERROR`/k, with a probability of 95 %. Over more than a turn these errors are fitted; what
a shorter travel leaves open is in the uncertainties, and so is a zero that walks at random, as by
temperature. Everything else is in the scatter of fits that each leave out one block of successive
samples.
"""

import math
from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from gear_kinematics.correction.reversals import tells_delay
from gear_kinematics.measurement.recording import Array, RecordingError
from gear_kinematics.statistics.normal_equations import NormalEquations
from gear_kinematics.statistics.uncertainty import Component, Estimate, jackknife

ENCODER_ERROR = math.radians(1.0)
"""rad: error of the rotor's encoder, and of the gear with the output's encoder. Magnetic encoders
deviate by ±1° over a turn (datasheets of ams AS5046 and AS5600), and printed gears by as much."""
STEP = 0.01  # s before and after a sample, for its speed; also taken between rows without times
_ACCURACY = math.radians(2.0 / 3600.0) / math.sqrt(3.0)
"""rad, standard deviation. Few encoders are accurate to ±2″ over the travel, and the faster a gear
on its springs turns, the more it follows its errors."""
_BLOCKS = 23  # a prime number, since blocks of whole cycles of an error would be alike
_MOST = 10_000  # samples that are used; with correlated errors, more would add nothing
_MEANS = 115  # least number of means of successive samples whose scatter shows correlation
_CHUNK = 4096  # points whose arrays fit into the processor's cache
_ORDERS = 48, 4
"""Greatest numbers of cycles per turn of output and rotor. With amplitudes of 1/k they add up to a
random walk, as pitch errors do. With 24 cycles, 3 of 200 simulated recordings over 340° were
beyond twice the interval."""
_ROTOR_SHARE = 0.1  # of `ENCODER_ERROR`, that the gear may add at the output once per rotor turn
_TO_STANDARD = math.sqrt(-2.0 * math.log(0.05))
"""Amplitude that 95 % do not exceed over the standard deviation of its sine and cosine."""
_PLAY, _DELAY = 0.1, 0.05
"""Standard deviations expected of play, rad, and delay, s: so large that they hardly matter."""
_DRIFTS, _WAVES = 3, 4  # columns of lag and drifts, and of play that varies over a turn
_VARIES = 3.0  # times its ± by which one of four waves is no chance
_LAG = 6e-5
"""Standard deviation, s², of the lag per acceleration: inertia over stiffness of the output, or
1/ω² of an output that oscillates at 20 Hz on the springs of its gear, as robot arms do."""
_SLOPE, _DIRECTION, _LATE = 0, 2, 3  # columns of the fit; 1 is the offset
_LEAST_NOISE = 1e-7  # rad, the step of an encoder of 26 bits; below it, rounding falsifies ratios
_PARTS, _LAGS, _EVIDENT = 256, (16, 32, 64, 128, 256), 64
"""Parts of a recording between which its zero may step; lags in a recording; number up to which
lags are tried for the one at which the zero walks most, since each shows a walk by chance only."""
_GROWS, _WALKS = 1.2, 1.6
"""Growth of the squared change from one lag to two: it is 2 for a zero that walks at random, at
least 1.6 for one that the fit does not follow, and about 1 for noise. Errors that are not fitted
and repeat up to sixteen times in the recording grow as a walk, and widen the ±."""
_ROUNDS = 5  # estimates of the noise, each from the residuals before; after 3, ± is 50 % off


class EncoderFit:
    """Fits to all samples, and then without each block of successive samples: (1 + blocks,)."""

    def __init__(
        self,
        rotor: Array,
        output: Array,
        time: Array,
        sign: Array,
        slope: float,
        late: float = 0.0,
    ) -> None:
        """Fit multi-turn angles of rotor and output, (n,) each, rad, in the order of time, s.

        `sign` is the direction of the motion, 1 or -1; samples with 0 are left out. The slope,
        output angle over rotor angle, and the delay `late` of the output, s, are first estimates.

        Raises:
            RecordingError: if there are too few samples.
        """
        self._angles, self._late = (rotor, output, time, sign), late
        then = time - late  # when the rotor was at the measured output angle
        signs = sign[np.rint(np.interp(then, time, np.arange(len(time)))).astype(int)]
        kept = np.flatnonzero(signs * (then >= time[0]) * (then <= time[-1]))
        kept = kept[:: -(-len(kept) // _MOST) or 1]
        if len(kept) < 2 * _BLOCKS:
            raise RecordingError(f'{len(kept)} samples in motion are too few')
        step = float(np.median(np.diff(time)))
        share = late / step % 1.0 if step else 0.0
        self._between = 0.5 * share * (1.0 - share) * step**2
        """s²: times the acceleration, the error of interpolating between two samples."""
        around = (then[kept] + k * STEP for k in (-2, -1, 0, 1, 2))
        first, early, at, after, last = (np.interp(when, time, rotor) for when in around)
        speed = slope * (after - early) / (2.0 * STEP)
        # Near a reversal, the speed is not that at the sample.
        near = (np.interp(then[kept] + k * STEP, time, sign) for k in (-1, 1))
        steady = (signs[kept] * speed)[np.all([each == signs[kept] for each in near], axis=0)]
        parts = np.array_split(steady, max(1, min(_MEANS, len(steady))))
        means = np.array([part.sum() / len(part) for part in parts])
        self.tells_delay = tells_delay(steady, means)
        """Whether the speed varies enough to separate a delay from play."""
        self.travel = float(np.ptp(at))
        # The measured angle must not explain itself, so that errors are periodic in the rotor's.
        model = _terms(at, slope, signs[kept], speed)
        # The same holds for reading errors: the acceleration does not contain the reading itself.
        acceleration = slope * (first - early - after + last) / (3.0 * STEP**2)
        left = output[kept] - slope * at - np.mean(output[kept] - slope * at)
        course = (then[kept] - np.mean(then[kept])) / np.ptp(then[kept])
        drifts = _PLAY * course, _DELAY * course * speed
        waves = _PLAY * signs[kept, None] * _waves(slope * at)
        self._model = list(range(len(model)))
        terms = np.stack([*model, _LAG * acceleration, *drifts, *waves.T, left])
        blocks = np.array_split(terms, _BLOCKS, axis=1)
        self._products = np.array([block @ block.T for block in blocks])
        self._equations = NormalEquations(self._products)
        for _ in range(_ROUNDS):
            self._equations.noise = max(_noise(left), _LEAST_NOISE**2)
            left = self._equations.residual(self._model) @ terms
        self._terms, self._slope = terms, slope

    @cached_property
    def _found(self) -> Array:
        """Coefficients of the model, (1 + blocks, terms)."""
        return self._equations.solve(self._model)

    @property
    def slope(self) -> Array:
        """Output angle over rotor angle, (1 + blocks,)."""
        return self._slope + self._found[:, _SLOPE] / self.travel

    def refined(self) -> 'EncoderFit':
        """Fit again, from the slope and the delay found."""
        whole = self._equations.solve(self._model, slice(1))[0]
        late = self._late - _DELAY * float(whole[_LATE])
        return EncoderFit(*self._angles, self._slope + float(whole[_SLOPE]) / self.travel, late)

    def slope_estimate(self, period: float) -> Estimate:
        """Estimate the slope, output angle over rotor angle.

        Its uncertainty includes by how much it changes if a lag proportional to the acceleration
        is fitted, as of an inertia on springs, or the error of interpolating the rotor between
        samples that are `period` apart, s; 0 if it is not interpolated.
        """
        lagging = self._equations.solve([*self._model, len(self._model)], slice(1))
        most = len(self._model) + 1
        curvature = NormalEquations(self._products[:, :most, :most])
        curvature.noise = self._equations.noise
        # The rotor is taken to move evenly between samples; with a delay, it is so twice.
        apart = max(period**2 / 4.0, self._between)
        curved = apart / _LAG * curvature.solve(self._model, slice(1))
        parts = (
            self._equations.spreads(self._model)[_SLOPE],
            _ACCURACY,
            (lagging[0, _SLOPE] - self._found[0, _SLOPE]) / math.sqrt(3.0),
            curved[0, _SLOPE] / math.sqrt(3.0),
        )
        return jackknife(
            self.slope,
            self._wander(self._model, _SLOPE, 1.0 / self.travel),
            *(Component(float(part) / self.travel) for part in parts),
        )

    def delay(self, unit: float = 1.0) -> Estimate:
        """Estimate the delay of the output's samples, in a unit of 1/`unit` s."""
        spread = Component(unit * _DELAY * float(self._equations.spreads(self._clear)[_LATE]))
        fits = self._equations.solve(self._clear)[:, _LATE]
        wander = self._wander(self._clear, _LATE, unit * _DELAY)
        return jackknife(unit * (self._late - _DELAY * fits), spread, wander)

    @cached_property
    def _even(self) -> list[int]:
        """Columns of the model, and those of a lag and of drifts that are clear."""
        lag = len(self._model)
        return [*self._model, *self._clear_of(self._model, range(lag, lag + _DRIFTS))]

    @cached_property
    def _clear(self) -> list[int]:
        """Columns as in `_even`, and those of play that varies with the angle if it does."""
        first = len(self._model) + _DRIFTS
        waves = range(first, first + _WAVES)
        return [*self._even, *(waves if self._clear_of(self._even, waves, _VARIES) else ())]

    def _clear_of(
        self, model: Sequence[int], further: Sequence[int], times: float = 1.0
    ) -> list[int]:
        """Return those of further columns that exceed their ± so many times if all are fitted."""
        found = self._equations.first_order([*model, *further])[:, len(model) :].T
        estimates = map(jackknife, found)
        return [
            place
            for place, estimate in zip(further, estimates, strict=True)
            if abs(estimate.value) >= times * estimate.expanded
        ]

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """Sums of the terms over successive parts, (terms, parts), and samples in each."""
        count = self._terms.shape[1]
        bounds = np.linspace(0, count, min(_PARTS, count) + 1).astype(int)
        return np.add.reduceat(self._terms, bounds[:-1], axis=1), np.diff(bounds)

    def _wander(self, chosen: Sequence[int], place: int, unit: float) -> Component:
        """Uncertainty of a coefficient, times a unit, if the zero walks at random as residuals do.

        The walk is a sum of independent steps, one before each part. All are fitted, too, for the
        fit follows a share of them, so that its residual shows only the rest. The delay is fitted
        in any case, as the residual would show it as well.
        """
        sums, counts = self._parts
        steps = np.tri(len(counts)).T / math.sqrt(len(counts))

        def followed(columns: Sequence[int]) -> Array:
            return self._equations.solve_for(columns, sums[[*columns]] @ steps.T)

        late = sorted({*chosen, _LATE})
        found = followed(late)
        left = steps - found.T @ (sums[late] / counts)
        walk = _walk(self._equations.residual(late) @ sums / counts, left)
        changes = (found if late == [*chosen] else followed(chosen))[[*chosen].index(place)]
        return Component(unit * math.sqrt(walk * np.sum(changes**2)), _LAGS[0])

    def lost_motion(self, *others: Component, delay: bool, even: bool = False) -> Estimate:
        """Estimate the angle lost on a reversal, rad, separate from a delay or including it.

        Drifts of the zero and, with the delay, of the clocks, a lag that grows with the
        acceleration, as that of a filter, and, unless play is taken to be `even`, its variation
        over a turn, as under the weight of an arm, are fitted, too, where they are clear. The
        value is the mean over the samples.
        """
        chosen = self._even if even else self._clear
        if not delay:
            model = [k for k in self._model if k != _LATE]
            chosen = [*model, *self._clear_of(model, [len(self._model) + 1])]
        fits = -2.0 * _PLAY * self._equations.first_order(chosen)[:, _DIRECTION]
        spread = 2.0 * _PLAY * float(self._equations.spreads(chosen)[_DIRECTION])
        # Both the spread and the scatter of blocks contain the noise: the greater of them counts.
        scatter = jackknife(fits).standard or 0.0
        rest = Component(math.sqrt(max(spread**2 - scatter**2, 0.0)))
        wander = self._wander(chosen, _DIRECTION, 2.0 * _PLAY)
        return jackknife(fits, rest, wander, *others)


def output_by_rotor(rotor: Array, measured: Array) -> float | None:
    """Robust ratio of output angle to rotor angle; None if the rotor does not move."""
    lag = max(len(rotor) // 40, 1)
    moved, followed = rotor[lag:] - rotor[:-lag], measured[lag:] - measured[:-lag]
    enough = np.abs(moved) >= max(0.5 * float(np.quantile(np.abs(moved), 0.8)), 1e-9)
    return float(np.median(followed[enough] / moved[enough])) if enough.any() else None


def directions(output: Array, travel: float, starts: Collection[int] = ()) -> Array:
    """Direction of an output angle, (n,), rad, in the order of time: 1, -1, or 0 if unknown.

    A new direction counts from a `travel`, rad, after the reversal. The motion before the samples
    with the indices `starts` is unknown.
    """
    direction = np.zeros(len(output), np.int8)
    for begin, end in pairwise(sorted({0, *starts, len(output)})):
        path, play = output[max(begin - 1, 0) : end], 0.5 * travel
        least, most = play_bounds(path, play)
        found = 1 * (most == path - play) - (least == path + play)
        direction[begin:end] = found[begin - end :]
    return direction


def play_bounds(x: Array, radius: float) -> Array:
    """Follow a play operator along x, (n,), rad: its least and greatest possible plays, (2, n).

    Before x, the play is unknown. Clipping to one interval and then to another equals clipping to
    a single interval, so that all steps are composed in log2 n passes, without rounding.
    """
    parts, before = [], np.array([[-np.inf], [np.inf]])
    for start in range(0, len(x), _CHUNK):
        part = x[start : start + _CHUNK]
        low, high = part - radius, part + radius
        step = 1
        while step < len(part):
            least, most = low[step:].copy(), high[step:].copy()
            for bound in (low, high):  # as np.clip, which takes twice as long
                bound[step:] = np.minimum(np.maximum(bound[:-step], least), most)
            step *= 2
        parts.append(np.clip(before, low, high))
        before = parts[-1][:, -1:]
    return np.concatenate(parts, axis=1)


def _terms(rotor: Array, slope: float, sign: Array, speed: Array) -> list[Array]:
    """Terms scaled to their expected size, (n,) each: slope, offset, play, delay, then errors."""
    x = (rotor - np.mean(rotor)) / np.ptp(rotor)
    terms = [x, np.ones(len(x)), _PLAY * sign, _DELAY * speed]
    amplitudes = ENCODER_ERROR, (abs(slope) + _ROTOR_SHARE) * ENCODER_ERROR
    for angle, amplitude, most in zip((slope * rotor, rotor), amplitudes, _ORDERS, strict=True):
        power = once = np.exp(1j * angle)  # cos + j sin of k times the angle
        for k in range(1, most + 1):
            size = amplitude / (_TO_STANDARD * k)
            terms += [size * power.real, size * power.imag]
            power = power * once
    return terms


def _waves(angle: Array) -> Array:
    """Return orthogonal combinations of waves once and twice per turn, of mean 0, (n, 4)."""
    power = np.exp(1j * np.outer(angle, (1, 2)))
    columns = np.column_stack([np.ones(len(angle)), power.real, power.imag])
    return np.asarray(math.sqrt(len(angle)) * np.linalg.qr(columns)[0][:, 1:])


def _noise(residual: Array) -> float:
    """Variance of a sample; if samples are correlated, that which the scatter of means implies."""
    most, means, size = 0.0, residual, 1
    while len(means) >= _MEANS or size == 1:
        most = max(most, size * float(np.mean(means**2)))
        means, size = (means[:-1:2] + means[1::2]) / 2.0, 2 * size
    return most


def _walk(residual: Array, left: Array) -> float:
    """Variance of a random walk of the zero over a recording, rad².

    The residual is (parts,), rad; `left`, (steps, parts), is what the fit leaves of the steps of a
    walk of variance 1. Both are compared at lags up to which that still grows as a walk.
    """
    sizes = [max(len(residual) // lags, 1) for lags in _LAGS]
    changes = [_squared_changes(residual, size) for size in sizes]
    walks = list[float]()
    for place, lags in enumerate(_LAGS):
        near, far = _squared_changes(left, sizes[place])
        if far >= _WALKS * near and not (walks and lags > _EVIDENT):
            # What is as large at a shorter lag is noise, or an error that repeats.
            noise = max(change for change, _ in changes[place:])
            walks.append((changes[place][1] - _GROWS * noise) / (far - _GROWS * near))
    if not walks:  # the fit follows all of a walk, and leaves nothing to compare with
        near, far = changes[0]
        walks.append(_LAGS[0] * (far - _GROWS * near) / (2.0 - _GROWS))
    return max(0.0, *walks)


def _squared_changes(values: Array, lag: int) -> list[float]:
    """Mean squares of the changes of the last axis at a lag and at twice the lag, rows added."""
    changes = (values[..., k * lag :] - values[..., : -k * lag] for k in (1, 2))
    return [float(np.sum(np.mean(change**2, axis=-1))) for change in changes]
