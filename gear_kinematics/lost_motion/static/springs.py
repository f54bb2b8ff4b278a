"""A family of springs with and without play, fitted to the middle lines of hysteresis loops.

With the angle u from the middle and d = sign(u) max(|u| - b/2, 0), the angle beyond the gap b,
the load is c0 + c1 max(d, 0) + c2 min(d, 0) + c3 g(d) + c4 (u - d): the spring beyond the gap,
with a stiffness for each direction, which may be bent by a shape g; and a rest of stiffness in
the gap. As angles and loads of middle lines are means, so are max(d, 0) and min(d, 0).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Array

_CENTRES = np.linspace(-0.5, 0.5, 13)
"""Middles of the gap that are tried first, as shares of half of the loop's angle."""
_GAPS = np.linspace(0.0, 1.8, 25)
"""Gaps that are tried first, likewise."""
_FINER = np.linspace(-0.6, 0.6, 5)
"""Steps around the best values, which are tried then; as shares of the step before."""
_REFINEMENTS = 2
_ITERATIONS = 8
"""Of the fit to a single loop."""
_SIDES = 3
"""Number of the factor that follows those of a constant and of both sides."""
_RIDGE = 1e-8
"""Relative weight that decides between equal fits."""


class Gap(IntEnum):
    """What is in the middle of a spring; the more, the larger the number."""

    NONE = 0
    PLAY = 1
    SOFT = 2
    """A gap with a rest of stiffness."""


@dataclass(frozen=True, slots=True)
class Shape:
    """How a spring is bent."""

    name: str
    function: Callable[[Array], Array] | None
    """Of the angle beyond the gap as a share of half of the loop's; None: not bent."""
    slopes: tuple[float, float]
    """Of the function, at no load and at the end."""
    parameters: int


def _tanh(scale: float) -> Shape:
    end = float(1.0 / np.cosh(1.0 / scale) ** 2 / scale)
    return Shape(f'tanh {scale:g}', lambda d: np.tanh(d / scale), (1.0 / scale, end), 2)


def _sinh(scale: float) -> Shape:
    end = float(np.sinh(1.0 / scale))
    slopes = 1.0 / scale / end, float(np.cosh(1.0 / scale)) / scale / end
    return Shape('sinh', lambda d: np.sinh(d / scale) / end, slopes, 2)


SHAPES = (
    Shape('linear', None, (0.0, 0.0), 0),
    Shape('Hertzian', lambda d: d * np.sqrt(np.abs(d)), (0.0, 1.5), 1),
    Shape('quadratic', lambda d: d * np.abs(d), (0.0, 2.0), 1),
    Shape('cubic', lambda d: d**3, (0.0, 3.0), 1),
    _tanh(0.3),
    _tanh(0.6),
    _sinh(0.2),
)


@dataclass(frozen=True, slots=True)
class Model:
    """A member of the family."""

    shape: Shape
    gap: Gap

    @property
    def name(self) -> str:
        """Of the model, in a report."""
        middle = {Gap.NONE: 'no play', Gap.PLAY: 'play', Gap.SOFT: 'soft middle'}[self.gap]
        return f'{self.shape.name} spring, {middle}'

    @property
    def size(self) -> int:
        """Number of its parameters, beside a linear spring's."""
        return self.shape.parameters + int(self.gap)


class Fit(NamedTuple):
    """A model that fits all loops together."""

    errors: Array
    """(loops,), mean square of the load of each loop, predicted by the others, (N·m)²."""
    centre: float
    """rad, of the gap."""
    gap: float
    """rad."""


class Springs(NamedTuple):
    """A model fitted to each loop, (loops,) each."""

    centre: Array
    gap: Array
    factors: Array
    """(loops, parameters)."""


class Angles(NamedTuple):
    """Angles of loops as shares of half of a loop's, (places, loops, angles)."""

    off: Array
    """From the middle of the gap."""
    above: Array
    """Beyond the gap on the positive side; 0 elsewhere. Then those on the negative side."""
    below: Array


