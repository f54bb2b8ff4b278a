#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mujoco-usd-converter 0.8.0, Newton 1.8.0: the stops of a joint with ref="0.5" are off by 0.5 rad in a USD file.
#
# In an MJCF, a joint has a range from -1 to 2 rad, and its angle is 0.5 rad where the file draws it. Expected: it turns
# by -1.5 rad to 1.5 rad from there, as in MuJoCo, and as Newton reads the MJCF. What happens: in the USD file, the
# limits of the joint are -57.3° and 114.6°, while both of its frames are drawn at the same angle, so that it turns by
# -1 to 2 rad. Newton's add_usd() reads it so: it may go 0.5 rad beyond its stop. The file also has the attribute
# mjc:ref, which moves the limits back where SolverMuJoCo.register_custom_attributes() was called before; but the limits
# are attributes of USD's own physics, and its readers know no mjc:ref. Without a ref all is right.
# For us: take ref out of the model and move its ranges and equalities by it, before it is converted to USD, or call
# register_custom_attributes() before add_usd().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco-usd-converter==0.8.0
python3 -m venv "$folder/newton"
"$folder/newton/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 newton-usd-schemas==0.6.0 \
  usd-core==26.11 warp-lang==1.19.0 mujoco==3.17.0 mujoco-warp==3.17.0 numpy==2.4.6
cd "$folder"
for ref in 0 0.5; do
  cat > "gear_$ref.xml" <<MJCF
<mujoco model="gear_$ref"><compiler angle="radian"/><worldbody><body name="shaft">
  <inertial pos="0.1 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>
  <joint name="output" axis="0 0 1" ref="$ref" range="-1 2"/>
</body></worldbody></mujoco>
MJCF
done
cat > convert.py <<'PYTHON'
import mujoco_usd_converter

for ref in ('0', '0.5'):
    mujoco_usd_converter.Converter().convert(f'gear_{ref}.xml', f'from_{ref}')
PYTHON
cat > read.py <<'PYTHON'
import glob

import mujoco
import newton
import numpy as np
from pxr import Usd, UsdPhysics


def in_usd(path):
    stage = Usd.Stage.Open(path)
    joint, = (UsdPhysics.RevoluteJoint(prim) for prim in stage.Traverse() if prim.IsA(UsdPhysics.RevoluteJoint))
    one, other = (attribute.Get() for attribute in (joint.GetLocalRot0Attr(), joint.GetLocalRot1Attr()))
    assert np.allclose((one.real, *one.imaginary), (other.real, *other.imaginary), atol=1e-6)
    return np.deg2rad([joint.GetLowerLimitAttr().Get(), joint.GetUpperLimitAttr().Get()])


def in_newton(reader, path, register):
    builder = newton.ModelBuilder()
    if register:
        newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
    getattr(builder, reader)(path)
    model = builder.finalize(device='cpu')
    assert np.allclose(model.joint_q.numpy(), 0)
    return model.joint_limit_lower.numpy()[-1], model.joint_limit_upper.numpy()[-1]


for ref, turns in (('0', (-1, 2)), ('0.5', (-1.5, 1.5))):
    model = mujoco.MjModel.from_xml_path(f'gear_{ref}.xml')
    path, = glob.glob(f'from_{ref}/*.usda')
    found = (model.jnt_range[0] - model.qpos0[0], in_newton('add_mjcf', f'gear_{ref}.xml', False),
             in_newton('add_usd', path, True), in_newton('add_usd', path, False), in_usd(path))
    for name, limits in zip(('MuJoCo', 'Newton by MJCF', 'Newton by USD, registered', 'Newton by USD', 'USD'), found):
        print(f'ref {ref}, {name}: turns by {limits[0]:.2f} to {limits[1]:.2f} rad', flush=True)
    assert np.allclose(found[:3], turns, atol=1e-5) and np.allclose(found[3:], (-1, 2), atol=1e-5)
PYTHON
timeout 100 venv/bin/python convert.py > log 2>&1 || { cat log; exit 1; }
export WARP_CACHE_PATH="$folder/cache" OMP_NUM_THREADS=1
timeout 580 newton/bin/python read.py > log 2>&1 || { cat log; exit 1; }
grep turns log
