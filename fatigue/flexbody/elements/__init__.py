"""Stiffness and mass of finite elements, in consistent units: flat four-node shells, straight beams."""
