# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The preload of two branches braced against each other: lossless statics.

Turning the ring gear of one branch against the other's closes the backlash; a further turn dψ_net
twists the shaft between the two arms:

    T0 = (zk/zs) dψ_net / (1/kA + 1/kB + 1/ks)        N·m in both branches without load

kA, kB are the torsional stiffnesses of the branches as seen at their arms, ks that of the shaft
between the arms, N·m/rad. An external torque M acts at arm B, which is the output. It is
positive in the direction in which branch A pushes the output and in which ring A is turned against
ring B. With kAe = kA ks/(kA + ks),

    T_A = T0 - kAe M/(kAe + kB)         T_B = T0 + kB M/(kAe + kB)        T_B - T_A = M

until a branch leaves mesh, A at M = T0 (1 + kB/kAe), B at M = -T0 (1 + kAe/kB). Beyond this
threshold it carries nothing and the other carries M alone, until its opposite flanks touch. As a
stiffness may be infinite, the formulas below are written with compliances,

    cA = 1/kAe = 1/kA + 1/ks        cB = 1/kB        kAe/(kAe + kB) = cB/(cA + cB)

The flanks of a branch that has left mesh stand apart by the angle by which the other branch and
the shaft yield beyond the interference (zk/zs) dψ_net, rad at the output:

    A: cB M - (zk/zs) dψ_net            B: -cA M - (zk/zs) dψ_net
"""

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.errors import MechanismError
from gear_kinematics.kinematics.mechanism import Branch, Mechanism
from gear_kinematics.kinematics.rotor_turns import lists_as_arrays
from gear_kinematics.kinematics.vernier import angle_between, turns

Pair = tuple[Any, Any]

STEEL_SHEAR_MODULUS = 79.3e9
"""G of steel, Pa."""


def shaft_stiffness(
    diameter: float, length: float, shear_modulus: float = STEEL_SHEAR_MODULUS
) -> float:
    """Compute the torsional stiffness of a solid round shaft, ks = G J/L, J = π d⁴/32, N·m/rad.

    Args:
        diameter: diameter d, m.
        length: length L between the arms, m.
        shear_modulus: shear modulus G, Pa.

    Raises:
        MechanismError: if an argument is not finite or not greater than 0.
    """
    given = {'diameter': diameter, 'length': length, 'shear modulus': shear_modulus}
    if faults := [
        f'{name} must be finite and greater than 0, not {value!r}'
        for name, value in given.items()
        if not 0.0 < value < math.inf
    ]:
        raise MechanismError(faults)
    return shear_modulus * math.pi * diameter**4 / 32.0 / length


def braced(mechanism: Mechanism) -> tuple[Branch, Branch]:
    """Branches A and B.

    Raises:
        MechanismError: unless the mechanism has exactly two branches.
    """
    if (count := len(mechanism.branches)) != 2:  # noqa: PLR2004, A and B
        raise MechanismError([f'exactly two branches are needed, not {count}'])
    branch_a, branch_b = mechanism.branches
    return branch_a, branch_b


def ring_phase(mechanism: Mechanism) -> float:
    """ψ_B - ψ_A = [(zk - zs)(α_B - α_A) mod 2π] / zk: the turn of ring B for its cam phase.

    Branch k meshes if zk (φ2 + α_k - ψ_k) - zs (φ2 + α_k - φ5 - s_k) ≡ 0 (mod 2π), with ψ_k the
    turn of its ring gear, and s_k that of its satellite's teeth, which is equal in both branches.

    Returns:
        rad, in ±π/zk, half a tooth pitch; any number of tooth pitches may be added.

    Raises:
        MechanismError: unless there are two branches.
    """
    return ring_turn_between(mechanism, *(branch.cam_phase for branch in braced(mechanism)))


def ring_turn_between(mechanism: Mechanism, cam_phase_a: float, cam_phase_b: float) -> float:
    """Compute `ring_phase` for two given cam phases α, rad."""
    cam_a, cam_b = turns(cam_phase_a), turns(cam_phase_b)
    teeth = mechanism.ring_teeth - mechanism.satellite_teeth
    return angle_between(teeth * cam_a, teeth * cam_b) / mechanism.ring_teeth


@dataclass(frozen=True, slots=True)
class Stiffness:
    """Torsional stiffnesses, N·m/rad at the output; `math.inf` is rigid.

    Raises:
        MechanismError: if one is not greater than 0, or if all are infinite.
    """

    branch_a: float
    """Stiffness kA of branch A, from the stator to arm A while the rotor is locked."""
    branch_b: float
    """Stiffness kB of branch B, from the stator to arm B, which is the output."""
    shaft: float
    """Stiffness ks of the shaft between the arms."""

    def __post_init__(self) -> None:
        """List all faults."""
        given = {'branch a': self.branch_a, 'branch b': self.branch_b, 'shaft': self.shaft}
        faults = [
            f'the stiffness of {name} must be greater than 0, not {value!r}'
            for name, value in given.items()
            if not value > 0.0
        ]
        if not faults and not 0.0 < self.compliance < math.inf:
            faults = ['branches and shaft must neither all be rigid nor have infinite compliance']
        if faults:
            raise MechanismError(faults)

    @property
    def compliance_a(self) -> float:
        """Compliance cA = 1/kA + 1/ks of branch A and the shaft, seen from arm B, rad/(N·m)."""
        return 1.0 / self.branch_a + 1.0 / self.shaft

    @property
    def compliance_b(self) -> float:
        """Compliance cB = 1/kB of branch B, rad/(N·m)."""
        return 1.0 / self.branch_b

    @property
    def compliance(self) -> float:
        """Compliance 1/kA + 1/kB + 1/ks of the loop that the preload twists, rad/(N·m)."""
        return self.compliance_a + self.compliance_b

    @property
    def both_in_mesh(self) -> float:
        """Output stiffness kAe + kB while both branches are in mesh, N·m/rad."""
        return self.branch_b_alone + self.branch_a_alone

    @property
    def branch_b_alone(self) -> float:
        """Output stiffness kB while branch A is out of mesh, N·m/rad."""
        return self.branch_b

    @property
    def branch_a_alone(self) -> float:
        """Output stiffness kAe while branch B is out of mesh, N·m/rad."""
        return 1.0 / self.compliance_a if self.compliance_a else math.inf


class TorqueSplit(NamedTuple):
    """Response to an external torque, in arrays of the torque's shape."""

    branch_a: NDArray[np.float64]
    """Torque T_A of branch A, N·m, at least 0; 0 when the branch is out of mesh."""
    branch_b: NDArray[np.float64]
    """Torque T_B of branch B, N·m, at least 0; 0 when the branch is out of mesh."""
    output_turn: NDArray[np.float64]
    """Turn of arm B from its unloaded position, or from the middle of its play, rad."""


