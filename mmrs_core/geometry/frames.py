"""The local metric frame: geographic coordinates to metres east and north of an origin, and back."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from pyproj import CRS, Transformer

Floats: TypeAlias = NDArray[np.float64]

_ALIASES = {"wgs84": "EPSG:4326", "wgs 84": "EPSG:4326", "wgs-84": "EPSG:4326"}


class LocalFrame:
    """A plane that touches the ellipsoid of a geographic crs at an origin.

    A transverse Mercator projection with scale 1 at the origin: within 10 km of it, distances differ
    from those on the ellipsoid by less than a centimetre. Heights take no part.
    """

    def __init__(self, crs: str, latitude: float, longitude: float) -> None:
        """Lay the frame.

        Args:
            crs: a geographic crs in degrees, by any name that PROJ knows, or ``wgs84``.
            latitude: of the origin, degrees.
            longitude: of the origin, degrees.

        Raises:
            ValueError: the crs is not usable (see `known_crs`) or the origin is not on the Earth.
        """
        fault = known_crs(crs)
        if fault is not None:
            raise ValueError(fault)
        if not (abs(latitude) <= 90 and abs(longitude) <= 360):
            raise ValueError(f"origin {latitude}, {longitude} is not a latitude and longitude in degrees")
        self.crs = crs
        self.latitude = latitude
        self.longitude = longitude
        self._transformer = _transformer(crs, latitude, longitude)

    def to_local(self, latitudes: ArrayLike, longitudes: ArrayLike) -> Floats:
        """Return an (n, 2) array of metres east and north of the origin.

        Args:
            latitudes: degrees, n of them or one.
            longitudes: degrees, as many.

        Raises:
            ValueError: a coordinate cannot be projected; the message gives the first one.
        """
        north, east = (
            np.atleast_1d(np.asarray(latitudes, float)),
            np.atleast_1d(np.asarray(longitudes, float)),
        )
        wrong = ~((np.abs(north) <= 90) & (np.abs(east) <= 360))
        x, y = self._transformer.transform(east, north)
        local = np.column_stack([x, y]).astype(np.float64)
        wrong |= ~np.isfinite(local).all(axis=1)
        if wrong.any():
            first = int(np.flatnonzero(wrong)[0])
            raise ValueError(f"coordinate {north[first]}, {east[first]} cannot be projected from {self.crs}")
        return local

    def to_geographic(self, points: ArrayLike) -> Floats:
        """Return an (n, 2) array of latitude and longitude in degrees, in the frame's crs.

        Args:
            points: (n, 2) metres east and north of the origin.
        """
        local = np.asarray(points, float).reshape(-1, 2)
        longitudes, latitudes = self._transformer.transform(local[:, 0], local[:, 1], direction="INVERSE")
        return np.column_stack([latitudes, longitudes]).astype(np.float64)


@lru_cache(maxsize=64)
def known_crs(crs: str) -> str | None:
    """Return None for a crs that coordinates in degrees may be given in, else why it is none."""
    from pyproj.exceptions import CRSError

    try:
        known = _crs(crs)
    except CRSError:
        return f"crs {crs!r} is not known"
    if known.is_projected:
        return f"crs {crs!r} is projected, but coordinates are latitudes and longitudes in degrees"
    if not known.is_geographic:
        return f"crs {crs!r} is not geographic"
    units = {axis.unit_name for axis in known.axis_info[:2]}
    if units != {"degree"}:
        return f"crs {crs!r} counts in {' and '.join(sorted(units))}, not in degrees"
    return None


@lru_cache(maxsize=64)
def _crs(crs: str) -> CRS:
    from pyproj import CRS

    return CRS.from_user_input(_ALIASES.get(crs.strip().lower(), crs))


@lru_cache(maxsize=64)
def _transformer(crs: str, latitude: float, longitude: float) -> Transformer:
    """Return the projection of a frame; its steps are stated here, since PROJ takes long to find them."""
    from pyproj import Transformer

    ellipsoid = _crs(crs).ellipsoid
    assert ellipsoid is not None  # it is geographic
    flattening = ellipsoid.inverse_flattening
    figure = f"rf={flattening!r}" if flattening else f"b={ellipsoid.semi_minor_metre!r}"
    return Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=tmerc "
        f"+lat_0={latitude:.15g} +lon_0={longitude:.15g} +a={ellipsoid.semi_major_metre!r} +{figure}"
    )
