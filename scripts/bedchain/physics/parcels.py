# SPDX-License-Identifier: GPL-3.0-or-later
"""Parcels: spheres that stand for several particles, so that a bed needs fewer of them."""

import math


def particles_in(diameters: float, thick: bool) -> float:
    """Particles of a bed that a parcel stands for [1].

    A parcel is as dense as a particle and fills its volume ``l^3`` times. A bed of one layer is ``l`` times
    as thick with parcels, so that ``l^2`` particles of it become one.

    Parameters
    ----------
    diameters : float
        Diameter of a parcel over that of a particle, l [1].
    thick : bool
        Whether the bed is many particles thick.
    """
    return diameters**3 if thick else diameters**2


def parcel_restitution(restitution: float, diameters: float) -> float:
    """Coefficient of restitution of parcels that lose as much energy per volume as their particles [1].

    In a volume there are ``l^-3`` as many parcels, ``l^2`` as large in section and ``l^3`` as heavy: at the
    same velocities collisions lose ``n^2 D^2 v m (1 - e^2)``, ``l^-1`` as much; ``1 - e_cg^2 = l (1 - e^2)``.
    Derived; `studies.verification.parcels` checks it by the cooling of a granular gas.

    Parameters
    ----------
    restitution : float
        Of the particles [1].
    diameters : float
        Diameter of a parcel over that of a particle, l [1].

    Returns
    -------
    float
        NaN where the parcels cannot lose that much.
    """
    # in this form exactly the particles' at l = 1
    square = restitution**2 - (diameters - 1) * (1 - restitution**2)
    return math.sqrt(square) if square >= 0 else math.nan
