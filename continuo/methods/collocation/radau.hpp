// Radau IIA of orders 5, 9 and 13: L-stable, stiffly accurate. E. Hairer, G. Wanner, "Stiff differential equations
// solved by Radau methods", J. Comput. Appl. Math. 111 (1999). The numbers are derived in collocation_coefficients.hpp.
#pragma once
#include <string_view>

#include <continuo/methods/collocation/collocation.hpp>

namespace continuo {

struct Radau5 : CollocationMethod<collocation::Nodes::radau, 3> {
  static constexpr std::string_view name = "radau5";
};

struct Radau9 : CollocationMethod<collocation::Nodes::radau, 5> {
  static constexpr std::string_view name = "radau9";
};

struct Radau13 : CollocationMethod<collocation::Nodes::radau, 7> {
  static constexpr std::string_view name = "radau13";
};

/// Order 5, 9 or 13, as the solution allows.
struct Radau : CollocationMethod<collocation::Nodes::radau, 3, 5, 7> {
  static constexpr std::string_view name = "radau";
};

}  // namespace continuo
