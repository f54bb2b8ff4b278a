# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Selection of the terms of a calibration by how well they predict blocks left out.

Terms are removed unless each improves the prediction of blocks left out by more than one standard
error of the paired differences of the blocks (T. Hastie, R. Tibshirani, J. Friedman, The Elements
of Statistical Learning, 2nd ed., 2009, sections 3.3.2, 7.10).
"""

from collections.abc import Sequence
from itertools import islice

import numpy as np
from scipy.optimize import lsq_linear

from gear_kinematics.correction.calibration_file import Stop
from gear_kinematics.measurement.calibration.terms import Term
from gear_kinematics.measurement.recording import Array
from gear_kinematics.statistics.normal_equations import NormalEquations
from gear_kinematics.statistics.uncertainty import standard_error, student_t

TOGETHER = (1, 2, 4)
"""Numbers of successive blocks that are taken as one, in case neighbours are correlated."""
_MAX_DEGREES = 10**9  # of freedom


def is_as_good(errors: Array, best: Array) -> bool:
    """Whether errors of blocks are no greater than others by more than a standard error."""
    difference = errors - best
    return bool(difference.mean() <= standard_error(difference, TOGETHER)[0])


def widening(errors: Array) -> float:
    """Factor by which an interval has to be wider because its width is an estimate itself.

    Student's t for the degrees of freedom with which the blocks' mean squares `errors` determine
    their mean (F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110), over the normal quantile.
    """
    variance = (standard_error(errors, TOGETHER)[0] / float(errors.mean())) ** 2
    degrees = 2.0 / max(variance, 1.0 / _MAX_DEGREES)
    return student_t(max(1, int(degrees))) / student_t(_MAX_DEGREES)


def select(equations: NormalEquations, terms: Sequence[Term], own: Sequence[int]) -> list[int]:
    """Choose among terms, whose columns are the first ones of the equations, in order.

    A leading trend stays: any output has errors that vary slowly with its angle, and limit where
    others hold.

    Args:
        equations: with single blocks as folds.
        terms: candidates.
        own: columns that are always fitted.
    """
    places = iter(range(len(own) + sum(len(term.coefficients) for term in terms)))
    columns = [list(islice(places, len(term.coefficients))) for term in terms]

    def errors(chosen: Sequence[int]) -> Array:
        return equations.errors([*(place for k in chosen for place in columns[k]), *own])

    # The output lags by hysteresis, so that no coefficient of a stop operator is positive.
    lags = [isinstance(term.entry, Stop) for term in terms for _ in term.coefficients]
    most = np.where([*lags, *(False for _ in own)], 0.0, np.inf)
    root = np.linalg.cholesky(equations.regular(range(len(most)))[0])
    right = np.linalg.solve(root, equations.products[0, :-1, -1])
    fitted = lsq_linear(root.T, right, (-np.inf, most), method='bvls')
    path = [[k for k, place in enumerate(columns) if fitted.active_mask[place[0]] == 0]]
    fixed = int(bool(terms) and terms[0].is_trend)
    while len(path[0]) > fixed:
        smaller = [[k for k in path[0] if k != gone] for gone in path[0] if gone >= fixed]
        path.insert(0, min(smaller, key=lambda chosen: float(errors(chosen).mean())))
    every = [errors(chosen) for chosen in path]
    best = min(every, key=lambda error: float(error.mean()))
    return next(c for c, error in zip(path, every, strict=True) if is_as_good(error, best))
