"""Noise, as it is heard: sound radiated by surfaces, its levels, and signals to listen to."""

from bearingdyn.sound.field import (
    box_positions as box_positions,
)
from bearingdyn.sound.field import (
    far_field as far_field,
)
from bearingdyn.sound.field import (
    far_power as far_power,
)
from bearingdyn.sound.field import (
    hemisphere_positions as hemisphere_positions,
)
from bearingdyn.sound.field import (
    pressure_at as pressure_at,
)
from bearingdyn.sound.power import sound_power as sound_power
from bearingdyn.sound.radiation import (
    Radiation as Radiation,
)
from bearingdyn.sound.radiation import (
    radiated_power as radiated_power,
)
from bearingdyn.sound.radiation import (
    solve as solve,
)
from bearingdyn.sound.triangle_surface import TriangleSurface as TriangleSurface
