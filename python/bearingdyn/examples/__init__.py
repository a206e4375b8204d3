"""Ready machines: each a function that returns an application, and the same machine as a model file."""

from bearingdyn.examples.machines import fan, model_path, motor, pump, rubber, spindle

__all__ = ["fan", "model_path", "motor", "pump", "rubber", "spindle"]
