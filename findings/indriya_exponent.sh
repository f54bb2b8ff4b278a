#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# indriya 2.2.4 (Java): a transmission error of "1.5e-3 rad" is read as 1.5 rad, and "1.5e3 N·m" as 1.5 N·m.
#
# Indriya is the reference implementation of JSR 385, units for Java. Expected of `getQuantity("1.5e-3 rad")` of its
# `Quantities`: 0.0015 rad, or an exception, as for "+2 rad". What happens: 1.5 rad, as the number ends before the "e"
# and what follows until the space is not looked at. A capital E is read right, and so is a small one by
# `SimpleQuantityFormat`.
# Output: 1.5e-3 rad => 1.5 rad, by SimpleQuantityFormat 0.0015 rad
#         1.5E-3 rad => 0.0015 rad, by SimpleQuantityFormat 0.0015 rad
#         1.5e3 N·m => 1.5 N·m, by SimpleQuantityFormat 1500 N·m
#         +2 rad => an exception
# For us: read such texts by `SimpleQuantityFormat`.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>exponent</artifactId><version>1</version>
  <dependencies>
    <dependency><groupId>tech.units</groupId><artifactId>indriya</artifactId><version>2.2.4</version></dependency>
  </dependencies>
</project>
XML
cat > Main.java <<'JAVA'
import tech.units.indriya.format.SimpleQuantityFormat;
import tech.units.indriya.quantity.Quantities;

public class Main {
    static void expect(boolean still) {
        if (!still) {
            throw new IllegalStateException("not as before");
        }
    }

    static void read(String text, double value, double simple) {
        var quantity = Quantities.getQuantity(text);
        var other = SimpleQuantityFormat.getInstance().parse(text);
        System.out.println(text + " => " + quantity + ", by SimpleQuantityFormat " + other);
        expect(quantity.getValue().doubleValue() == value && other.getValue().doubleValue() == simple);
    }

    public static void main(String[] arguments) {
        read("1.5e-3 rad", 1.5, 0.0015);
        read("1.5E-3 rad", 0.0015, 0.0015);
        read("1.5e3 N·m", 1.5, 1500);
        try {
            Quantities.getQuantity("+2 rad");
            expect(false);
        } catch (IllegalArgumentException | javax.measure.format.MeasurementParseException refused) {
            System.out.println("+2 rad => an exception");
        }
    }
}
JAVA
timeout 120 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
  dependency:copy-dependencies -DoutputDirectory=jars > log 2>&1 || { cat log; exit 1; }
export JAVA_TOOL_OPTIONS="-Duser.language=en -Duser.country=US -Dfile.encoding=UTF-8 -Dstdout.encoding=UTF-8"
timeout 60 java -Dsun.stdout.encoding=UTF-8 -cp 'jars/*' Main.java 2> >(grep -v JAVA_TOOL_OPTIONS >&2)