@dataclass(frozen=True, slots=True)
class Preload:
    """Two branches braced against each other.

    Raises:
        MechanismError: if `interference` is not finite.
    """

    stiffness: Stiffness
    interference: float
    """(zk/zs) dψ_net, rad: the twist of the loop at the arms; if negative, the remaining play."""
    _constants: tuple[float, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Refuse an interference that is not finite, and compute what each load needs."""
        if not math.isfinite(self.interference):
            raise MechanismError([f'an interference must be finite, not {self.interference!r}'])
        cA, cB = self.stiffness.compliance_a, self.stiffness.compliance_b
        both = self.stiffness.compliance
        # M relieves branch A by the first share and loads branch B by the second one.
        object.__setattr__(self, '_constants', (cA, cB, cB / both, cA / both, self.torque))

    @classmethod
    def from_ring_turn(
        cls, mechanism: Mechanism, stiffness: Stiffness, ring_turn: float, backlash: float = 0.0
    ) -> Self:
        """Compute the preload that results from turning the rings against each other.

        dψ_net = abs(dψ) - (zs/zk) backlash.

        Args:
            mechanism: determines zk/zs.
            stiffness: stiffnesses of the branches and the shaft.
            ring_turn: turn dψ of one ring gear against the other, rad, in either direction.
            backlash: play of the output at a ring turn of 0, rad.
        """
        ratio = mechanism.ring_teeth / mechanism.satellite_teeth
        return cls(stiffness, ratio * abs(ring_turn) - _not_negative('backlash', backlash))

    @classmethod
    def from_torque(cls, stiffness: Stiffness, torque: float) -> Self:
        """Create the preload with the torque T0, N·m, ≥ 0."""
        return cls(stiffness, _not_negative('preload', torque) * stiffness.compliance)

    @classmethod
    def from_limit(cls, stiffness: Stiffness, limit: float) -> Self:
        """Compute the least preload that keeps both branches in mesh while abs(M) < `limit`."""
        softer = max(stiffness.compliance_a, stiffness.compliance_b)
        return cls(stiffness, _not_negative('threshold', limit) * softer)

    def ring_turn(self, mechanism: Mechanism, backlash: float = 0.0) -> float:
        """Compute dψ = (zs/zk)(interference + backlash), rad: the inverse of `from_ring_turn`."""
        ratio = mechanism.satellite_teeth / mechanism.ring_teeth
        return ratio * (self.interference + _not_negative('backlash', backlash))

    @property
    def torque(self) -> float:
        """Torque T0 in both branches without load, N·m; 0 if there is play."""
        return self._twist / self.stiffness.compliance

    @property
    def play(self) -> float:
        """Angle by which the output turns freely, rad; 0 if there is preload."""
        return max(-self.interference, 0.0)

    @property
    def threshold_a(self) -> float:
        """Load M at which branch A leaves mesh, N·m: T0 (1 + kB/kAe) = T0 (cA + cB)/cB."""
        return self._load_at(self.stiffness.compliance_b)

    @property
    def threshold_b(self) -> float:
        """Load M at which branch B leaves mesh, N·m: -T0 (1 + kAe/kB) = -T0 (cA + cB)/cA."""
        return -self._load_at(self.stiffness.compliance_a)

    @property
    def limit(self) -> float:
        """Least abs(M) at which a branch leaves mesh, N·m: T0 (kAe + kB)/max(kAe, kB)."""
        return min(self.threshold_a, -self.threshold_b)

    def split(self, load: 'ArrayLike') -> TorqueSplit:
        """Split an external torque between the branches.

        Args:
            load: external torque M at arm B, N·m, of any shape.
        """
        M = np.asarray(load, dtype=np.float64)
        cA, cB = self.stiffness.compliance_a, self.stiffness.compliance_b
        (branch_a, branch_b), _ = self.contacts(M)
        elastic = np.where(
            self.threshold_b <= M, cB * (branch_b - self.torque), cA * (self.torque - branch_a)
        )
        free = np.sign(M) * self.play / 2.0
        return TorqueSplit(branch_a, branch_b, elastic + free + 0.0)  # no -0.0

    def contacts(self, M: Any) -> tuple[Pair, Pair]:
        """Compute torques of A and B, N·m, and angles between their flanks, rad at the output.

        All are at least 0. Each torque is the greatest of its values with both branches in mesh,
        with A alone and with B alone. Without load, each branch has half of the play. Floats and
        arrays give the same results to the bit.
        """
        M = lists_as_arrays(M)
        cA, cB, share_a, share_b, T0 = self._constants
        larger, interference = _larger(M), self.interference
        torque_a = larger(larger(T0 - share_a * M, -M), 0.0) + 0.0  # no -0.0
        torque_b = larger(larger(T0 + share_b * M, M), 0.0) + 0.0
        out_a, out_b = torque_a == 0.0, torque_b == 0.0  # both: each has half of the play
        apart_a = abs(cB * M - interference) * (out_a / (1.0 + out_b))  # abs, for rounding
        apart_b = abs(cA * M + interference) * (out_b / (1.0 + out_a))
        return (torque_a, torque_b), (apart_a, apart_b)

    def margin(self, M: Any) -> Any:
        """Preload that a load leaves in the branch it relieves, N·m; below 0 out of mesh."""
        M = lists_as_arrays(M)
        _, _, share_a, share_b, T0 = self._constants
        return T0 - _larger(M)(share_a * M, -share_b * M)

    @property
    def _twist(self) -> float:
        return max(self.interference, 0.0)

    def _load_at(self, compliance: float) -> float:
        """Compute the load that twists a part of this compliance by the interference."""
        if self._twist == 0.0:
            return 0.0
        return self._twist / compliance if compliance else math.inf


def _larger(M: Any) -> Any:
    return np.maximum if isinstance(M, np.ndarray) else max


def _not_negative(name: str, value: float) -> float:
    if not 0.0 <= value < math.inf:
        raise MechanismError([f'{name} must be finite and not negative, not {value!r}'])
    return value
