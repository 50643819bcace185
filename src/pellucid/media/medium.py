"""What a thing is made of, as far as light is concerned."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.errors import SceneError
from pellucid.media.formulas import LINE_C_UM, LINE_D_UM, LINE_F_UM, Constant, Formula

RGB_LAMBDA_NM: Final = (611.4, 549.1, 464.3)
"""Wavelengths of the three channels; equal to ``optics.dispersion.RGB_LAMBDA_NM``, as a test holds."""

CLEAR: Final = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Medium:
    """A homogeneous medium; one with an ``extraordinary`` ray is a uniaxial crystal.

    Indices and wavelengths are as the source states them: solids and liquids against air, gases and
    [daimon2007] against vacuum. The two differ by a factor of 1.00027, which no picture shows.

    Parameters
    ----------
    name : canonical name.
    kind : ``glass``, ``crystal``, ``gem``, ``liquid``, ``water``, ``plastic``, ``gas`` or ``constant``.
    source : where the index comes from; ``[key]`` resolves in ``docs/references.bib``.
    formula : index as a function of the wavelength in micrometres.
    valid_nm : range of wavelengths that the source covers, nm.
    absorption_per_m : extinction by absorption at the three channels, 1/m, >= 0.
    absorption_source : where the absorption comes from; ``representative`` says that it is an
        estimate of ours for a typical specimen, not a measurement.
    extraordinary : of a uniaxial crystal, index and absorption for light polarised along the optic axis; the
        medium itself then is the ordinary ray. A body is drawn with two images when its region has an ``optic_axis``.
    """

    name: str
    kind: str
    source: str
    formula: Formula
    valid_nm: tuple[float, float]
    absorption_per_m: tuple[float, float, float] = CLEAR
    absorption_source: str = "treated as clear"
    extraordinary: Medium | None = None

    def n(self, lambda_nm: ArrayLike) -> NDArray[np.float64]:
        """Refractive index at wavelengths in nm; same shape as the argument.

        Raises
        ------
        SceneError : for a wavelength outside ``valid_nm``, which it names.
        """
        wavelengths = np.asarray(lambda_nm, float)
        low, high = self.valid_nm
        inside = (wavelengths >= low) & (wavelengths <= high)
        if not np.all(inside):
            worst = wavelengths[~inside].flat[0]
            raise SceneError(
                "lambda_nm",
                f"{worst:g} nm is outside the range of {self.name}",
                f"it is known from {low:g} to {high:g} nm",
            )
        return self.formula(wavelengths * 1e-3)

    @property
    def n_rgb(self) -> NDArray[np.float64]:
        """Index at the three channels, (3,)."""
        return self.n(RGB_LAMBDA_NM)

    @property
    def absorption_rgb_per_m(self) -> NDArray[np.float64]:
        """Extinction by absorption at the three channels, 1/m, (3,); 0 when clear."""
        return np.array(self.absorption_per_m, float)

    @property
    def scattering_rgb_per_m(self) -> NDArray[np.float64]:
        """Extinction by scattering at the three channels, 1/m, (3,); 0 in all but a WaterBody."""
        return np.zeros(3)

    @property
    def asymmetry(self) -> float:
        """Mean cosine of the phase function; 0 in all but a WaterBody."""
        return 0.0

    @property
    def is_uniaxial(self) -> bool:
        """Whether this is a crystal with an ordinary and an extraordinary ray."""
        return self.extraordinary is not None

    def n_e(self, lambda_nm: ArrayLike) -> NDArray[np.float64]:
        """Extraordinary index at wavelengths in nm; the index itself where the medium is isotropic."""
        return (self.extraordinary or self).n(lambda_nm)

    @property
    def n_e_rgb(self) -> NDArray[np.float64]:
        """Extraordinary index at the three channels, (3,)."""
        return (self.extraordinary or self).n_rgb

    @property
    def absorption_e_rgb_per_m(self) -> NDArray[np.float64]:
        """Extinction of the extraordinary ray across the optic axis, at the three channels, 1/m, (3,)."""
        return (self.extraordinary or self).absorption_rgb_per_m

    @property
    def n_d(self) -> float:
        """Index at the helium d line, 587.6 nm."""
        return float(self.n(LINE_D_UM * 1e3))

    @property
    def abbe(self) -> float:
        """Abbe number, V = (n_d - 1)/(n_F - n_C) [born1999, 4.7.1]; infinite without dispersion."""
        n_d, n_f, n_c = self.n(np.array([LINE_D_UM, LINE_F_UM, LINE_C_UM]) * 1e3)
        return float((n_d - 1.0) / (n_f - n_c)) if n_f != n_c else math.inf

    @property
    def is_dispersive(self) -> bool:
        """Whether an index depends on wavelength."""
        other = self.extraordinary
        return not isinstance(self.formula, Constant) or (other is not None and other.is_dispersive)

    def with_absorption(
        self,
        rgb_per_m: Sequence[float],
        name: str | None = None,
        extraordinary_rgb_per_m: Sequence[float] | None = None,
    ) -> Medium:
        """The same index with another colour: extinction at the three channels, 1/m.

        Parameters
        ----------
        extraordinary_rgb_per_m : of a crystal, extinction of the extraordinary ray; that of the ordinary one
            when not given.

        Raises
        ------
        SceneError : for anything but three finite values >= 0; for an extraordinary ray of an isotropic medium.
        """
        changed = replace(
            self,
            name=name or f"{self.name}, coloured",
            absorption_per_m=checked_absorption(rgb_per_m),
            absorption_source="given by the user",
        )
        if self.extraordinary is None:
            if extraordinary_rgb_per_m is not None:
                raise SceneError("absorption_e_rgb_per_m", f"{self.name} has no extraordinary ray", "leave it out")
            return changed
        other = rgb_per_m if extraordinary_rgb_per_m is None else extraordinary_rgb_per_m
        return replace(changed, extraordinary=self.extraordinary.with_absorption(other, self.extraordinary.name))


def checked_absorption(rgb_per_m: Sequence[float]) -> tuple[float, float, float]:
    """Three finite extinctions >= 0, 1/m, or a SceneError."""
    values = np.asarray(rgb_per_m, float)
    if values.shape != (3,) or not np.all(np.isfinite(values)) or np.any(values < 0.0):
        raise SceneError(
            "absorption_rgb_per_m", f"{rgb_per_m!r} is not three finite values >= 0", "give (r, g, b) in 1/m"
        )
    red, green, blue = values.tolist()
    return red, green, blue


def constant(n: float, absorption_rgb_per_m: Sequence[float] = CLEAR, name: str | None = None) -> Medium:
    """A medium of one index at every wavelength.

    Parameters
    ----------
    n : index, > 0.
    absorption_rgb_per_m : extinction at the three channels, 1/m.
    name : how it is called in messages; ``n = 1.5`` when not given.

    Raises
    ------
    SceneError : when the index is not a finite number > 0, or the absorption is not three values >= 0.
    """
    if not math.isfinite(n) or n <= 0.0:
        raise SceneError("n", f"{n!r} is not a refractive index", "give a finite number > 0")
    return Medium(
        name=name or f"n = {n:g}",
        kind="constant",
        source="given by the user",
        formula=Constant(float(n)),
        valid_nm=(0.0, math.inf),
        absorption_per_m=checked_absorption(absorption_rgb_per_m),
    )


def uniaxial(
    n_o: float,
    n_e: float,
    absorption_rgb_per_m: Sequence[float] = CLEAR,
    absorption_e_rgb_per_m: Sequence[float] | None = None,
    name: str | None = None,
) -> Medium:
    """A uniaxial crystal of two indices, the same at every wavelength.

    Parameters
    ----------
    n_o, n_e : ordinary and extraordinary index, > 0.
    absorption_rgb_per_m : extinction of the ordinary ray at the three channels, 1/m.
    absorption_e_rgb_per_m : of the extraordinary ray across the axis; that of the ordinary one when not given.
    name : how it is called in messages.

    Raises
    ------
    SceneError : as :func:`constant`.
    """
    title = name or f"n_o = {n_o:g}, n_e = {n_e:g}"
    other = absorption_rgb_per_m if absorption_e_rgb_per_m is None else absorption_e_rgb_per_m
    ray = constant(n_e, other, extraordinary_name(title))
    return replace(constant(n_o, absorption_rgb_per_m, title), extraordinary=ray)


def extraordinary_name(name: str) -> str:
    """What the extraordinary ray of a crystal is called."""
    return f"{name}, extraordinary ray"
