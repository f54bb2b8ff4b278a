#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# org.ode4j:core 0.5.3 (Java), the port of the Open Dynamics Engine: a gear of 20 turns its output 20 times as fast.
#
# A transmission joint couples a rotor of 0.01 kg·m², its first body, to an output of 4 kg·m². Expected of setRatio(20),
# documented as the angular speed of the first gear by that of the second: 0.01 N·m at the rotor turn it by 0.25 rad in
# a second, and the output by -0.0125 rad; getAngle1() and getAngle2(), the angles that the bodies have traversed, are
# these. What happens: the rotor hardly turns, and the output turns 20 times as far, as the ratio is taken as the speed
# of the second gear by that of the first. So does getRatio() of a chain drive with radii of 50 mm and 1 m, which turns
# rightly: 0.05, not 20. The traversed angles have the opposite signs of the hinges' angles. No error says so. ODE
# 0.16.2 of Debian 12, whose manual says the same of the ratio, gave the same angles in a trial in C++.
# Output: ratio 20: rotor 0.000003 rad, output -0.000063 rad, traversed -0.000003 and 0.000062
#         ratio 0.05: rotor 0.250 rad, output -0.0125 rad, traversed -0.250 and 0.0125
#         chain: rotor 0.250 rad, output 0.0125 rad, getRatio() 0.05
# For us: give 1/20 as the ratio of a gear of 20, and read the angles from the hinges.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat > pom.xml <<'XML'
<project xmlns="http://maven.apache.org/POM/4.0.0">
  <modelVersion>4.0.0</modelVersion><groupId>gear</groupId><artifactId>gear</artifactId><version>1</version>
  <dependencies>
    <dependency><groupId>org.ode4j</groupId><artifactId>core</artifactId><version>0.5.3</version></dependency>
  </dependencies>
</project>
XML
mvn -q -B dependency:copy-dependencies -DoutputDirectory=lib
cat > Gear.java <<'JAVA'
import org.ode4j.ode.DBody;
import org.ode4j.ode.DHingeJoint;
import org.ode4j.ode.DJoint.TRANSMISSION;
import org.ode4j.ode.DMass;
import org.ode4j.ode.DTransmissionJoint;
import org.ode4j.ode.DWorld;
import org.ode4j.ode.OdeHelper;

public class Gear {
    static DBody body(DWorld world, double inertia, double x) {
        DMass mass = OdeHelper.createMass();
        mass.setParameters(1, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
        DBody body = OdeHelper.createBody(world);
        body.setMass(mass);
        body.setPosition(x, 0, 0);
        return body;
    }

    static DHingeJoint hinge(DWorld world, DBody body, double x) {
        DHingeJoint hinge = OdeHelper.createHingeJoint(world);
        hinge.attach(body, null);
        hinge.setAnchor(x, 0, 0);
        hinge.setAxis(0, 0, 1);
        return hinge;
    }

    static void check(String name, double value, double expected) {
        System.out.printf("%s %.6f%n", name, value);
        if (Math.abs(value - expected) > 0.003 * Math.abs(expected) + 1e-7) throw new AssertionError(expected);
    }

    static void turn(String name, double ratio, double rotorAngle, double outputAngle) {
        DWorld world = OdeHelper.createWorld();
        DBody rotor = body(world, 0.01, 0), output = body(world, 4, 1);
        DHingeJoint motor = hinge(world, rotor, 0), joint = hinge(world, output, 1);
        DTransmissionJoint gear = OdeHelper.createTransmissionJoint(world, null);
        gear.attach(rotor, output);
        boolean chain = name.equals("chain");
        gear.setMode(chain ? TRANSMISSION.dTransmissionChainDrive : TRANSMISSION.dTransmissionParallelAxes);
        gear.setAnchor1(0, 0, 0);
        gear.setAnchor2(1, 0, 0);
        gear.setAxis(0, 0, 1);
        if (chain) {
            gear.setRadius1(0.05);
            gear.setRadius2(1);
        } else {
            gear.setRatio(ratio);
        }
        for (int step = 0; step < 1000; step++) {
            rotor.addTorque(0, 0, 0.01);
            world.step(0.001);
        }
        check(name + ": rotor", motor.getAngle(), rotorAngle);
        check(name + ": output", joint.getAngle(), outputAngle);
        check(name + ": traversed", gear.getAngle1(), -rotorAngle);
        check(name + ": traversed", gear.getAngle2(), -outputAngle);
        check(name + ": getRatio()", gear.getRatio(), ratio);
    }

    public static void main(String[] arguments) {
        OdeHelper.initODE2(0);
        turn("ratio 20", 20, 3.125e-6, -6.25e-5);
        turn("ratio 0.05", 0.05, 0.25, -0.0125);
        turn("chain", 0.05, 0.25, 0.0125);
    }
}
JAVA
timeout 120 java -Dfile.encoding=UTF-8 -cp 'lib/*' Gear.java
