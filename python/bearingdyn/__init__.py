"""Dynamics of rotors on ball bearings with viscoelastic layers, from measured rubber to a running motor.

SI units everywhere; z along the shaft, y vertical; interfaces in the order (x, y, z, θx, θy, θz).

A name is loaded when it is first asked for, so that a script which only reads rubber loads no more than that.
"""

from __future__ import annotations

from importlib import import_module

SUBPACKAGES = {
    "bearing": "bearing",
    "catalogue": "bearing.catalogue",
    "examples": "examples",
    "material": "material",
    "plot": "plot",
    "sound": "sound",
    "study": "study",
    "units": "units",
}
# public names by what they are about, with the room of each; the stub beside this file says the same
PUBLIC = {
    "material": {
        "material": (
            "STEEL",
            "BulkRelaxation",
            "DMAData",
            "Elastic",
            "FractionalZener",
            "MasterCurve",
            "Maxwell",
            "MooneyRivlin",
            "NeoHooke",
            "Payne",
            "PowerLaw",
            "RelaxationData",
            "StrainSweep",
            "TabulatedModulus",
            "Yeoh",
            "doubts",
            "fit_maxwell",
            "fit_payne",
            "master_curve",
            "read_dma",
            "read_strain_sweep",
            "sample_dma_path",
        ),
    },
    "bearing": {
        "bearing": (
            "BallBearing",
            "ConstantDamping",
            "FilmDamping",
            "LoadDamping",
            "LooseFit",
            "OilSupply",
            "Pit",
            "TabulatedDamping",
            "Waviness",
        ),
    },
    "part": {
        "parts": (
            "BoreShape",
            "Cylinder",
            "Disc",
            "EndFace",
            "Feet",
            "FlexibleBearing",
            "FlexibleBore",
            "FlexibleRing",
            "Groove",
            "Housing",
            "Imported",
            "Layer",
            "Line",
            "MeshNodes",
            "NodeSet",
            "ORing",
            "Patch",
            "Region",
            "Revolved",
            "RigidBody",
            "RigidSurface",
            "Ring",
            "RingBed",
            "RingPoints",
            "Section",
            "Shaft",
            "Solid",
            "SolidFamily",
            "Squeezed",
            "Where",
            "at_radius",
            "damping_sample",
            "quadrilaterals",
            "solid_family",
            "specimen_factor",
        ),
        "fem": (
            "MM_TONNE",
            "SolidMesh",
            "Units",
            "block_with_bore",
            "box_mesh",
            "o_ring_mesh",
            "read_matrices",
            "read_mesh",
            "read_nodes",
            "ring_mesh",
        ),
        "cms": (
            "FullModel",
            "Superelement",
            "reduction_error",
        ),
    },
    "application": {
        "application": ("Application",),
    },
    "analysis": {
        "analysis": (
            "Equilibrium",
            "OperatingPoint",
            "StateSpace",
            "ThermalNetwork",
            "ThermalRunaway",
            "ball_channels",
            "bearing_sheet",
            "cage_ratios",
            "campbell",
            "contact_statistics",
            "dissipation",
            "energy_shares",
            "envelope_spectrum",
            "equilibrium",
            "estimated_network",
            "export_stiffness",
            "frequency_response",
            "gradient",
            "mode_shapes",
            "mode_surfaces",
            "modes",
            "operating_point",
            "orbit",
            "order_spectrum",
            "parameter_map",
            "radiated_power",
            "ross_table",
            "shaft_angle",
            "sheet_html",
            "sheet_text",
            "spectrum",
            "speed_map",
            "state_space",
            "static_summary",
            "steady_state",
            "stiffness_table",
            "track_orders",
            "transient",
            "transients",
            "unbalance_response",
            "waterfall",
            "with_loaded_cages",
        ),
        "core": (
            "Interrupted",
            "Scheme",
            "SolverError",
        ),
    },
    "sound": {
        "sound": (
            "sound_contributions",
            "sound_intensity",
            "sound_power",
            "write_wav",
        ),
    },
    "model": {
        "model": ("Analysis", "Model", "read_model", "read_ross", "write_model"),
    },
    "result": {
        "results": (
            "open_result",
            "save",
        ),
        "reporting": ("report",),
        "explorer": ("Explorer",),
    },
}
_HOME = {name: home for homes in PUBLIC.values() for home, names in homes.items() for name in names}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    """A room, or a public name out of the room it lives in."""
    if name == "__version__":
        return import_module(f"{__name__}.results").versions()["bearingdyn"]
    if name in SUBPACKAGES:
        return import_module(f"{__name__}.{SUBPACKAGES[name]}")
    if name in _HOME:
        value: object = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *SUBPACKAGES, "__version__"})
