"""Figures of the design study that preceded the FMUs, for comparison.

Peak pose error in mm over the quintic crossing (K_P = 900 1/s2, K_D = 60 1/s, 48 V, 1 kHz), noise-free,
with the pose known exactly to the controller and a grid search in place of the swarm.
"""

PEAK_ERROR: dict[tuple[str, str], float] = {
    ("six motors", "RAC"): 9.6,
    ("six motors", "DRAC"): 0.93,
    ("six motors", "HDRAC"): 7.6,
    ("six motors", "HDRAC+MPSO"): 0.020,
    ("three motors", "RAC"): 3.8,
    ("three motors", "DRAC"): 8.7,
    ("three motors", "HDRAC"): 7.6,
    ("three motors", "HDRAC+MPSO"): 0.29,
}
TASK = "smooth"
"""Key of the task that these figures belong to."""
