// continuo/symbolic/units/units.hpp
// Units of measurement: what a number counts.
//
//   const Unit stiffness = *parse_unit("N/m"), metre = *parse_unit("m");
//   to_text(stiffness * metre);                                          // "N"
//   conversion_factor(*parse_unit("km/h"), *parse_unit("m/s"));  // 1/3.6
//
// The names come from UDUNITS-2; the usual ones are known here already, so that most models never load its database.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::model {

/// Exponents of the base units m, kg, s, A, K, mol, cd and of the two scales whose zero is not that of the kelvin,
/// in sixtieths: roots up to the sixth are whole numbers.
/// `degC` and `degF` are dimensions of their own: 20 degC is no number of kelvins until somebody says how.
struct Dimension {
  static constexpr int one = 60;
  static constexpr std::size_t count = 9;
  std::array<int, count> exponent{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

class Unit {
 public:
  /// The unit 1 of pure numbers.
  Unit() = default;
  /// A unit of one name, worth `factor` coherent SI units of this dimension.
  Unit(std::string symbol, Dimension dimension, double factor);

  [[nodiscard]] const Dimension& dimension() const { return content().dimension; }
  [[nodiscard]] double factor() const { return content().factor; }
  [[nodiscard]] bool dimensionless() const { return dimension() == Dimension{}; }

  friend Unit operator*(const Unit& a, const Unit& b);
  friend Unit operator/(const Unit& a, const Unit& b);
  friend std::optional<Unit> power(const Unit& unit, int numerator, int denominator);
  friend std::string to_text(const Unit& unit);

 private:
  using Factors = std::vector<std::pair<std::string, int>>;  // symbol and exponent in sixtieths, as the user wrote
  struct Content {
    Dimension dimension{};
    double factor = 1;
    Factors symbols{};
  };

  explicit Unit(Content content) : content_(std::make_shared<const Content>(std::move(content))) {}
  [[nodiscard]] const Content& content() const;

  std::shared_ptr<const Content> content_;  // shared by copies: the states of a grid have one unit; null is the unit 1
};

/// unit^(numerator/denominator); empty where the exponents leave the sixtieths.
[[nodiscard]] std::optional<Unit> power(const Unit& unit, int numerator, int denominator = 1);

/// unit^exponent for an exponent that is a fraction with a small denominator.
[[nodiscard]] std::optional<Unit> power(const Unit& unit, double exponent);

/// They measure the same thing: a number of one is so many of the other.
[[nodiscard]] bool convertible(const Unit& a, const Unit& b);

/// The same thing at the same size: N and kg*m/s^2.
bool operator==(const Unit& a, const Unit& b);

/// How many `to` one `from` is; empty where they are not convertible.
[[nodiscard]] std::optional<double> conversion_factor(const Unit& from, const Unit& to);

/// As short as it can be said: what the user wrote where symbols cancel to that, N for kg*m/s^2, `1` for a number.
[[nodiscard]] std::string to_text(const Unit& unit);

/// Reads `m/s^2`, `N*s`, `kg m2 s-2`, `km/h`, `1/s`, `(m/s)^0.5`, `60 s`, `rad`, `degC`, `1`.
/// Invalid input where the text is none: "`meterz` is not a unit".
[[nodiscard]] Result<Unit> parse_unit(std::string_view text);

/// A unit that may have been meant where the text is none, or empty.
[[nodiscard]] std::string suggested_unit(std::string_view text);

}  // namespace continuo::model
