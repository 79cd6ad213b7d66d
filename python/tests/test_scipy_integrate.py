"""SciPy's own tests of ode, complex_ode and odeint, run with ours in their place."""

from borrowed_tests import borrow

import continuo

# What is different on purpose, with the reason.
DIFFERENCES = {
    "TestOde.test_concurrent_fail": "several runs at a time are no error here: no method keeps its data in a global",
}
# The same for single lines: what is tested instead.
PACKED = "a packed Jacobian without its bands is an error from the first call on; LSODA does not come to ask for it"
CHANGES = {
    "z, infodict = odeint(problem.f, problem.z0, t, Dfun=problem.jac,":
        ("z, infodict = odeint(problem.f, problem.z0, t, Dfun=problem.jac, ml=problem.lband, mu=problem.uband,", PACKED),
    "Dfun=lambda t, y: problem.jac(y, t),":
        ("Dfun=lambda t, y: problem.jac(y, t), ml=problem.lband, mu=problem.uband,", PACKED),
}
CHANGES_OF_BANDED = {
    "assert_allclose(yfinal, y1, rtol=1e-12)":
        ("assert_allclose(yfinal, y1, rtol=1e-8, atol=1e-11)", "not the operations of LSODA, whose own error is 4e-9"),
    "assert_equal((odeint_nst, odeint_nfe, odeint_nje), (nst, nfe, nje))":
        ("assert odeint_nfe >= odeint_nst > 0", "not the steps of LSODA"),
}

OURS = {"odeint": continuo.odeint, "ode": continuo.ode, "complex_ode": continuo.complex_ode}
globals().update(borrow("scipy.integrate.tests.test_integrate", OURS, DIFFERENCES, CHANGES))
globals().update(borrow("scipy.integrate.tests.test_odeint_jac", {"odeint": continuo.odeint}, changes=CHANGES_OF_BANDED))
