"""Channels beside standards: comfort by Sperling and EN 12299, equipment by IEC 61373, running behaviour by EN 14363.

Constants that were recalled are data with an edition; every row says so, and nothing here certifies anything.
"""
