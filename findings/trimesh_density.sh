#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# trimesh 5.2.0: two steel parts of a rotor that are joined weigh 1.6 g instead of 12.2 kg, as their density is lost.
#
# A cylinder has a density of 7800 kg/m³. Expected of two of them that are concatenated, and of one of which a part is
# taken, or which gets more triangles: its density, as that of a copy. What happens: concatenate(), `+`, submesh(),
# subdivide(), and to_mesh() of a scene, make meshes with a density of 1, without a warning, so that mass and inertia
# for a URDF are 7800 times too small. The inertia of the scene itself is right. convert_units() from m to mm keeps the
# density of 7800 for a volume in mm³: the cylinder of 6.1 kg weighs 6.1·10⁹.
# For us: set the density after the last change of a mesh, or take `moment_inertia` of the scene.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import trimesh

shaft = trimesh.creation.cylinder(radius=0.05, height=0.1)
shaft.density = 7800
disc = shaft.copy()
disc.apply_translation([0, 0, 0.1])
scene = trimesh.Scene([shaft, disc])
assert disc.density == 7800
made = {
    'concatenate()': trimesh.util.concatenate([shaft, disc]),
    '+': shaft + disc,
    'submesh()': shaft.submesh([range(len(shaft.faces))], append=True),
    'subdivide()': shaft.subdivide(),
    'to_mesh()': scene.to_mesh(),
}
for name, mesh in made.items():
    print(name, 'density', mesh.density, 'mass', mesh.mass)
    assert mesh.density == 1
joined, both = made['concatenate()'], 2 * shaft.mass
assert abs(both - 12.2) < 0.1 and abs(joined.mass - 0.00156) < 1e-5
inertia = scene.moment_inertia[2, 2], joined.moment_inertia[2, 2]
print('inertia about the axis: of the scene', inertia[0], 'of the joined mesh', inertia[1])
assert abs(inertia[0] / inertia[1] - 7800) < 1
millimetres = shaft.copy()
millimetres.units = 'm'
millimetres.convert_units('mm')
print('in mm: density', millimetres.density, 'mass', millimetres.mass)
assert abs(millimetres.mass / shaft.mass - 1e9) < 1
PYTHON
