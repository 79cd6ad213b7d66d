// continuo/symbolic/units/units_database.cpp
// The table of usual units and prefixes, and the search in UDUNITS-2 for all others.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <udunits2.h>

#include <continuo/symbolic/names/suggest.hpp>
#include <continuo/symbolic/units/units_database.hpp>

namespace continuo::model::detail {

namespace {

struct UsualUnit {
  std::string_view name;
  double factor;
  std::array<int, Dimension::count> exponent;  // m, kg, s, A, K, mol, cd, degC, degF
  bool takes_prefix = false;
};

constexpr double pi = std::numbers::pi;

/// Definitions of the SI brochure; a test holds them to UDUNITS-2.
constexpr UsualUnit usual_units[] = {
    {"m", 1, {1}, true},
    {"g", 1e-3, {0, 1}, true},
    {"kg", 1, {0, 1}},
    {"s", 1, {0, 0, 1}, true},
    {"A", 1, {0, 0, 0, 1}, true},
    {"K", 1, {0, 0, 0, 0, 1}, true},
    {"mol", 1, {0, 0, 0, 0, 0, 1}, true},
    {"cd", 1, {0, 0, 0, 0, 0, 0, 1}},
    {"degC", 1, {0, 0, 0, 0, 0, 0, 0, 1}},
    {"degF", 1, {0, 0, 0, 0, 0, 0, 0, 0, 1}},
    {"rad", 1, {}, true},
    {"radian", 1, {}},
    {"deg", pi / 180, {}},
    {"degree", pi / 180, {}},
    {"%", 0.01, {}},
    {"percent", 0.01, {}},
    {"min", 60, {0, 0, 1}},
    {"h", 3600, {0, 0, 1}},
    {"hour", 3600, {0, 0, 1}},
    {"d", 86400, {0, 0, 1}},
    {"day", 86400, {0, 0, 1}},
    {"Hz", 1, {0, 0, -1}, true},
    {"N", 1, {1, 1, -2}, true},
    {"Pa", 1, {-1, 1, -2}, true},
    {"bar", 1e5, {-1, 1, -2}, true},
    {"J", 1, {2, 1, -2}, true},
    {"W", 1, {2, 1, -3}, true},
    {"C", 1, {0, 0, 1, 1}, true},
    {"V", 1, {2, 1, -3, -1}, true},
    {"ohm", 1, {2, 1, -3, -2}, true},
    {"S", 1, {-2, -1, 3, 2}, true},
    {"F", 1, {-2, -1, 4, 2}, true},
    {"H", 1, {2, 1, -2, -2}, true},
    {"Wb", 1, {2, 1, -2, -1}, true},
    {"T", 1, {0, 1, -2, -1}, true},
    {"L", 1e-3, {3}, true},
    {"l", 1e-3, {3}, true},
    {"t", 1000, {0, 1}},
    // Measured values: CODATA 2018, where UDUNITS-2 keeps those of 1986.
    {"eV", 1.602176634e-19, {2, 1, -2}, true},
    {"amu", 1.66053906660e-27, {0, 1}},
    {"u", 1.66053906660e-27, {0, 1}},
    {"au", 1.495978707e11, {1}},
};

struct Prefix {
  std::string_view symbol;
  double factor;
};
constexpr Prefix prefixes[] = {{"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6}, {"\u00b5", 1e-6}, {"m", 1e-3},
                               {"c", 1e-2},  {"d", 1e-1},  {"k", 1e3},  {"M", 1e6},  {"G", 1e9},       {"T", 1e12}};

Unit unit_of(const UsualUnit& usual, std::string_view name, double prefix) {
  Dimension dimension;
  for (std::size_t i = 0; i < Dimension::count; ++i) dimension.exponent[i] = usual.exponent[i] * Dimension::one;
  return Unit(std::string(name), dimension, usual.factor * prefix);
}

}  // namespace

std::optional<Unit> usual_unit(std::string_view name) {
  const auto exact = std::ranges::find(usual_units, name, &UsualUnit::name);
  if (exact != std::end(usual_units)) return unit_of(*exact, name, 1);
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.symbol)) continue;
    const auto base = std::ranges::find(usual_units, name.substr(prefix.symbol.size()), &UsualUnit::name);
    if (base != std::end(usual_units) && base->takes_prefix) return unit_of(*base, name, prefix.factor);
  }
  return std::nullopt;
}

