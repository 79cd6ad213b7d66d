// continuo/symbolic/units/unit_check.cpp
// The unit of a product, a quotient and a sum, where one of the units may be unknown.
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model::detail {

Measured product(const Measured& a, const Measured& b) {
  if (a.kind == Measured::Kind::unknown || b.kind == Measured::Kind::unknown) return Measured::unknown();
  if (a.is_number()) return b;
  if (b.is_number()) return a;
  return Measured::known(a.unit * b.unit);
}

Measured quotient(const Measured& a, const Measured& b) {
  if (a.kind == Measured::Kind::unknown || b.kind == Measured::Kind::unknown) return Measured::unknown();
  if (b.is_number()) return a;
  return Measured::known(a.is_number() ? Unit() / b.unit : a.unit / b.unit);
}

Measured common(const Measured& a, const Measured& b) {
  if (a.kind == Measured::Kind::unknown || b.kind == Measured::Kind::unknown) return Measured::unknown();
  return a.is_known() ? a : b;
}

std::optional<double> factor_between(const Measured& from, const Measured& to) {
  if (!from.is_known() || !to.is_known()) return 1.0;
  return conversion_factor(from.unit, to.unit);
}

}  // namespace continuo::model::detail
