"""Model files: a model, an analysis and what to print, in TOML."""

from beamfem.cli.modelfile.errors import ModelFileError
from beamfem.cli.modelfile.read import Job, read_model_file

__all__ = ["Job", "ModelFileError", "read_model_file"]
