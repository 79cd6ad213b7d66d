// continuo/methods/implicit/stiff_part.hpp
#pragma once
#include <span>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

/// The system's stiff part alone, as a system: what an additive method treats implicitly. Its Jacobian is
/// stiff_jacobian(t, x, rows), where the system has it.
template <class System>
struct StiffPart {
  System& whole;

  template <State X>
  void operator()(const auto& t, const X& x, X& dxdt) const {
    whole.stiff(t, x, dxdt);
  }
  template <State X>
  void jacobian(const auto& t, const X& x, std::span<Scalar<X>> rows) const
    requires requires { whole.stiff_jacobian(t, x, rows); }
  {
    whole.stiff_jacobian(t, x, rows);
  }
};

}  // namespace continuo::detail
