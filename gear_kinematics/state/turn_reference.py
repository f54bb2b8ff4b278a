# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the rotor's turns by an absolute encoder at the output, and watches that they agree.

An encoder that is absolute within a turn leaves the turn of the output open. `output_range`
determines it, and excludes angles that the output cannot have.

The rotor angle is 2π k + a with a known angle a and an unknown integer k. With i = N/D in lowest
terms, the output angle within its turn, 2π k D/N + a D/N modulo 2π, takes |N| values that are
2π/|N| apart, so that it tells k modulo |N|, which is D turns of the output.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.transmission_error import ErrorBlock, ErrorSample
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN, repeated
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.batches import Array

_ALIKE = 1.5  # greatest ratio of the budgets of two blocks at rest
_BACK = 0.1  # rad, of the rotor: greatest sum of jumps there and back


def range_fault(
    parameters: NodeParameters, angle: float, tolerance: float, period: float = math.inf
) -> Fact | None:
    """Return how an output angle within a tolerance contradicts the range, if it does.

    Where the angle repeats after a period, rad, both ends of the range may be possible.
    """
    if not parameters.output_range:
        return None
    low, high = parameters.output_range
    possible = [
        low - tolerance <= each <= high + tolerance
        for each in (angle, angle - period, angle + period)
    ]
    if possible == [True, False, False]:
        return None
    which = Condition.AT_EITHER_END if possible[0] else Condition.OUTSIDE
    at, low, high = (math.degrees(each) for each in (angle, low, high))
    return which(angle_deg=at, low_deg=low, high_deg=high)


def farthest_outside(
    parameters: NodeParameters, turns: Array, angle: Array, referenced: Array
) -> Fact | None:
    """Return how the output's angle that is farthest from the range contradicts it, if it does.

    Turns and angle, rad, are those of the rotor, and those that are not referenced are left out;
    all are (n,).
    """
    if not (parameters.output_range and referenced.any()):
        return None
    angles = (TURN * turns + angle)[referenced] / float(parameters.gear.gear_ratio)
    middle = sum(parameters.output_range) / 2.0
    farthest = float(angles[np.argmax(np.abs(angles - middle))])
    return range_fault(parameters, farthest, parameters.transmission_error_limit)


class Decision(NamedTuple):
    """The evidence of a block of errors on the turns: angles of the output, rad."""

    output_angle: float  # ideal, of the last one
    error: float  # measured less ideal angle, modulo 2π
    turns: int  # or other periods of the rotor's encoder, to add to its count
    distance: float  # what they leave of the error
    budget: float  # what measured and true angle may differ by
    slow: bool  # whether a delay explains no more of it than the gear
    margin: float  # of which the budget must be less, as it could explain other turns
    tolerance: float  # beyond which the error contradicts a count that is known
    measured: float  # of the last one, in the turn that the turns or the range tell
    outside: Fact | None  # how the measured angle contradicts output_range, if it does

    @property
    def used(self) -> float:
        """The used part of the margin: the distance if it is unexplained, else the budget."""
        return max(abs(self.distance), self.budget)

    @property
    def unambiguous(self) -> bool:
        """Whether the budget explains the distance of these turns, and that of no others."""
        return abs(self.distance) <= self.budget < self.margin and not self.outside

    @property
    def refuted(self) -> bool:
        """Whether the errors exclude the turns, rather than leave two places for them."""
        either = self.outside and self.outside.condition is Condition.AT_EITHER_END
        return self.budget < self.margin and not (self.unambiguous or either)

    @property
    def disagreement(self) -> Fact | None:
        """How the encoder contradicts the rotor's count, if it does."""
        apart = self.measured - self.output_angle
        if self.outside or abs(apart) <= self.tolerance:
            return self.outside
        encoder, rotor = math.degrees(self.measured), math.degrees(self.output_angle)
        return Condition.DISAGREES(encoder_deg=encoder, rotor_deg=rotor)


def nearest_turns(ratio: GearRatio, error: float) -> tuple[int, float]:
    """Find the turns of the rotor, in (-|N|/2, |N|/2], that best explain an error of the output.

    Returns the turns to add to the rotor's count, and what they leave of the error, rad.
    """
    n = abs(ratio.numerator)
    # Turns of the rotor by which the output angle changes by one step; pow(..., 1) is 0.
    turns_per_step = pow(ratio.denominator if ratio.numerator > 0 else -ratio.denominator, -1, n)
    steps = math.floor(error * n / TURN + 0.5)
    turns = steps * turns_per_step % n
    return turns - n * (2 * turns > n), error - TURN * steps / n


