#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# indriya 2.2 (Java): "1e-3 rad" is 1 rad and "1,5 rad" is 15 rad, without an error, and 20 °C plus a rise of 5 °C is
# 298 °C.
#
# The reference implementation of Java's units. Expected of Quantities.getQuantity("1e-3 rad"), as C and Python write
# it: 0.001 rad, or an error. What happens: the number ends at the "e", and what follows up to the space is left out, so
# that any exponent is 10^0: "1e-3 rad" is 1 rad and "2.5e3 rad/s" 2.5 rad/s. Only "1E-3 rad" is right. A comma is left
# out in the number: "1,5 rad" is 15 rad. Temperatures are added as absolute ones: 20 °C and a rise of 5 °C are 298.15
# °C, the double of 20 °C is 313.15 °C; the sum with 5 K is 25 °C.
# For us: write limits in a file of a Java tool without an exponent; give a rise of temperature in K.
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
  <groupId>org.example</groupId><artifactId>exponent</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>tech.units</groupId><artifactId>indriya</artifactId>
      <version>2.2</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import java.util.Locale;
import tech.units.indriya.quantity.Quantities;
import tech.units.indriya.unit.Units;

public class Main {
    static double read(String text) {
        double value = Quantities.getQuantity(text).getValue().doubleValue();
        System.out.println(text + ": " + value);
        return value;
    }

    static void check(boolean expected) {
        if (!expected) {
            System.exit(1);
        }
    }

    public static void main(String[] arguments) {
        Locale.setDefault(Locale.ROOT);
        check(read("0.001 rad") == 0.001 && read("1E-3 rad") == 0.001);
        check(read("1e-3 rad") == 1.0 && read("2.5e3 rad/s") == 2.5 && read("1,5 rad") == 15.0);
        var motor = Quantities.getQuantity(20, Units.CELSIUS);
        var rise = motor.add(Quantities.getQuantity(5, Units.CELSIUS));
        var kelvin = motor.add(Quantities.getQuantity(5, Units.KELVIN));
        System.out.println(rise + ", " + kelvin + ", " + motor.multiply(2));
        check(rise.getValue().doubleValue() == 298.15 && kelvin.getValue().doubleValue() == 25.0);
        check(motor.multiply(2).getValue().doubleValue() == 313.15);
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
