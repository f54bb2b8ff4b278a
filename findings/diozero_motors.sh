#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# diozero-core 1.4.1 (Java): the second of two motors is the first one, and a stepper with two coils on at a time does
# not turn.
#
# Expected of DualMotor.getMotorB(): the second motor. What happens: it is the first; setValues() drives both. Expected
# of a bipolar stepper in the style DOUBLE, of the package `sandpit`: two neighbouring coils at each step, and after
# four steps one period, as SINGLE and INTERLEAVE make it, only with more torque. What happens: at every other step both
# ends of one coil are on, which brakes it, and between them the field goes half a period on, which may turn the rotor
# in either direction: it trembles on the spot. The four steps point to -45°, nowhere, 135° and nowhere, in degrees of a
# period of which SINGLE makes a quarter per step.
# For us: keep the two motors yourself, or a joint follows the wrong one; use SINGLE or INTERLEAVE.
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
  <groupId>org.example</groupId><artifactId>motors</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>com.diozero</groupId><artifactId>diozero-core</artifactId>
      <version>1.4.1</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import com.diozero.devices.motor.DualMotor;
import com.diozero.devices.motor.MotorBase;
import com.diozero.devices.sandpit.motor.BasicStepperController.BiPolarTerminal;
import com.diozero.devices.sandpit.motor.BasicStepperController.BipolarBasicController;
import com.diozero.devices.sandpit.motor.BasicStepperController.StepStyle;
import com.diozero.devices.sandpit.motor.BasicStepperController.StepperPin;
import java.util.ArrayList;
import java.util.List;

public class Main {
    static class Pin implements StepperPin {
        boolean on;

        @Override
        public void setValue(boolean value) {
            on = value;
        }

        @Override
        public void close() {
        }
    }

    static class Motor extends MotorBase {
        float value;

        @Override
        public void forward(float speed) {
            value = speed;
        }

        @Override
        public void backward(float speed) {
            value = -speed;
        }

        @Override
        public void stop() {
            value = 0;
        }

        @Override
        public float getValue() {
            return value;
        }

        @Override
        public boolean isActive() {
            return value != 0;
        }

        @Override
        public void close() {
        }
    }

    /** The direction of the field of the two coils in degrees of a period, relative to that of A, at each step. */
    static List<String> fields(StepStyle style) {
        Pin[] pins = {new Pin(), new Pin(), new Pin(), new Pin()};
        var controller = new BipolarBasicController(new BiPolarTerminal(pins[0], pins[1]), new BiPolarTerminal(pins[2], pins[3]));
        var found = new ArrayList<String>();
        for (int step = 0; step < (style == StepStyle.INTERLEAVE ? 8 : 4); step++) {
            controller.stepForward(style);
            // Terminal B minus is the first of the sequence, and terminal A plus the last.
            int b = (pins[3].on ? 1 : 0) - (pins[2].on ? 1 : 0);
            int a = (pins[1].on ? 1 : 0) - (pins[0].on ? 1 : 0);
            found.add(a == 0 && b == 0 ? "none" : String.valueOf(Math.round(Math.toDegrees(Math.atan2(a, b)))));
        }
        System.out.println(style + ": " + found);
        return found;
    }

    public static void main(String[] arguments) {
        boolean single = fields(StepStyle.SINGLE).equals(List.of("0", "90", "180", "-90"));
        boolean interleave = fields(StepStyle.INTERLEAVE).equals(List.of("0", "45", "90", "135", "180", "-135", "-90", "-45"));
        boolean still = fields(StepStyle.DOUBLE).equals(List.of("-45", "none", "135", "none"));
        Motor left = new Motor();
        Motor right = new Motor();
        DualMotor both = new DualMotor(left, right);
        both.setValues(0.25f, 0.75f);
        System.out.println("motor B: " + both.getMotorB().getValue() + " instead of " + right.getValue());
        if (!single || !interleave || !still || both.getMotorB() != left || right.getValue() != 0.75f) {
            System.exit(1);
        }
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
