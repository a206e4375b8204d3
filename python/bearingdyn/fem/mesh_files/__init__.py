"""Meshes of solids from the files of other programs."""

from bearingdyn.fem.mesh_files.read_mesh import read_mesh

__all__ = ["read_mesh"]
