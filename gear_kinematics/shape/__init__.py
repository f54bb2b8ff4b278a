"""Shapes of the bodies: teeth, outlines, URDF and the pin sheet; formatted angles."""