namespace {

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};

/// Read once, on the first name that is not a usual one: milliseconds that most runs need not pay.
ut_system* database() {
  static const std::unique_ptr<ut_system, FreeSystem> loaded = [] {
    ut_set_error_message_handler(ut_ignore);
    return std::unique_ptr<ut_system, FreeSystem>(ut_read_xml(nullptr));
  }();
  return loaded.get();
}

/// What a unit of UDUNITS-2 is made of.
struct Found {
  Dimension dimension;
  double factor = 1;
  double offset = 0;
  bool usable = true;
};

ut_status add_basic(const ut_unit* unit, int exponent, Found& found) {
  constexpr std::string_view base[] = {"m", "kg", "s", "A", "K", "mol", "cd"};
  const char* symbol = ut_get_symbol(unit, UT_ASCII);
  const auto known = std::ranges::find(base, std::string_view(symbol ? symbol : ""));
  // The radian is a basic unit without dimension.
  if (known != std::end(base)) {
    found.dimension.exponent[static_cast<std::size_t>(known - base)] += exponent * Dimension::one;
  }
  return UT_SUCCESS;
}

ut_status visit_basic(const ut_unit* unit, void* found) {
  return add_basic(unit, 1, *static_cast<Found*>(found));
}

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* basic, const int* powers, void* found) {
  for (int i = 0; i < count; ++i) add_basic(basic[i], powers[i], *static_cast<Found*>(found));
  return UT_SUCCESS;
}

constexpr ut_status visit_unusable(void* found) {
  static_cast<Found*>(found)->usable = false;
  return UT_SUCCESS;
}

ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* found) {
  return visit_unusable(found);
}
ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void* found) {
  return visit_unusable(found);
}
ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* found);

const ut_visitor visitor = {visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* found) {
  static_cast<Found*>(found)->factor *= scale;
  static_cast<Found*>(found)->offset += offset;
  return ut_accept_visitor(underlying, &visitor, found);
}

/// Scales whose zero is not the kelvin's are dimensions of their own; two are known.
bool place_scale(Found& found) {
  if (found.offset == 0) return true;
  const bool fahrenheit = std::abs(found.factor - 5.0 / 9) < 1e-9;
  if (!fahrenheit && found.factor != 1) return false;
  found.dimension = {};
  found.dimension.exponent[fahrenheit ? 8 : 7] = Dimension::one;
  found.factor = 1;
  return true;
}

}  // namespace

Result<Unit> database_unit(const std::string& name) {
  ut_system* const system = database();
  if (system == nullptr) {
    return Status{.ending = Ending::unreadable,
                  .message = "the units database of UDUNITS-2 cannot be read, which is needed for `" + name + "`"};
  }
  const std::unique_ptr<ut_unit, FreeUnit> parsed(ut_parse(system, name.c_str(), UT_UTF8));
  if (parsed == nullptr) {
    return invalid_input("`" + name + "` is not a unit");
  }
  Found found;
  if (ut_accept_visitor(parsed.get(), &visitor, &found) != UT_SUCCESS || !found.usable || !place_scale(found)) {
    return invalid_input("`" + name + "` has no fixed size, so it cannot be used in equations");
  }
  return Unit(name, found.dimension, found.factor);
}

std::string nearest_usual_name(std::string_view name) {
  // Words people write in full, and the symbol that is meant.
  constexpr std::pair<std::string_view, std::string_view> words[] = {
      {"sec", "s"},  {"secs", "s"},       {"seconds", "s"}, {"msec", "ms"}, {"Newton", "N"}, {"Joule", "J"},
      {"Watt", "W"}, {"Kg", "kg"},        {"KG", "kg"},     {"M", "m"},     {"hrs", "h"},    {"mins", "min"},
      {"Volt", "V"}, {"Celsius", "degC"}, {"gr", "g"},      {"rads", "rad"}};
  for (const auto& [word, symbol] : words) {
    if (word == name) return std::string(symbol);
  }
  std::vector<std::string_view> names;
  for (const UsualUnit& usual : usual_units) {
    if (usual.name.size() > 1) names.push_back(usual.name);  // every short word is near to a letter
  }
  return suggest(name, names).value_or("");
}

}  // namespace continuo::model::detail
