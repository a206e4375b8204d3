"""A model is a file: TOML read into an application and the analyses asked of it, and written from them."""

from bearingdyn.model.model import Analysis, Model
from bearingdyn.model.reader import read_model
from bearingdyn.model.ross import read_ross
from bearingdyn.model.writer import write_model

__all__ = ["Analysis", "Model", "read_model", "read_ross", "write_model"]
