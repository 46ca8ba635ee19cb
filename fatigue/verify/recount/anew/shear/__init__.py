"""Shear with the normal stress once more: the path of both at a point, its half cycles, what they do in the mission."""
