"""Ready machines: each a function that returns an application, and the same machine as a model file."""

from bearingdyn.examples.machines import fan, model_path, motor, pump, rubber, spindle
from bearingdyn.examples.paper import fault_bench, paper_motor

__all__ = ["fan", "fault_bench", "model_path", "motor", "paper_motor", "pump", "rubber", "spindle"]