class Fitting:
    """Fits models to middle lines."""

    def __init__(self, lines: Midlines) -> None:
        """Use the loops of one amplitude."""
        self._angle, self._load = lines.angle, lines.load
        self._reach = lines.reach
        self._each: dict[Model, Springs] = {}
        self._first: dict[bool, tuple[Array, Angles]] = {}

    def fit(self, model: Model) -> Fit | None:
        """Fit a model to all loops, and each loop by the others; None if it cannot be.

        At least two loops are needed.
        """
        search = _Search(self, model)
        for _ in range(_REFINEMENTS):
            if not search.refine():
                return None
        return search.found()

    def each(self, model: Model, start: Fit) -> Springs:
        """Fit a model to each loop, by Gauss and Newton's method from the fit to all of them."""
        if model not in self._each:
            self._each[model] = self._fitted(model, start)
        return self._each[model]

    def _fitted(self, model: Model, start: Fit) -> Springs:
        loops = len(self._load)
        places = np.array([[start.centre] * loops, [start.gap] * loops])
        free = [0, 1] if model.gap else [0]
        state = self._one_by_one(model, places)
        damping = np.full(loops, 1e-3)
        step = 1e-4 * self._reach
        for _ in range(_ITERATIONS):
            moved = [_columns(model, self.angles(*_shifted(places, k, step))) for k in free]
            slopes = [
                np.einsum('knp,kp->kn', (columns[0] - state.columns) / step, state.factors)
                for columns in moved
            ]
            change = _steps(np.stack(slopes, -1), state, damping)
            tried = places.copy()
            tried[free] += change.T
            tried[1] = np.maximum(tried[1], 0.0)
            better = self._one_by_one(model, tried).cost < state.cost
            places = np.where(better, tried, places)
            state = self._one_by_one(model, places)
            damping = np.where(better, 0.3 * damping, 10.0 * damping)
        return Springs(places[0], places[1], state.factors)

    def load(self, model: Model, springs: Springs, angle: Array) -> Array:
        """Loads of the springs of loops, (loops, angles), N·m, at angles of the same shape."""
        places = springs.centre[None], springs.gap[None]
        columns = _columns(model, _angles(angle[None], *places, self._reach))
        load: Array = np.einsum('knp,kp->kn', columns[0], springs.factors)
        return load

    def normal(self, model: Model, angles: Angles) -> tuple[Array, Array]:
        """Return normal equations for each place and loop: matrices and right sides."""
        columns = _columns(model, angles)
        transposed = columns.swapaxes(2, 3)
        return transposed @ columns, (transposed @ self._load[None, :, :, None])[..., 0]

    def solve(
        self, model: Model, matrix: Array, right: Array, squares: float
    ) -> tuple[Array, Array]:
        """Solve normal equations; returns factors, and sums of squares or infinity."""
        factors = _solved(matrix, right)
        cost = (
            squares
            - 2.0 * np.sum(right * factors, axis=1)
            + np.einsum('gp,gpq,gq->g', factors, matrix, factors)
        )
        return factors, np.where(_rises(model, factors), cost, np.inf)

    def first(self, model: Model) -> tuple[Array, Angles]:
        """Return the places to try first, centres and gaps in rad, and the angles there."""
        wide = bool(model.gap)
        if wide not in self._first:  # the same for all shapes
            places = self._reach * _grid(_CENTRES, _GAPS if wide else np.zeros(1))
            self._first[wide] = places, self.angles(*places[..., None])
        return self._first[wide]

    def angles(self, centre: Array, gap: Array) -> Angles:
        """Return the angles of the loops at places, (places, loops) or (places, 1), rad."""
        return _angles(self._angle[None], centre, gap, self._reach)

    @property
    def squares(self) -> Array:
        """(loops,), sums of the squares of the loads."""
        return np.asarray(np.sum(self._load**2, axis=1))

    @property
    def levels(self) -> int:
        """Number of angles of a loop."""
        return int(self._load.shape[1])

    def _one_by_one(self, model: Model, places: Array) -> '_State':
        columns = _columns(model, self.angles(places[:1], places[1:]))[0]
        transposed = columns.swapaxes(1, 2)
        factors = _solved(transposed @ columns, (transposed @ self._load[:, :, None])[..., 0])
        rest = self._load - np.einsum('knp,kp->kn', columns, factors)
        return _State(columns, factors, rest, np.sum(rest**2, axis=1))


class _State(NamedTuple):
    """Fits to single loops."""

    columns: Array
    factors: Array
    rest: Array
    cost: Array


