"""One-sided rocking masonry walls in MuJoCo, and the energy lost at every impact.

Units are SI, angles radians, damping ratios fractions. `Block` is the wall, `Case` the problem, `Contacts` the
compliant interfaces; `simulate` asks MuJoCo, `solve_compliant` asks SciPy the same contact law, `solve_analytical` asks
classical rocking theory, and `compare` sets two answers side by side.
"""

from ._version import __version__
from .analytical import solve_analytical
from .block import GRAVITY, Block
from .calibration import Plan, calibrate
from .campaign import Analysis, Grid, campaign, results
from .case import Case
from .compare import Comparison, compare
from .compliant import solve_compliant
from .contact import ContactParameters, contact_parameters, contact_stiffness
from .damping import CALIBRATED, CALIBRATED_BED, PUBLISHED, DampingLaw, PowerLaw
from .interface import Contacts, Interface, reference_frequency
from .ledger import Ledger
from .mjcf import wall_mjcf
from .motion import GroundMotion
from .response import Impact, Outcome, Response
from .restitution import Restitution
from .simulation import SimulationError, automatic_timestep, simulate, simulate_batch
from .store import Store

__all__ = [
    "CALIBRATED",
    "CALIBRATED_BED",
    "GRAVITY",
    "PUBLISHED",
    "Analysis",
    "Block",
    "Case",
    "Comparison",
    "ContactParameters",
    "Contacts",
    "DampingLaw",
    "Grid",
    "GroundMotion",
    "Impact",
    "Interface",
    "Ledger",
    "Outcome",
    "Plan",
    "PowerLaw",
    "Response",
    "Restitution",
    "SimulationError",
    "Store",
    "__version__",
    "automatic_timestep",
    "calibrate",
    "campaign",
    "compare",
    "contact_parameters",
    "contact_stiffness",
    "reference_frequency",
    "results",
    "simulate",
    "simulate_batch",
    "solve_analytical",
    "solve_compliant",
    "wall_mjcf",
]
