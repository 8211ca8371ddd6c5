"""Physics for tests: a robot that is what its description says."""

from quadlab.simulation.model_error import ModelErrorConfig
from quadlab.simulation.simulator import SimulationConfig

NO_ERROR = ModelErrorConfig(payload_kg=0.0, payload_position_m=(0.0, 0.0, 0.0), inertia_scale=1.0, torque_scale=1.0)


def exact_simulation(timestep_s: float) -> SimulationConfig:
    return SimulationConfig(timestep_s=timestep_s, model_error=NO_ERROR)
