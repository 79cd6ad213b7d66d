// tests/hybrid/random.hpp
// Random numbers from the generator's bits alone, since the distributions of the standard differ between libraries.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace continuo::hybrid {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  long whole(long least, long most) {
    return least + static_cast<long>(bits_() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool chance(double probability) { return static_cast<double>(bits_() % 1000000) < probability * 1e6; }
  /// A decimal with three digits.
  double decimal(double least, double most) {
    return static_cast<double>(whole(std::lround(least * 1000), std::lround(most * 1000))) / 1000;
  }
  double signed_decimal(double least, double most) {
    const double size = decimal(least, most);
    return chance(0.5) ? size : -size;
  }
  template <class T>
  const T& any_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(whole(0, static_cast<long>(list.size()) - 1))];
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace continuo::hybrid
