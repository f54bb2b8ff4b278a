"""The mechanism as rigid bodies and joints in Pinocchio, compared with the closed form."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from properties import largest

from gear_kinematics.kinematics import Branch, Mechanism, solve

pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')

SAMPLES = 1500


class Chains(NamedTuple):
    """Two open chains to each coupling: by rotor and satellite, and by the output shaft."""

    model: object
    satellites: list[int]
    by_satellite: list[int]
    by_arm: list[int]


def chains(mechanism: Mechanism) -> Chains:
    """Joint positions in order: rotor, shaft, then satellite, slide, arm slide of each branch."""

    def place(x, y, z):
        return pin.SE3(np.eye(3), np.array([x, y, z]))

    model = pin.Model()
    rotor = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), 'rotor')
    shaft = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), 'output_shaft')
    result = Chains(model, [], [], [])
    e = mechanism.eccentricity
    for branch in mechanism.branches:
        phase, z = branch.cam_phase, branch.axial_position
        cam = place(-e * math.sin(phase), e * math.cos(phase), z)
        satellite = model.addJoint(rotor, pin.JointModelRZ(), cam, f'satellite_{branch.name}')
        slide = pin.JointModelPX()
        coupling = model.addJoint(satellite, slide, pin.SE3.Identity(), f'oldham_{branch.name}')
        arm = model.addJoint(shaft, pin.JointModelPY(), place(0, 0, z), f'arm_{branch.name}')
        result.satellites.append(satellite)
        result.by_satellite.append(coupling)
        result.by_arm.append(arm)
    return result


@pytest.mark.slow
@pytest.mark.parametrize('teeth', [(80, 76), (61, 58), (9, 4)], ids=str)
@pytest.mark.parametrize('count', [1, 2, 3])
def test_chains_of_rigid_bodies_move_alike(teeth, count):
    """Angles follow from the tooth numbers, slides from the state, everything else from Pinocchio.

    Both chains must arrive at the state's couplings; the slides are thereby proven too.
    """
    generator = np.random.default_rng(count)
    branches = tuple(
        Branch('abc'[k], generator.uniform(-4.0, 4.0), 0.04 - 0.03 * k) for k in range(count)
    )
    mechanism = Mechanism(*teeth, 0.0011, branches)
    structure = chains(mechanism)
    model, data = structure.model, structure.model.createData()
    zk, zs = teeth
    rotor = generator.uniform(-3.0, 3.0, (3, SAMPLES))
    shaft = -rotor * (zk - zs) / zs
    state = solve(mechanism, *rotor)
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    zeros = np.zeros((SAMPLES, count))
    # The sliding accelerations are no field of a state: from the derivatives of x' = y w zk/zs.
    w, a = rotor[1, :, np.newaxis], rotor[2, :, np.newaxis]
    slide_rates = (state.satellite_slide_velocity, state.arm_slide_velocity)
    slide_second = (
        (slide_rates[1] * w + state.arm_slide * a) * zk / zs,
        -(slide_rates[0] * w + state.satellite_slide * a) * zk / zs,
    )
    slides = ((state.satellite_slide, state.arm_slide), slide_rates, slide_second)
    joints = []
    for order in range(3):
        on_cam = zeros + (shaft - rotor)[order][:, np.newaxis]
        of_branches = np.stack([on_cam, *slides[order]], axis=-1).reshape(SAMPLES, 3 * count)
        joints.append(np.column_stack([rotor[order], shaft[order], of_branches]))

    errors: dict[str, list[float]] = {name: [] for name in ('angle', 'position', 'rate', 'second')}
    for n in range(SAMPLES):
        pin.forwardKinematics(model, data, *(values[n] for values in joints))
        for k in range(count):
            satellite = data.oMi[structure.satellites[k]].rotation
            turned = math.atan2(satellite[1, 0], satellite[0, 0])
            turned -= state.output_turn_angle[n]
            errors['angle'].append(math.remainder(turned, 2.0 * math.pi))
            for body, joint in (
                ('satellite', structure.satellites[k]),
                ('oldham', structure.by_satellite[k]),
                ('oldham', structure.by_arm[k]),
            ):
                rate = pin.getVelocity(model, data, joint, world).linear
                second = pin.getClassicalAcceleration(model, data, joint, world).linear
                for name, value, expected in (
                    ('position', getattr(state, f'{body}_centre'), data.oMi[joint].translation),
                    ('rate', getattr(state, f'{body}_velocity'), rate),
                    ('second', getattr(state, f'{body}_acceleration'), second),
                ):
                    errors[name].append(largest(value[n, k] - expected[:2]))
    e = mechanism.eccentricity
    assert len(errors['position']) == 3 * count * SAMPLES
    assert largest(errors['angle']) <= 1e-12
    assert largest(errors['position']) <= 1e-12 * e
    assert largest(errors['rate']) <= 1e-11 * e
    assert largest(errors['second']) <= 1e-10 * e
