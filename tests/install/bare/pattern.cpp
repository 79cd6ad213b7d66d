// A system whose Jacobian has a pattern: refused where there is no sparse solver.
#include <vector>

#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/solve/solve.hpp>

struct Diffusion {
  continuo::SparsePattern pattern;
  void operator()(double, const std::vector<double>& x, std::vector<double>& dxdt) const { dxdt[0] = -x[0]; }
  const continuo::SparsePattern& jacobian_pattern() const { return pattern; }
};

int main() {
  const auto solution =
      continuo::solve(Diffusion{continuo::SparsePattern(1, {})}, std::vector{1.0}, {0, 1}, continuo::Bdf{});
  return solution.outcome ? 0 : 1;
}
