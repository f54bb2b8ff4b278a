#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dyn4j 6.0.0 (Java): a gear of 1/20 divides the speed but not the torque, and a rotor whose output turns the other
# way is at NaN.
#
# AngleJoint is "to simulate gears"; a rotor of 0.1 kg·m² and an output of 0.1 kg·m² turn about fixed axes, with a
# ratio of 0.05 = output / rotor. Expected: 1 N·m at the output turns the rotor by 0.25 rad in a second, and 0.05 N·m
# at the rotor hold it. What happens: 4.77 rad, as the same torque acts on both; 1 N·m at the rotor holds it. Expected
# of a ratio of -1, which is documented, and of 0.1 N·m at the rotor: it turns by 0.25 rad and the output by -0.25
# rad. What happens: both are at NaN. A ratio of +1 is right. For us: simulate a gear as one body with the reflected
# inertia and the reflected torque.
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
  <groupId>org.example</groupId><artifactId>gear</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>org.dyn4j</groupId><artifactId>dyn4j</artifactId><version>6.0.0</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import org.dyn4j.dynamics.Body;
import org.dyn4j.dynamics.joint.AngleJoint;
import org.dyn4j.dynamics.joint.RevoluteJoint;
import org.dyn4j.geometry.Geometry;
import org.dyn4j.geometry.Mass;
import org.dyn4j.geometry.MassType;
import org.dyn4j.geometry.Vector2;
import org.dyn4j.world.World;

public class Main {
    static final double INERTIA = 0.1;

    static Body disc(World<Body> world, Body base, double x) {
        Body disc = new Body();
        disc.addFixture(Geometry.createCircle(0.1));
        disc.translate(x, 0);
        disc.setMass(new Mass(new Vector2(), 1, INERTIA));
        disc.setAngularDamping(0);
        disc.setAtRestDetectionEnabled(false);
        world.addBody(disc);
        world.addJoint(new RevoluteJoint<>(base, disc, new Vector2(x, 0)));
        return disc;
    }

    /** The angle in rad by which the rotor turns in a second under these torques in N·m. */
    static double turned(double ratio, double rotorTorque, double outputTorque) {
        World<Body> world = new World<>();
        world.setGravity(World.ZERO_GRAVITY);
        world.getSettings().setStepFrequency(0.001);
        Body base = new Body();
        base.addFixture(Geometry.createCircle(0.01));
        base.translate(0, 5);
        base.setMass(MassType.INFINITE);
        world.addBody(base);
        Body rotor = disc(world, base, 0);
        Body output = disc(world, base, 5);
        AngleJoint<Body> gear = new AngleJoint<>(rotor, output);
        gear.setLimitsEnabled(false);
        gear.setRatio(ratio);
        world.addJoint(gear);
        double angle = 0;
        for (int step = 0; step < 1000; step++) {
            rotor.applyTorque(rotorTorque);
            output.applyTorque(outputTorque);
            world.step(1);
            angle += rotor.getAngularVelocity() * 0.001;
        }
        double expected = 0.5 * (rotorTorque + ratio * outputTorque) / (INERTIA * (1 + ratio * ratio));
        System.out.println("ratio " + ratio + ", torques " + rotorTorque + " and " + outputTorque + " N·m: rotor at "
            + angle + " rad instead of " + expected + " rad, speeds " + rotor.getAngularVelocity() + " and "
            + output.getAngularVelocity() + " rad/s");
        return angle;
    }

    static void check(boolean expected) {
        if (!expected) {
            System.exit(1);
        }
    }

    public static void main(String[] arguments) {
        check(Math.abs(turned(1, 0.1, 0) - 0.25) < 0.001);
        check(Math.abs(turned(0.05, 0, 1) - 4.767) < 0.01);
        check(Math.abs(turned(0.05, -0.05, 1)) > 4);
        check(Math.abs(turned(0.05, -1, 1)) < 0.01);
        check(Double.isNaN(turned(-1, 0.1, 0)));
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