class _Search:
    """A search over the places of the gap."""

    def __init__(self, fitting: Fitting, model: Model) -> None:
        self._fitting, self._model = fitting, model
        self._parts: list[tuple[Array, Array, Array]] = []
        places, angles = fitting.first(model)
        self._steps = [float(np.ptp(np.unique(values)[:2])) for values in places]
        self._try(places, angles)

    def _try(self, places: Array, angles: Angles) -> None:
        self._parts.append((*self._fitting.normal(self._model, angles), places.T))

    def refine(self) -> bool:
        """Try places around the best one; returns whether there is one."""
        matrix, right, places = map(np.concatenate, zip(*self._parts, strict=True))
        _, cost = self._fitting.solve(
            self._model, matrix.sum(1), right.sum(1), float(self._fitting.squares.sum())
        )
        if not np.isfinite(cost).any():
            return False
        best = places[np.argmin(cost)]
        centres, gaps = (
            np.unique(value + step * _FINER) for value, step in zip(best, self._steps, strict=True)
        )
        nearby = _grid(centres, np.unique(np.maximum(gaps, 0.0)))
        self._try(nearby, self._fitting.angles(*nearby[..., None]))
        self._steps = [0.3 * step for step in self._steps]
        return True

    def found(self) -> Fit:
        """Return the best fit, and how it predicts each loop by the others."""
        matrix, right, places = map(np.concatenate, zip(*self._parts, strict=True))
        fitting, model = self._fitting, self._model
        whole, sides, squares = matrix.sum(1), right.sum(1), float(fitting.squares.sum())
        _, cost = fitting.solve(model, whole, sides, squares)
        errors = []
        for k, own in enumerate(fitting.squares.tolist()):
            factors, others = fitting.solve(
                model, whole - matrix[:, k], sides - right[:, k], squares - own
            )
            best = int(np.argmin(others))
            by = factors[best]
            errors.append(own - 2.0 * by @ right[best, k] + by @ matrix[best, k] @ by)
        centre, gap = places[np.argmin(cost)].tolist()
        return Fit(np.array(errors) / fitting.levels, centre, gap)


def _grid(centres: Array, gaps: Array) -> Array:
    return np.array(np.meshgrid(centres, gaps)).reshape(2, -1)


def _angles(angle: Array, centre: Array, gap: Array, reach: float) -> Angles:
    off = angle - centre[..., None]
    half, width = 0.5 * gap[..., None], np.ptp(angle, -1, keepdims=True) / (angle.shape[-1] - 1)
    above, below = _mean_beyond(off - half, width), -_mean_beyond(-off - half, width)
    return Angles(off / reach, above / reach, below / reach)


def _columns(model: Model, angles: Angles) -> Array:
    """Return what the factors of a model multiply, (places, loops, angles, parameters)."""
    beyond = angles.above + angles.below
    columns = [np.ones_like(beyond), angles.above, angles.below]
    if model.shape.function:
        columns.append(model.shape.function(beyond))
    if model.gap == Gap.SOFT:
        columns.append(angles.off - beyond)
    return np.stack(columns, -1)


def _mean_beyond(angle: Array, width: Array) -> Array:
    """Mean of the positive part of an angle over a width around it."""
    near = np.clip(angle, -0.5 * width, 0.5 * width)
    return np.asarray((near + 0.5 * width) ** 2 / (2.0 * width) + np.maximum(angle - near, 0.0))


def _rises(model: Model, factors: Array) -> NDArray[np.bool_]:
    """Whether the loads grow with the angle everywhere, and in a gap no faster than beside it."""
    bent = factors[..., [_SIDES]] if model.shape.function else 0.0
    first, last = (factors[..., 1:_SIDES] + slope * bent for slope in model.shape.slopes)
    slopes = [first, last]
    if model.gap == Gap.SOFT:
        slopes += [factors[..., [-1]], first - factors[..., [-1]]]
    return np.asarray(np.all(np.concatenate(slopes, -1) >= 0.0, axis=-1))


def _solved(matrix: Array, right: Array) -> Array:
    """Solve normal equations, scaled so that their diagonals are 1."""
    scale = np.sqrt(np.maximum(np.einsum('...pp->...p', matrix), np.finfo(float).tiny))
    scaled = matrix / scale[..., :, None] / scale[..., None, :]
    scaled = scaled + _RIDGE * np.eye(matrix.shape[-1])
    factors: Array = np.linalg.solve(scaled, (right / scale)[..., None])[..., 0] / scale
    return factors


def _shifted(places: Array, row: int, step: float) -> Iterator[Array]:
    moved = places.copy()
    moved[row] += step
    return iter((moved[:1], moved[1:]))


def _steps(slopes: Array, state: _State, damping: Array) -> Array:
    """Solve for the changes of the places, (loops, places); K. Levenberg, D. W. Marquardt."""
    whole = np.concatenate([slopes, state.columns], -1)
    scale = np.linalg.norm(whole, axis=1) + np.finfo(float).tiny
    whole = whole / scale[:, None]
    transposed = whole.swapaxes(1, 2)
    matrix = transposed @ whole + damping[:, None, None] * np.eye(whole.shape[2])
    change: Array = np.linalg.solve(matrix, transposed @ state.rest[:, :, None])[..., 0] / scale
    return change[:, : slopes.shape[2]]
