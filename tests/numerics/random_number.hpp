// Numbers for random systems of equations.
#pragma once
#include <random>
#include <type_traits>

namespace continuo {

/// Between -1 and 1, each part of a complex one.
template <class Number>
Number random_number(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  if constexpr (std::is_floating_point_v<Number>) {
    return Number(uniform(engine));
  } else {
    return {uniform(engine), uniform(engine)};
  }
}

}  // namespace continuo