def decide(
    samples: Sequence[ErrorSample], parameters: NodeParameters, unseen: float = 0.0
) -> Decision:
    """Decide by errors between which no motion is unknown.

    Without an `output_range`, the turn of the output is the nearest to that of the count, or to 0
    if the rotor can have turned half of what the encoder at the output tells, by the `unseen`
    travel, rad.
    """
    # Play and transmission error: what is in order, peak to peak, as the zero of the encoder may
    # be anywhere in it.
    errors, known = [sample.error for sample in samples], parameters.transmission_error_limit
    widest = max(sample.half_width for sample in samples)
    period, ratio = parameters.rotor_period, parameters.gear.gear_ratio
    if period and not math.isnan(widest):
        # The calibration tells both; it needs the rotor angle, at least within the turn.
        errors, known = [sample.error - sample.deviation for sample in samples], widest
    offsets = [math.remainder(error - errors[0], TURN) for error in errors]
    offset = math.fsum(offsets) / len(offsets)
    # Noise: the true mean is somewhere in the range of the samples.
    scatter = max(max(offsets) - offset, offset - min(offsets))
    delay = max(abs(sample.speed) for sample in samples) * parameters.transmission_error_max_gap
    error, budget = errors[0] + offset, known + scatter + delay
    angle = TURN * samples[-1].turns + samples[-1].ideal
    repeats = TURN * ratio.denominator if parameters.single_turn else TURN
    known_turn = not parameters.output_range and unseen < 0.5 * repeats * abs(float(ratio))
    centre = angle if known_turn else sum(parameters.output_range) / 2.0
    if parameters.single_turn:
        turns, distance = nearest_turns(ratio, error)
        if not known_turn:
            periods = (angle - centre) / repeats + turns / ratio.numerator
            turns -= ratio.numerator * round(periods)
        measured = angle + TURN * (turns * ratio.denominator / ratio.numerator) + distance
        margin = math.pi / abs(ratio.numerator)
    else:
        measured = centre + math.remainder(angle + error - centre, TURN)
        # Any angle has its zero: wait until noise and delay are less than the gear's error. A zero
        # that was found so is as uncertain.
        turns, distance, margin = 0, 0.0, 2.0 * known
        if period:
            step = period / float(ratio)
            turns = round((measured - angle) / step)
            distance, margin = measured - angle - turns * step, 0.5 * min(abs(step), TURN)
    tolerance = budget if period else budget + margin
    outside = range_fault(parameters, measured, budget, repeats) if budget < margin else None
    slow = delay <= known
    return Decision(
        angle, error, turns, distance, budget, slow, margin, tolerance, measured, outside
    )


class TurnReference:
    """Follows the errors of the output, and references the rotor's count where it is unambiguous.

    The count of a single-turn encoder gets turns, which is exact: of all that are the same modulo
    |N| those nearest to output angle 0, or after a gap in which the rotor cannot have turned half
    of |N| turns those nearest to the count. That of an encoder with another period gets so many of
    them. A multi-turn encoder gets a zero, so that the ideal output angle is the measured one,
    within half a turn of 0; after a silence only if the old one is wrong. An `output_range` takes
    the place of the half turns about 0. A referenced count is watched, never changed.
    """

    def __init__(self, rotor_input: RotorInput) -> None:
        self.rotor = rotor_input
        self.restart()

    def restart(self) -> None:
        """Forget all errors, as the count has changed."""
        self._block = ErrorBlock(self.rotor.parameters)
        self.decision: Decision | None = None  # the latest on the present count
        self.refuted: Decision | None = None
        """The decision of the least budget that could tell the turns apart and did not explain the
        distance. In faster motion, the budget explains more."""
        self.disagreement: Fact | None = None
        """How the encoder contradicts the present count; it stays until a block that can tell the
        turns apart agrees, as one in fast motion may agree with anything."""

    @property
    def checked(self) -> bool:
        """Whether the latest block could tell whether the count is right."""
        return self.decision is not None and self.decision.budget < self.decision.margin

    def follow(
        self, samples: Sequence[ErrorSample], doubt: Callable[[], object] = lambda: None
    ) -> Sequence[ErrorSample]:
        """Take the next errors of the present count; returns the errors of known turns.

        No turns are found while there is a doubt that the errors are of one time. The next errors
        can begin a new segment, whose errors are yet to come.
        """
        referenced = self.rotor.referenced
        for sample in samples:
            if errors := self._block.add(sample):
                unseen = self.rotor.turns.unseen_travel
                least = self.refuted.budget if self.refuted else math.inf
                self.decision = decision = decide(errors, self.rotor.parameters, unseen)
                if decision.disagreement or decision.budget < decision.margin:
                    self.disagreement = decision.disagreement
                if decision.unambiguous:
                    alike = decision.budget <= min(_ALIKE * least, self.jump_margin)
                    if not referenced and alike and not doubt():
                        self._refer(decision)
                        self.restart()
                        return ()
                elif decision.refuted and decision.budget < least:
                    self.refuted = decision
        return samples if referenced else ()

    @property
    def jump_margin(self) -> float:
        """Half of the sum of jumps since the last reference, rad at the output; else infinite.

        A motion of which the budget is greater could explain the jumps, behind which an encoder
        that repeats may have another zero. Jumps there and back leave it. Nothing restricts slow
        motion, as rest would hardly tell more.
        """
        rotor, decision = self.rotor, self.decision
        gate, ratio = rotor.plausibility, float(rotor.parameters.gear.gear_ratio)
        slow = decision and decision.slow
        if slow or not gate.period or abs(gate.jumped_by) <= _BACK:
            return math.inf
        return 0.5 * abs(gate.jumped_by / ratio)

    def _refer(self, decision: Decision) -> None:
        """Add turns, or what is missing to the measured angle, to the rotor's count."""
        rotor, parameters = self.rotor, self.rotor.parameters
        if parameters.single_turn:
            rotor.refer(Condition.EXACT_TURNS(), decision.turns)
            return
        if period := parameters.rotor_period:
            rotor.refer(Condition.EXACT_PERIODS(), *repeated(decision.turns, period))
            return
        missing = decision.measured - decision.output_angle
        if abs(missing) <= decision.budget and math.isfinite(rotor.turns.unseen_travel):
            missing = 0.0
        elif not parameters.output_range:  # the count can be that of a rotor switched on elsewhere
            output_angle = decision.output_angle
            missing = math.remainder(output_angle + decision.error, TURN) - output_angle
        origin = Condition.MEASURED(uncertainty_deg=math.degrees(decision.budget))
        rotor.refer(origin, angle=parameters.gear.gear_ratio.rotor_angle(missing))
