# SPDX-License-Identifier: GPL-3.0-or-later
"""Height, bubbles and circulation to expect of a bubbling bed before it is simulated, with nothing fitted."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bedchain.physics import scene_numbers as numbers
from bedchain.physics import two_phase
from bedchain.physics.fluidization import ergun_velocity
from bedchain.physics.scene_numbers import Scene
from bedchain.physics.two_phase import RegimeError

MINIMUM_VOIDAGE = 0.45  # at minimum fluidization: random loose spheres, about
WAKE_SHARE = (
    0.25  # volume of a wake over that of its bubble; 0.2 to 0.3 for round grains (KL fig. 5.8, not verified)
)
HIGHEST_BED = 10.0  # a bed that expands further is none; in heights at minimum fluidization
POINTS = 4001  # heights of the integrals: their error is below 1e-6 of the bed's height
TURBULENT = (1.24, 0.45)  # Re_c = 1.24 Ar^0.45: Bi, Grace 1995, Chem. Eng. J. 57, 261, not verified


@dataclass(frozen=True)
class BubblingBed:
    """A bubbling bed by the two-phase model.

    Attributes
    ----------
    regime : str
        Of the bubbles at half the height of minimum fluidization; it holds for the whole bed.
    minimum_velocity : float
        u_mf by Ergun at the voidage `MINIMUM_VOIDAGE` [m/s].
    minimum_height : float
        Height at minimum fluidization [m].
    height : (n_heights,) array
        From the distributor to the surface of the bed [m].
    bubble_diameter, bubble_velocity, bubble_share : (n_heights,) array
        [m], [m/s], [1].
    """

    regime: str
    minimum_velocity: float
    minimum_height: float
    height: NDArray[np.float64]
    bubble_diameter: NDArray[np.float64]
    bubble_velocity: NDArray[np.float64]
    bubble_share: NDArray[np.float64]

    @property
    def bed_height(self) -> float:
        """Height of the surface [m]."""
        return float(self.height[-1])

    @property
    def mean_height(self) -> float:
        """Mean height of the particles [m]."""
        emulsion = 1 - self.bubble_share
        return float(np.trapezoid(self.height * emulsion, self.height) / self.minimum_height)

    @property
    def circulation_time(self) -> float:
        """Content of the bed over the flow that wakes carry up [s], ``H_mf / (f_w mean(delta u_b))``."""
        flow = np.trapezoid(self.bubble_share * self.bubble_velocity, self.height) / self.bed_height
        return float(self.minimum_height / (WAKE_SHARE * flow))

    def share_below(self, line: float) -> float:
        """Share of the particles below a height [1]; the height in [m]."""
        from scipy.integrate import cumulative_trapezoid  # late: scipy.integrate takes half a second to load

        content = cumulative_trapezoid(1 - self.bubble_share, self.height, initial=0)
        return float(np.interp(line, self.height, content) / self.minimum_height)

    def voidage(self) -> NDArray[np.float64]:
        """Voidage of bubbles and emulsion together at `height` [1], (n_heights,) array."""
        return 1 - (1 - self.bubble_share) * (1 - MINIMUM_VOIDAGE)


def bubbling_bed(scene: Scene) -> BubblingBed:
    """Bed of a scene: ``integral of (1 - delta) dz = H_mf``, bubbles by Darton from a porous plate.

    Parameters
    ----------
    scene : Scene
        Of `bedchain.case.scene.scene_of`.

    Raises
    ------
    RegimeError
        No gas, fixed bed, slugging, turbulent, or particles carried away.
    """
    minimum = ergun_velocity(
        MINIMUM_VOIDAGE, scene.diameter, scene.density, scene.gas_density, scene.viscosity
    )
    refuse_other_regimes(scene, minimum)
    packed = scene.depth * (1 - scene.voidage) / (1 - MINIMUM_VOIDAGE)
    excess = scene.velocity - minimum
    middle = two_phase.bubble_velocity(two_phase.darton_diameter(packed / 2, excess), excess)
    regime = two_phase.regime_of(scene.velocity, minimum, MINIMUM_VOIDAGE, float(middle))

    def share(height: ArrayLike) -> NDArray[np.float64]:
        bubbles = two_phase.bubble_velocity(two_phase.darton_diameter(height, excess), excess)
        return two_phase.bubble_share(scene.velocity, minimum, MINIMUM_VOIDAGE, bubbles, regime)

    height = np.linspace(0, surface(lambda place: float(share(place)), packed), POINTS)
    diameter = two_phase.darton_diameter(height, excess)
    two_phase.refuse_slugs(diameter, scene.width)
    bubbles = two_phase.bubble_velocity(diameter, excess)
    return BubblingBed(regime, minimum, packed, height, diameter, bubbles, share(height))


def surface(share: Callable[[float], float], packed: float) -> float:
    """Height that a bed expands to [m].

    Parameters
    ----------
    share : callable
        Share of bubbles [1] at a height [m].
    packed : float
        Height at minimum fluidization [m].

    Raises
    ------
    RegimeError
        Turbulent: the bed expands without end.
    """
    from scipy.integrate import quad  # late, as above
    from scipy.optimize import brentq

    def missing(height: float) -> float:
        return quad(lambda place: 1 - share(place), 0, height)[0] - packed

    if missing(HIGHEST_BED * packed) < 0:
        raise RegimeError("turbulent", f"the bed would expand more than {HIGHEST_BED:g} times")
    return float(brentq(missing, packed, HIGHEST_BED * packed))


def refuse_other_regimes(scene: Scene, minimum: float) -> None:
    """Raise `RegimeError` where the gas does not make a bubbling bed; `minimum` is u_mf [m/s]."""
    if not scene.gas:
        raise RegimeError("no gas", "the particles of this case move without gas")
    if scene.velocity <= minimum:
        raise RegimeError("fixed bed", f"the gas has {scene.velocity:.3g} m/s, u_mf is {minimum:.3g} m/s")
    factor, power = TURBULENT
    turbulent = (
        factor * numbers.archimedes(scene) ** power * scene.viscosity / (scene.gas_density * scene.diameter)
    )
    for regime, bound in (("transport", numbers.terminal_velocity(scene)), ("turbulent", turbulent)):
        if scene.velocity >= bound:
            raise RegimeError(regime, f"the gas has {scene.velocity:.3g} m/s, bubbles end at {bound:.3g} m/s")
