// continuo/symbolic/units/units.cpp
// The algebra of units and how they are printed. Reading them is in units_parse.cpp.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <continuo/symbolic/units/units.hpp>

namespace continuo::model {

Unit::Unit(std::string symbol, Dimension dimension, double factor)
    : Unit(Content{dimension, factor, {{std::move(symbol), Dimension::one}}}) {}

const Unit::Content& Unit::content() const {
  static const Content one;
  return content_ ? *content_ : one;
}

namespace {

/// Two factors agree to what a handful of roundings may differ.
bool same_factor(double a, double b) {
  return std::abs(a - b) <= 1e-13 * std::abs(a);
}

template <class Factors>
void merge(Factors& into, const Factors& from, int sign) {
  for (const auto& [symbol, exponent] : from) {
    const auto found = std::ranges::find(into, symbol, [](const auto& entry) { return entry.first; });
    if (found == into.end()) {
      into.emplace_back(symbol, sign * exponent);
    } else if (found->second += sign * exponent; found->second == 0) {
      into.erase(found);
    }
  }
}

Dimension combine(const Dimension& a, const Dimension& b, int sign) {
  Dimension sum = a;
  for (std::size_t i = 0; i < Dimension::count; ++i) sum.exponent[i] += sign * b.exponent[i];
  return sum;
}

}  // namespace

Unit operator*(const Unit& a, const Unit& b) {
  Unit::Content product = a.content();
  product.dimension = combine(a.dimension(), b.dimension(), 1);
  product.factor *= b.factor();
  merge(product.symbols, b.content().symbols, 1);
  return Unit(std::move(product));
}

Unit operator/(const Unit& a, const Unit& b) {
  Unit::Content quotient = a.content();
  quotient.dimension = combine(a.dimension(), b.dimension(), -1);
  quotient.factor /= b.factor();
  merge(quotient.symbols, b.content().symbols, -1);
  return Unit(std::move(quotient));
}

std::optional<Unit> power(const Unit& unit, int numerator, int denominator) {
  if (denominator == 0) return std::nullopt;
  if (numerator == 0) return Unit();
  Unit::Content result = unit.content();
  bool exact = true;
  const auto raise = [&](int exponent) {
    const long long product = static_cast<long long>(exponent) * numerator;
    exact = exact && product % denominator == 0 && std::abs(product / denominator) < 1'000'000;
    return exact ? static_cast<int>(product / denominator) : 0;
  };
  for (int& exponent : result.dimension.exponent) exponent = raise(exponent);
  for (auto& [symbol, exponent] : result.symbols) exponent = raise(exponent);
  if (!exact) return std::nullopt;
  result.factor = std::pow(unit.factor(), static_cast<double>(numerator) / denominator);
  return Unit(std::move(result));
}

std::optional<Unit> power(const Unit& unit, double exponent) {
  if (unit == Unit()) return unit;
  const double sixtieths = exponent * Dimension::one;
  if (!(std::abs(sixtieths) < 1e6) || std::abs(sixtieths - std::round(sixtieths)) > 1e-9) return std::nullopt;
  const int numerator = static_cast<int>(std::round(sixtieths)), common = std::gcd(numerator, Dimension::one);
  return power(unit, numerator / std::max(common, 1), Dimension::one / std::max(common, 1));
}

bool convertible(const Unit& a, const Unit& b) {
  return a.dimension() == b.dimension();
}

bool operator==(const Unit& a, const Unit& b) {
  return convertible(a, b) && same_factor(a.factor(), b.factor());
}

std::optional<double> conversion_factor(const Unit& from, const Unit& to) {
  if (!convertible(from, to)) return std::nullopt;
  return same_factor(from.factor(), to.factor()) ? 1.0 : from.factor() / to.factor();
}

namespace {

struct KnownUnit {
  const char* symbol;
  std::array<int, 4> exponent;  // of m, kg, s, A
};

/// The names a physicist would use for a product of the base units.
constexpr KnownUnit known_units[] = {
    {"m", {1, 0, 0, 0}},   {"kg", {0, 1, 0, 0}},   {"s", {0, 0, 1, 0}},     {"A", {0, 0, 0, 1}},
    {"N", {1, 1, -2, 0}},  {"J", {2, 1, -2, 0}},   {"W", {2, 1, -3, 0}},    {"Pa", {-1, 1, -2, 0}},
    {"C", {0, 0, 1, 1}},   {"V", {2, 1, -3, -1}},  {"ohm", {2, 1, -3, -2}}, {"F", {-2, -1, 4, 2}},
    {"H", {2, 1, -2, -2}}, {"Wb", {2, 1, -2, -1}}, {"T", {0, 1, -2, -1}},
};

const char* known_name(const Unit& unit) {
  if (!same_factor(unit.factor(), 1)) return nullptr;
  for (const KnownUnit& known : known_units) {
    Dimension dimension;
    for (std::size_t i = 0; i < known.exponent.size(); ++i) dimension.exponent[i] = known.exponent[i] * Dimension::one;
    if (dimension == unit.dimension()) return known.symbol;
  }
  return nullptr;
}

std::string with_exponent(const std::string& symbol, int sixtieths) {
  if (sixtieths == Dimension::one) return symbol;
  const int common = std::gcd(sixtieths, Dimension::one);
  const int numerator = sixtieths / common, denominator = Dimension::one / common;
  if (denominator == 1) return symbol + "^" + std::to_string(numerator);
  return symbol + "^(" + std::to_string(numerator) + "/" + std::to_string(denominator) + ")";
}

}  // namespace

std::string to_text(const Unit& unit) {
  std::string above, below;
  int divisors = 0;
  const Unit::Factors& symbols = unit.content().symbols;
  for (const auto& [symbol, exponent] : symbols) {
    std::string& side = exponent > 0 ? above : below;
    divisors += exponent < 0 ? 1 : 0;
    side += (side.empty() ? "" : "*") + with_exponent(symbol, std::abs(exponent));
  }
  if (symbols.empty()) return "1";
  if (symbols.size() > 1) {
    if (unit.dimensionless() && same_factor(unit.factor(), 1)) return "1";
    if (const char* name = known_name(unit)) return name;
  }
  if (below.empty()) return above;
  return (above.empty() ? "1" : above) + "/" + (divisors > 1 ? "(" + below + ")" : below);
}

}  // namespace continuo::model
