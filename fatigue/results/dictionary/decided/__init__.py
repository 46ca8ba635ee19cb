"""Columns of the tables of decisions from results, of bands of life and of gauges."""
