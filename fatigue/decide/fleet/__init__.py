"""Damage of units that ran different distances under the conditions of several results."""
