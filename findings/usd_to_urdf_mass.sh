#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nvidia-srl-usd-to-urdf 1.0.3: a forearm whose joint is not at its origin needs 0.98 N·m to be held instead of 4.9 N·m.
#
# The origin of a forearm of 2 kg in a USD file is 0.2 m beyond its joint, and its centre of mass 0.05 m beyond its
# origin. A link of a URDF has its origin at its joint, so that the converter moves it there. Expected: the centre of
# mass is at 0.25 m, as the visual, a cube, is moved to 0.2 m. What happens: the centre of mass stays at 0.05 m, so that
# gravity pulls with a fifth of the torque. If the joint is at the origin of the forearm, the URDF is right. A joint
# without limits of effort and speed in the USD has effort="0." and velocity="0." in the URDF: it cannot move.
# For us: place the origins of the links at their joints before the conversion, and set the limits after it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    nvidia-srl-usd-to-urdf==1.0.3 nvidia-srl-base==1.6.0 nvidia-srl-math==1.1.0 nvidia-srl-usd==2.0.0 \
    usd-core==25.11 numpy==1.26.4 lxml==4.9.4
cd "$folder"
timeout 120 venv/bin/python - > log 2>&1 <<'PYTHON' || { cat log; exit 1; }
import logging
import xml.etree.ElementTree

from nvidia.srl.from_usd.to_urdf import UsdToUrdf
from pxr import Gf, Usd, UsdGeom, UsdPhysics


def stage(beyond):
    """An arm whose elbow is at 0.4 m and whose forearm has its origin so many m beyond the elbow."""
    arm = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(arm, 1.0)
    UsdGeom.SetStageUpAxis(arm, 'Z')
    arm.SetDefaultPrim(UsdGeom.Xform.Define(arm, '/arm').GetPrim())
    for name, x, mass in (('base', 0.0, 1.0), ('fore', 0.4 + beyond, 2.0)):
        link = UsdGeom.Xform.Define(arm, f'/arm/{name}')
        link.AddTranslateOp().Set(Gf.Vec3d(x, 0, 0))
        UsdPhysics.RigidBodyAPI.Apply(link.GetPrim())
        body = UsdPhysics.MassAPI.Apply(link.GetPrim())
        body.CreateMassAttr(mass)
        body.CreateCenterOfMassAttr(Gf.Vec3f(0.25 - beyond, 0, 0))
        body.CreateDiagonalInertiaAttr(Gf.Vec3f(0.01, 0.01, 0.01))
        body.CreatePrincipalAxesAttr(Gf.Quatf(1, 0, 0, 0))
        UsdGeom.Cube.Define(arm, f'/arm/{name}/cube').CreateSizeAttr(0.1)
    elbow = UsdPhysics.RevoluteJoint.Define(arm, '/arm/elbow')
    elbow.CreateBody0Rel().SetTargets(['/arm/base'])
    elbow.CreateBody1Rel().SetTargets(['/arm/fore'])
    elbow.CreateAxisAttr('Y')
    elbow.CreateLowerLimitAttr(-90)
    elbow.CreateUpperLimitAttr(90)
    elbow.CreateLocalPos0Attr(Gf.Vec3f(0.4, 0, 0))
    elbow.CreateLocalPos1Attr(Gf.Vec3f(-beyond, 0, 0))
    elbow.CreateLocalRot0Attr(Gf.Quatf(1))
    elbow.CreateLocalRot1Attr(Gf.Quatf(1))
    return arm


def converted(beyond):
    """The centre of mass and the cube beyond the elbow in m, and the limits of effort and speed."""
    text = UsdToUrdf(stage(beyond), log_level=logging.ERROR).to_str(quiet=True)
    robot = xml.etree.ElementTree.fromstring(text.encode())
    fore, limit = robot.find("link[@name='fore']"), robot.find('joint/limit')
    centre, cube = (float(fore.find(f'{part}/origin').get('xyz').split()[0]) for part in ('inertial', 'visual'))
    effort, speed = float(limit.get('effort')), float(limit.get('velocity'))
    print('>', f'origin {beyond} m: centre {centre}, cube {cube}, effort {effort}, speed {speed}',
          f'torque {2 * 9.81 * centre:.3f} N·m')  # fmt: skip
    return [round(value, 6) for value in (centre, cube, effort, speed)]


assert converted(0.0) == [0.25, 0.0, 0.0, 0.0]
assert converted(0.2) == [0.05, 0.2, 0.0, 0.0]
PYTHON
grep '^>' log
