// One type for the systems of several tests, so that a method is compiled once for them all.
#pragma once
#include <vector>

namespace continuo::solve_test {

using V = std::vector<double>;

/// f(t, x, dxdt) by a pointer.
struct AnyDerivative {
  void (*f)(double, const V&, V&);
  void operator()(double t, const V& x, V& dxdt) const { f(t, x, dxdt); }
};

}  // namespace continuo::solve_test
