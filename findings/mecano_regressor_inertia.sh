#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# us.ihmc:mecano 17-0.19.0 (Java): once the regressor of an arm was computed to find its masses, the arm has none.
#
# An arm of 2 kg and 1 kg is held level; its shoulder bears 24.525 N·m and its elbow 4.905 N·m. Expected of compute() of
# JointTorqueRegressorCalculator: the matrix by which the masses and inertias of the links give the torques of the
# joints, with the arm as it was. What happens: the matrix is right, but compute() sets the mass and the inertia of
# each link of the robot that it was given to 0, and they stay so: from then on an InverseDynamicsCalculator gives 0 N·m
# for both joints, without an exception, and an arm that is held by it drops. getParameterVector() keeps the values.
# The documentation tells how the matrix is found with other inertias inside, but not that the robot is left so.
# Output: before: 2.0 kg and 1.0 kg, 24.525 and 4.905 N·m
#         regressor by parameters: 24.525 and 4.905 N·m
#         after: 0.0 kg and 0.0 kg, 0.000 and 0.000 N·m
# For us: give the calculator a copy of the robot, by MultiBodySystemBasics.clone().
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
import us.ihmc.euclid.referenceFrame.ReferenceFrame;
import us.ihmc.euclid.transform.RigidBodyTransform;
import us.ihmc.euclid.tuple3D.Vector3D;
import us.ihmc.mecano.algorithms.InverseDynamicsCalculator;
import us.ihmc.mecano.algorithms.JointTorqueRegressorCalculator;
import us.ihmc.mecano.multiBodySystem.RevoluteJoint;
import us.ihmc.mecano.multiBodySystem.RigidBody;

public class Arm {
    static void check(String text, String expected) {
        System.out.println(text);
        if (!text.equals(expected)) throw new AssertionError(expected);
    }

    public static void main(String[] arguments) {
        var root = new RigidBody("root", ReferenceFrame.getWorldFrame());
        var axis = new Vector3D(0, -1, 0);
        var middle = new Vector3D(0.5, 0, 0);
        var shoulder = new RevoluteJoint("shoulder", root, new RigidBodyTransform(), axis);
        var upper = new RigidBody("upper", shoulder, 0.02, 0.1, 0.03, 2.0, middle);
        var end = new RigidBodyTransform();
        end.getTranslation().set(1, 0, 0);
        var elbow = new RevoluteJoint("elbow", upper, end, axis);
        var fore = new RigidBody("fore", elbow, 0.01, 0.05, 0.03, 1.0, middle);
        root.updateFramesRecursively();

        var dynamics = new InverseDynamicsCalculator(root);
        dynamics.setGravitationalAcceleration(-9.81);
        var regressor = new JointTorqueRegressorCalculator(root);
        regressor.setGravitationalAcceleration(-9.81);
        for (boolean computed : new boolean[] {false, true}) {
            if (computed) {
                regressor.compute();
                var matrix = regressor.getJointTorqueRegressorMatrix();
                var parameters = regressor.getParameterVector();
                double[] torques = new double[2];
                for (int row = 0; row < 2; row++)
                    for (int column = 0; column < matrix.numCols; column++)
                        torques[row] += matrix.get(row, column) * parameters.get(column);
                check(String.format("regressor by parameters: %.3f and %.3f N·m", torques[0], torques[1]),
                    "regressor by parameters: 24.525 and 4.905 N·m");
            }
            dynamics.compute();
            var torques = dynamics.getJointTauMatrix();
            check(String.format("%s: %.1f kg and %.1f kg, %.3f and %.3f N·m", computed ? "after" : "before",
                upper.getInertia().getMass(), fore.getInertia().getMass(), torques.get(0), torques.get(1)),
                computed ? "after: 0.0 kg and 0.0 kg, 0.000 and 0.000 N·m"
                    : "before: 2.0 kg and 1.0 kg, 24.525 and 4.905 N·m");
        }
    }
}
JAVA
timeout 120 java -Duser.language=en -Dfile.encoding=UTF-8 -cp 'lib/*' Arm.java
