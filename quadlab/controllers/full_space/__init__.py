"""The decision vectors of the papers, where dynamics and contacts are levels of their own instead of eliminated.

They are slower than the reduced form and have the same solutions; kept to show that.
"""

from quadlab.controllers.full_space.accelerations_forces import accelerations_forces
from quadlab.controllers.full_space.accelerations_torques import accelerations_torques

__all__ = ["accelerations_forces", "accelerations_torques"]
