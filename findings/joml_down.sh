#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# JOML 1.10.8 (Java): the Euler angles of a flange that points straight down are those of a pose that is up to 30° away.
#
# A flange that is turned by 20°, 90° and 10° about x, y and z. Only the sum of the first and the third angle is defined
# there. Expected of getEulerAnglesXYZ(): any two angles with the sum of 30°, as other libraries give, so that the pose
# is the same. What happens: the arctangents of rounding errors, without a warning: -180°, 90° and -180° from a
# Matrix3d, a pose that is 30° away, and 4.8°, 90° and 4.2° from a Quaterniond, 21° away. At 89.99° both are exact. Each
# of 90 such poses is more than 1° away in both ways.
# For us: keep the orientation of a flange as a quaternion, and do not pass it on in Euler angles of JOML.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/src/main/java"
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>down</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>org.joml</groupId><artifactId>joml</artifactId><version>1.10.8</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import org.joml.Matrix3d;
import org.joml.Quaterniond;
import org.joml.Vector3d;

public class Main {
    /** By how many degrees the poses of two quaternions differ. */
    static double away(Quaterniond pose, Quaterniond other) {
        double dot = Math.min(Math.abs(pose.dot(other)), 1);
        return Math.toDegrees(2 * Math.acos(dot));
    }

    /** How far the poses are away whose angles were read from a quaternion and from a matrix, in the order XYZ. */
    static double[] xyz(double x, double y, double z, boolean shown) {
        double[] angles = {Math.toRadians(x), Math.toRadians(y), Math.toRadians(z)};
        Quaterniond pose = new Quaterniond().rotationXYZ(angles[0], angles[1], angles[2]);
        Vector3d[] read = {pose.getEulerAnglesXYZ(new Vector3d()),
            new Matrix3d().rotationXYZ(angles[0], angles[1], angles[2]).getEulerAnglesXYZ(new Vector3d())};
        double[] distances = new double[2];
        for (int way = 0; way < 2; way++) {
            distances[way] = away(pose, new Quaterniond().rotationXYZ(read[way].x, read[way].y, read[way].z));
            if (shown) {
                System.out.printf("%.2f°, %.2f°, %.2f° from a %s: %.2f°, %.2f°, %.2f°, %.2f° away%n", x, y, z,
                    way == 0 ? "quaternion" : "matrix", Math.toDegrees(read[way].x), Math.toDegrees(read[way].y),
                    Math.toDegrees(read[way].z), distances[way]);
            }
        }
        return distances;
    }

    static void check(boolean expected) {
        if (!expected) {
            System.exit(1);
        }
    }

    public static void main(String[] arguments) {
        for (double tilt : new double[] {45, 89, 89.99}) {
            double[] distances = xyz(20, tilt, 10, true);
            check(distances[0] < 0.001 && distances[1] < 0.001);
        }
        double[] down = xyz(20, 90, 10, true);
        check(Math.abs(down[0] - 21) < 0.5 && Math.abs(down[1] - 30) < 0.5);
        int[] wrong = new int[2];
        for (int x = 0; x < 90; x++) {
            double[] distances = xyz(x, 90, 10, false);
            for (int way = 0; way < 2; way++) {
                wrong[way] += distances[way] > 1 ? 1 : 0;
            }
        }
        System.out.printf("of 90 poses, %d from a quaternion and %d from a matrix are more than 1° away%n", wrong[0], wrong[1]);
        check(wrong[0] > 80 && wrong[1] > 80);
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
