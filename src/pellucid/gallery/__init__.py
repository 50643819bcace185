"""Pictures that show what the renderer does; `pellucid demo` and `pellucid gallery` render them."""

from . import (
    amber,
    company,
    crystals,
    glow,
    light,
    relief,
    relief_layers,
    relief_rain,
    relief_views,
    sheet,
    solids,
    table,
    waters,
)
from .picture import Picture

#: All pictures, in the order in which they are shown.
PICTURES: tuple[Picture, ...] = (
    *solids.PICTURES,
    *table.PICTURES,
    *light.PICTURES,
    *amber.PICTURES,
    *crystals.PICTURES,
    *glow.PICTURES,
    *company.PICTURES,
    *relief.PICTURES,
    *relief_layers.PICTURES,
    *relief_rain.PICTURES,
    *relief_views.PICTURES,
    *sheet.PICTURES,
    *waters.PICTURES,
)

__all__ = ["PICTURES", "Picture"]
