"""Noise, as it is heard: sound radiated by surfaces, its levels, and signals to listen to."""

from bearingdyn.sound.bands import band_filter, band_powers, bands, filtered_bands
from bearingdyn.sound.contributions import sound_contributions
from bearingdyn.sound.field import box_positions, far_field, far_power, hemisphere_positions, pressure_at
from bearingdyn.sound.hearing import loudness, pressure_signal, roughness, sharpness, weighted_signal
from bearingdyn.sound.intensity import panel_forces, sound_intensity
from bearingdyn.sound.levels import (
    band_levels,
    crest_factor,
    kurtosis,
    level,
    mean_squares,
    total,
    vibration_severity,
)
from bearingdyn.sound.power import sound_power
from bearingdyn.sound.power_gradient import sound_power_gradient
from bearingdyn.sound.radiation import Radiation, radiated_power, solve
from bearingdyn.sound.triangle_surface import TriangleSurface
from bearingdyn.sound.wav import read_wav, write_wav
from bearingdyn.sound.weighting import weighting

__all__ = [
    "Radiation",
    "TriangleSurface",
    "band_filter",
    "band_levels",
    "band_powers",
    "bands",
    "box_positions",
    "crest_factor",
    "far_field",
    "far_power",
    "filtered_bands",
    "hemisphere_positions",
    "kurtosis",
    "level",
    "loudness",
    "mean_squares",
    "panel_forces",
    "pressure_at",
    "pressure_signal",
    "radiated_power",
    "read_wav",
    "roughness",
    "sharpness",
    "solve",
    "sound_contributions",
    "sound_intensity",
    "sound_power",
    "sound_power_gradient",
    "total",
    "vibration_severity",
    "weighted_signal",
    "weighting",
    "write_wav",
]
