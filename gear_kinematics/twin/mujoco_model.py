# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A model simulated by MuJoCo: every body, with its joints, springs and loops."""

import mujoco
import numpy as np

from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.mjcf import mjcf

_FASTEST = 0.14  # rad a time step; beyond, closing the loops feeds in energy
mujoco.set_mju_user_warning(lambda _: None)  # else MUJOCO_LOG.TXT in the current folder
mujoco.set_mjcb_time(None)  # reading the clock in each step takes a tenth of its time


class MujocoModel:
    """Implements `TwinModel` with MuJoCo; it begins at rest, without load, at φ2 = 0.

    Raises MechanismError as `mjcf` does.
    """

    def __init__(self, gear: TwinGear) -> None:
        self.notice = ''
        self.rotor_locked = self.output_locked = False
        self._owed = 0.0  # time that is still to be simulated, s
        self._build(gear)

    @property
    def gear(self) -> TwinGear:
        """The simulated gear; a replacement must have the same mechanism."""
        return self._gear

    @gear.setter
    def gear(self, gear: TwinGear) -> None:
        before = self.data
        self._build(gear)
        self.data.qpos[:], self.data.qvel[:] = before.qpos, before.qvel
        self._read()

    def advance(self, duration: float, rotor_torque: float, load_torque: float) -> None:
        """Advance the time, to the nearest time step of MuJoCo; see `TwinModel`."""
        self._lock(self._rotor, self._rotor_lock, self.rotor_locked)
        self._lock(self._output, self._output_lock, self.output_locked)
        self._applied[self._rotor], self._applied[self._output] = rotor_torque, load_torque
        self._owed += duration
        steps = round(self._owed / self._step)
        self._owed -= steps * self._step
        if self._gear.errors:
            for _ in range(steps):
                error = self._gear.error(self._angles.item(self._rotor))
                np.subtract(self._springs, error, out=self._lengths)
                mujoco.mj_step(self.model, self.data)
        elif steps:
            mujoco.mj_step(self.model, self.data, steps)
        self._bound()
        self._read()

    def _bound(self) -> None:
        """Keep the speed within what MuJoCo follows: all velocities at once, as the loops ask."""
        fastest = _FASTEST / self._step
        if any(self._warnings.tolist()):
            self.notice = 'the motion exceeded what MuJoCo can follow, and starts anew'
            mujoco.mj_resetData(self.model, self.data)
        elif (speed := abs(self._velocities.item(self._rotor))) > fastest:
            self.notice = f'the rotor is limited to the {fastest:.0f} rad/s that MuJoCo can follow'
            self._velocities *= fastest / speed

    def _build(self, gear: TwinGear) -> None:
        self._gear = gear
        self.model = mujoco.MjModel.from_xml_string(mjcf(gear, shown=False))
        # What the sensors of the file say is not read here.
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_SENSOR
        self.data = mujoco.MjData(self.model)
        self._step = self.model.opt.timestep
        # Views of what MuJoCo reads and writes, as each access by name takes longer than its use.
        self._angles, self._velocities = self.data.qpos, self.data.qvel
        self._applied, self._active = self.data.qfrc_applied, self.data.eq_active
        self._friction, self._warnings = self.model.dof_frictionloss, self.data.warning.number
        self._lengths = self.model.tendon_lengthspring[int(gear.has_shaft) :]  # of the branches
        self._springs = self._lengths.copy()
        branches = gear.parameters.branches
        # Each joint has one coordinate.
        self._rotor, self._output, *self._satellites = (
            self.model.joint(name).id
            for name in ('rotor', 'output_shaft', *(f'satellite_{each.name}' for each in branches))
        )
        self._rotor_lock, self._output_lock = (
            self.model.equality(f'{name}_lock').id for name in ('rotor', 'output_shaft')
        )
        self._read()

    def _lock(self, joint: int, equality: int, locked: bool) -> None:  # noqa: FBT001
        """Lock a joint at its present angle, or release it."""
        if self._active.item(equality) != locked:
            if locked:
                self.model.eq_data[equality, 0] = self._angles[joint] - self.model.qpos0[joint]
                self._velocities[joint] = 0.0
            self._active[equality] = locked

    def _read(self) -> None:
        angles, velocities, gear = self._angles.tolist(), self._velocities.tolist(), self._gear
        self.rotor_angle, self.rotor_velocity = angles[self._rotor], velocities[self._rotor]
        self.output_angle, self.output_velocity = angles[self._output], velocities[self._output]
        self._turned = [angles[joint] for joint in self._satellites]
        if gear.curve:  # which the friction follows, slowly, as the output moves on a spring
            self._friction[self._output] = self._torques()[1]

    @property
    def branch_torques(self) -> tuple[float, ...]:
        """See `TwinModel`."""
        return self._torques()[0]

    def _torques(self) -> tuple[tuple[float, ...], float]:
        """Compute the torques and the friction, N·m, where they are asked for."""
        gear = self._gear
        ideal = (1.0 / gear.ratio - 1.0) * self.rotor_angle + gear.error(self.rotor_angle)
        return gear.torques([ideal - turned for turned in self._turned])


def check(text: str) -> None:
    """Load a model to check it; raises ValueError if MuJoCo refuses it."""
    mujoco.MjModel.from_xml_string(text)
