#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# us.ihmc:mecano 17-0.19.0 (Java): the gradient of the gravity torque is wrong for a joint of two geared axes, by up to
# 26 %.
#
# Its RevoluteTwinsJoint is an elbow of two axes that a gear couples (angle of B = ratio times that of A + offset), its
# CrossFourBarJoint a knee of four links. Expected of MultiBodyGravityGradientCalculator: the torques that hold the arm,
# and how they change with the angles of its joints, so that torque(q + dq) = torque(q) + gradient dq as documented.
# What happens: the torques are right, as InverseDynamicsCalculator and the change of the potential energy say,
# and so is the gradient of a plain joint. But the gradient of such a joint by its own angle is off, as if its parts
# turned together: that of an elbow with a ratio of 1 is -2.13 instead of -1.96 N·m/rad, that of a knee is 5.89 instead
# of 4.68 N·m/rad. No exception says so.
# Output: shoulder: torque -29.69 N·m, gradient 1.94, by differences 1.94
#         elbow: torque -11.86 N·m, gradient -2.13, by differences -1.96
#         knee: torque -0.42 N·m, gradient 5.89, by differences 4.68
# For us: take differences of the torques of InverseDynamicsCalculator for such joints.
#
# Exit code 0: still so. Needs a JDK 17 and mvn; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat > pom.xml <<'XML'
<project xmlns="http://maven.apache.org/POM/4.0.0">
  <modelVersion>4.0.0</modelVersion><groupId>arm</groupId><artifactId>arm</artifactId><version>1</version>
  <dependencies>
    <dependency><groupId>us.ihmc</groupId><artifactId>mecano</artifactId><version>17-0.19.0</version></dependency>
  </dependencies>
</project>
XML
mvn -q -B dependency:copy-dependencies -DoutputDirectory=lib
cat > Arm.java <<'JAVA'
import us.ihmc.euclid.matrix.Matrix3D;
import us.ihmc.euclid.referenceFrame.ReferenceFrame;
import us.ihmc.euclid.transform.RigidBodyTransform;
import us.ihmc.euclid.tuple3D.Vector3D;
import us.ihmc.mecano.algorithms.CenterOfMassCalculator;
import us.ihmc.mecano.algorithms.InverseDynamicsCalculator;
import us.ihmc.mecano.algorithms.MultiBodyGravityGradientCalculator;
import us.ihmc.mecano.multiBodySystem.CrossFourBarJoint;
import us.ihmc.mecano.multiBodySystem.RevoluteJoint;
import us.ihmc.mecano.multiBodySystem.RevoluteTwinsJoint;
import us.ihmc.mecano.multiBodySystem.RigidBody;
import us.ihmc.mecano.multiBodySystem.interfaces.OneDoFJointBasics;

public class Arm {
    static final double STEP = 1e-4;
    static final Vector3D Y = new Vector3D(0, 1, 0);

    static RigidBodyTransform at(double x, double z) {
        var transform = new RigidBodyTransform();
        transform.getTranslation().set(x, 0, z);
        return transform;
    }

    static void check(boolean right, String name) {
        if (!right) throw new AssertionError(name);
    }

    static double torque(RigidBody root, int row) {
        var dynamics = new InverseDynamicsCalculator(root);
        dynamics.setGravitationalAcceleration(-9.81);
        dynamics.compute();
        return dynamics.getJointTauMatrix().get(row);
    }

    static double energy(RigidBody root) {
        var mass = new CenterOfMassCalculator(root, ReferenceFrame.getWorldFrame());
        mass.reset();
        return 9.81 * mass.getTotalMass() * mass.getCenterOfMass().getZ();
    }

    static void show(RigidBody root, OneDoFJointBasics joint, int row, double expected, double byDifferences) {
        root.updateFramesRecursively();
        var calculator = new MultiBodyGravityGradientCalculator(root);
        calculator.setGravitionalAcceleration(-9.81);
        calculator.reset();
        double torque = calculator.getTauMatrix().get(row);
        double gradient = calculator.getTauGradientMatrix().get(row, row);
        double angle = joint.getQ(), torques = 0, work = 0;
        check(Math.abs(torque - torque(root, row)) < 1e-9, "torque of " + joint.getName());
        for (int sign = -1; sign <= 1; sign += 2) {
            joint.setQ(angle + sign * STEP);
            root.updateFramesRecursively();
            torques += sign * torque(root, row) / (2 * STEP);
            work += sign * energy(root) / (2 * STEP);
        }
        joint.setQ(angle);
        root.updateFramesRecursively();
        System.out.printf("%s: torque %.2f N·m, gradient %.2f, by differences %.2f%n",
            joint.getName(), torque, gradient, torques);
        check(Math.abs(work - torque) < 1e-4, "energy of " + joint.getName());
        check(Math.abs(gradient - expected) < 0.005, "gradient of " + joint.getName());
        check(Math.abs(torques - byDifferences) < 0.005, "differences of " + joint.getName());
    }

    public static void main(String[] arguments) {
        var inertia = new Matrix3D(0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.03);
        var root = new RigidBody("root", ReferenceFrame.getWorldFrame());
        var shoulder = new RevoluteJoint("shoulder", root, at(0, 0), Y);
        var upper = new RigidBody("upper", shoulder, 0.02, 0.1, 0.03, 2.0, new Vector3D(0.25, 0, 0.02));
        var elbow = new RevoluteTwinsJoint("elbow", upper, "A", "B", "middle", at(0.5, 0), at(0.2, 0.03), inertia, 0.7,
            at(0.1, 0.01), 0, 1.0, 0.0, Y);
        new RigidBody("fore", elbow, 0.02, 0.1, 0.03, 2.3, new Vector3D(0.43, 0, -0.05));
        shoulder.setQ(0.3);
        elbow.setQ(-0.6);
        show(root, shoulder, 0, 1.94, 1.94);
        show(root, elbow, 1, -2.13, -1.96);

        root = new RigidBody("root", ReferenceFrame.getWorldFrame());
        inertia = new Matrix3D(0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01);
        var knee = new CrossFourBarJoint("knee", root, "A", "B", "C", "D", "DA", "BC", at(0, 0), at(0.1, 0),
            at(0.12, -0.3), at(-0.12, -0.3), inertia, inertia, 0.5, 0.6, at(0, 0), at(0, 0), 0, 2, Y);
        new RigidBody("shin", knee, 0.02, 0.1, 0.03, 1.5, new Vector3D(0.05, 0, -0.2));
        knee.setQ(0.3);
        show(root, knee, 0, 5.89, 4.68);
    }
}
JAVA
timeout 120 java -Duser.language=en -Dfile.encoding=UTF-8 -cp 'lib/*' Arm.java
