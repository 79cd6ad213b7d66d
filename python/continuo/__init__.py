"""Continuo simulates continuous systems: SciPy's interface to its integrators, models as text, and rigid bodies."""

from ._continuo import __version__

__all__ = ["__version__"]
