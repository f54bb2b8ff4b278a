"""What the bodies look like: teeth, outlines, URDF, the pin sheet, and angles for people."""
