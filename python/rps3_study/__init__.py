"""Couples the FMUs Rps3Plant and Rps3Controller in FMPy, measures the runs and reports on them.

Quantities are in SI units under the FMUs' variable names unless a docstring says otherwise.
"""
