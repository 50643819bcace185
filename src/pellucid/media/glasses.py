"""Glasses: optical, technical and coloured. Coefficients to seven digits, good to 1e-7 in n."""

from __future__ import annotations

from typing import Final

from pellucid.media.formulas import PowerSeries, Sellmeier
from pellucid.media.medium import Medium

Triple = tuple[float, float, float]

# name, strengths, squared resonances (um^2), range (nm), absorption from the catalogue's internal
# transmittance at the three channels (1/m)
_SCHOTT: Final[tuple[tuple[str, Triple, Triple, tuple[float, float], Triple], ...]] = (
    ("N-BK7", (1.039612, 0.2317923, 1.010469), (0.006000699, 0.02001791, 103.5607), (300, 2500), (0.23, 0.16, 0.28)),
    ("N-BAK4", (1.288346, 0.1328177, 0.9453954), (0.007799806, 0.03156312, 105.9659), (334, 2500), (0.19, 0.16, 0.42)),
    ("N-K5", (1.085118, 0.199562, 0.9305117), (0.006610995, 0.02411087, 111.9828), (310, 2500), (0.26, 0.20, 0.35)),
    ("N-FK51A", (0.9712478, 0.2169014, 0.9046516), (0.00472302, 0.01535756, 168.6813), (290, 2500), (0.15, 0.12, 0.27)),
    ("N-PK52A", (1.029607, 0.1880506, 0.7364882), (0.005168002, 0.01666588, 138.9641), (290, 2500), (0.18, 0.12, 0.30)),
    ("N-SK16", (1.343178, 0.2411444, 0.9943179), (0.007046873, 0.0229005, 92.75085), (310, 2500), (0.27, 0.24, 0.61)),
    ("N-LAK9", (1.462319, 0.3443996, 1.155084), (0.007242701, 0.02433531, 85.46869), (300, 2500), (0.21, 0.24, 0.61)),
    ("N-LAK14", (1.507812, 0.3188668, 1.142872), (0.007460987, 0.02420248, 80.95652), (310, 2500), (0.31, 0.21, 0.61)),
    ("N-BAF10", (1.58515, 0.1435594, 1.085213), (0.009266813, 0.04244898, 105.6136), (350, 2500), (0.37, 0.40, 1.28)),
    ("N-KZFS4", (1.350554, 0.1975755, 1.09963), (0.008762821, 0.03717672, 90.3867), (334, 2500), (0.31, 0.32, 0.92)),
    ("LLF1", (1.216401, 0.1336645, 0.8833995), (0.008578072, 0.0420143, 107.5931), (310, 2500), (0.15, 0.12, 0.16)),
    ("F2", (1.345334, 0.2090732, 0.9373572), (0.009977438, 0.04704508, 111.8868), (320, 2500), (0.08, 0.08, 0.23)),
    ("N-F2", (1.39757, 0.1592014, 1.268654), (0.009959062, 0.05469317, 119.2483), (365, 2500), (0.34, 0.32, 1.05)),
    ("SF5", (1.461419, 0.247713, 0.9499958), (0.01118261, 0.05085947, 112.0419), (350, 2500), (0.19, 0.16, 0.46)),
    ("N-SF5", (1.524819, 0.1870855, 1.42729), (0.01125476, 0.05889954, 129.1417), (370, 2500), (0.46, 0.47, 1.71)),
    ("SF6", (1.724485, 0.3901049, 1.045729), (0.01348719, 0.05693181, 118.5572), (365, 2500), (0.18, 0.16, 0.83)),
    ("N-SF6", (1.779318, 0.3381499, 2.087345), (0.01337142, 0.06175336, 174.0176), (370, 2500), (0.87, 1.11, 3.82)),
    ("SF10", (1.61626, 0.2592293, 1.077623), (0.01275346, 0.0581984, 116.6077), (380, 2500), (0.26, 0.20, 0.84)),
    ("N-SF10", (1.621539, 0.2562878, 1.644476), (0.01222415, 0.05957368, 147.4688), (380, 2500), (0.92, 1.08, 3.61)),
    ("SF11", (1.738484, 0.311169, 1.174909), (0.01360686, 0.06159605, 121.9227), (390, 2500), (0.36, 0.44, 2.31)),
    ("N-SF11", (1.737597, 0.3137473, 1.898781), (0.01318871, 0.06230681, 155.2363), (370, 2500), (0.74, 0.87, 3.18)),
    ("N-SF57", (1.875438, 0.3737575, 2.300018), (0.01417495, 0.06405099, 177.3898), (370, 2500), (1.14, 1.39, 5.00)),
    ("N-SF66", (2.024598, 0.4701872, 2.599704), (0.01470532, 0.06929982, 161.8176), (390, 2500), (1.88, 3.65, 11.55)),
    ("N-LASF9", (2.000295, 0.2989269, 1.806918), (0.0121426, 0.05387362, 156.5308), (365, 2500), (0.86, 1.11, 4.08)),
    ("N-LASF46A", (2.167016, 0.3198128, 1.660045), (0.01235955, 0.05606103, 107.0477), (370, 2500), (0.69, 0.87, 3.98)),
)

