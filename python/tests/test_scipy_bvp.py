"""SciPy's own tests of solve_bvp, run with ours in its place.

SciPy's installed file is executed with the name `solve_bvp` replaced. Its tests of SciPy's inner functions
(modify_mesh and others, which are not part of the interface) remain tests of SciPy.
"""

from borrowed_tests import borrow

import continuo

globals().update(borrow("scipy.integrate.tests.test_bvp", {"solve_bvp": continuo.solve_bvp}))
