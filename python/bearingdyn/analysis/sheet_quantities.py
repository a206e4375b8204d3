"""Quantities of the bearing sheet: their names, units and meanings, and how they stand on the page."""

from __future__ import annotations

import math

# name: unit, meaning, factor and unit in print; in the order of the page, under its headings
ROWS: dict[str, dict[str, tuple[str, str, float, str]]] = {
    "Geometry": {
        "balls": ("1", "number of balls", 1, ""),
        "ball_diameter": ("m", "ball diameter", 1e3, "mm"),
        "pitch_diameter": ("m", "pitch diameter", 1e3, "mm"),
        "groove_inner": ("1", "groove radius over ball diameter, inner race", 1, ""),
        "groove_outer": ("1", "groove radius over ball diameter, outer race", 1, ""),
        "clearance": ("m", "diametral clearance", 1e6, "µm"),
        "free_angle": ("rad", "free contact angle", 180 / math.pi, "°"),
    },
    "Load": {
        "radial_load": ("N", "radial load", 1, "N"),
        "axial_load": ("N", "axial load", 1, "N"),
        "ball_load": ("N", "heaviest ball", 1, "N"),
        "loaded_balls": ("1", "loaded balls", 1, ""),
        "contact_angle": ("rad", "contact angle of the heaviest ball", 180 / math.pi, "°"),
        "pressure_inner": ("Pa", "contact pressure, inner race", 1e-9, "GPa"),
        "pressure_outer": ("Pa", "contact pressure, outer race", 1e-9, "GPa"),
        "ellipse_inner": ("m", "length of the contact ellipse, inner race", 1e3, "mm"),
        "ellipse_outer": ("m", "length of the contact ellipse, outer race", 1e3, "mm"),
        "cut_inner": ("1", "share of the ellipse cut by the shoulder, inner race", 100, "%"),
        "cut_outer": ("1", "share of the ellipse cut by the shoulder, outer race", 100, "%"),
    },
    "Rating and life": {
        "C": ("N", "basic dynamic rating C", 1, "N"),
        "C0": ("N", "basic static rating C0", 1, "N"),
        "P": ("N", "dynamic equivalent load P (ISO 281)", 1, "N"),
        "P0": ("N", "static equivalent load P0 (ISO 76)", 1, "N"),
        "static_safety": ("1", "static safety C0/P0", 1, ""),
        "pressure_safety": ("1", "static safety by load at 4.2 GPa over the heaviest ball's", 1, ""),
        "L10": ("million revolutions", "basic rating life (C/P)³", 1, "million rev."),
        "L10r": ("million revolutions", "basic reference rating life (ISO/TS 16281)", 1, "million rev."),
        "L10rh": ("h", "the same in hours", 1, "h"),
        "kappa": ("1", "viscosity ratio κ", 1, ""),
        "a_iso": ("1", "a1 a_ISO", 1, ""),
        "L10mh": ("h", "modified reference rating life", 1, "h"),
        "duty_life": ("h", "life of the duty cycle", 1, "h"),
    },
    "Film and friction": {
        "temperature": ("°C", "temperature of the oil", 1, "°C"),
        "viscosity": ("m²/s", "kinematic viscosity", 1e6, "mm²/s"),
        "alpha": ("1/Pa", "α of the oil; by Wooster's rule where it is not given", 1e8, "· 1e-8/Pa"),
        "film_inner": ("m", "central film, inner race", 1e6, "µm"),
        "film_outer": ("m", "central film, outer race", 1e6, "µm"),
        "lambda_inner": ("1", "film over roughness, inner race", 1, ""),
        "lambda_outer": ("1", "film over roughness, outer race", 1, ""),
        "friction_moment": ("N m", "frictional moment", 1e3, "N mm"),
        "friction_power": ("W", "frictional power", 1, "W"),
    },
    "Stiffness of the balls": {
        "stiffness_x": ("N/m", "along x", 1e-6, "N/µm"),
        "stiffness_y": ("N/m", "along y", 1e-6, "N/µm"),
        "stiffness_z": ("N/m", "along z", 1e-6, "N/µm"),
    },
    "Lines": {
        "shaft": ("Hz", "shaft", 1, "Hz"),
        "FTF": ("Hz", "cage", 1, "Hz"),
        "BPFO": ("Hz", "balls past a spot of the outer race", 1, "Hz"),
        "BPFI": ("Hz", "balls past a spot of the inner race", 1, "Hz"),
        "2 BSF": ("Hz", "spot of a ball past a race", 1, "Hz"),
    },
}
MEANING = {name: row for group in ROWS.values() for name, row in group.items()}
"""The same without headings."""