_SODA_LIME: Final = PowerSeries(((1.5130, 0), (-0.003169, 2), (0.003962, -2)))

# name, absorption (1/m); clear, green, bronze and grey are measured window glasses
_WINDOWS: Final[tuple[tuple[str, Triple], ...]] = (
    ("soda-lime glass", (10.9, 5.0, 4.6)),
    ("green window glass", (52.3, 26.7, 23.3)),
    ("bronze window glass", (80.9, 86.0, 119.5)),
    ("grey window glass", (137.0, 113.5, 122.8)),
)

# name, absorption (1/m), such that a wall of 3 mm has the colour that the name promises
_COLOURED: Final[tuple[tuple[str, Triple], ...]] = (
    ("bottle green glass", (190.0, 90.0, 420.0)),
    ("amber glass", (120.0, 350.0, 1200.0)),
    ("cobalt blue glass", (700.0, 450.0, 15.0)),
    ("ruby red glass", (20.0, 700.0, 600.0)),
)


def _schott(name: str, b: Triple, c: Triple, valid_nm: tuple[float, float], absorption: Triple) -> Medium:
    catalogue = f"Schott optical glass catalogue, {name} [schott2017]"
    return Medium(name, "glass", catalogue, Sellmeier(b, c), valid_nm, absorption, catalogue)


def _window(name: str, absorption: Triple, absorption_source: str) -> Medium:
    source = "soda-lime silica window glass [rubin1985]"
    return Medium(name, "glass", source, _SODA_LIME, (320.0, 4600.0), absorption, absorption_source)


MEDIA: Final[tuple[Medium, ...]] = (
    *(_schott(*row) for row in _SCHOTT),
    *(_window(name, absorption, "window glass [rubin1985]") for name, absorption in _WINDOWS),
    *(_window(name, absorption, "representative") for name, absorption in _COLOURED),
    Medium(
        "fused silica",
        "glass",
        "20 C [malitson1965]",
        Sellmeier.of_resonances((0.6961663, 0.4079426, 0.8974794), (0.0684043, 0.1162414, 9.896161)),
        (210.0, 3710.0),
    ),
)

ALIASES: Final = {
    "BK7": "N-BK7",
    "crown glass": "N-BK7",
    "glass": "N-BK7",
    "flint glass": "F2",
    "lead crystal": "SF5",
    "window glass": "soda-lime glass",
    "silica": "fused silica",
    "SiO2": "fused silica",
    "bottle glass": "bottle green glass",
    "cobalt glass": "cobalt blue glass",
    "red glass": "ruby red glass",
    "brown glass": "amber glass",
}
