"""The second computation: lines, stresses, cycles, curves and spectra, by other code."""
