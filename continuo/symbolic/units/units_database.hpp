// continuo/symbolic/units/units_database.hpp
// What one unit name is worth: from the short table here, else from UDUNITS-2. Internal to units.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/symbolic/units/units.hpp>

namespace continuo::model::detail {

/// The usual names with their exact definitions; no database is read.
std::optional<Unit> usual_unit(std::string_view name);

/// What UDUNITS-2 knows under this name.
Result<Unit> database_unit(const std::string& name);

/// The usual name nearest to this one, or nothing.
std::string nearest_usual_name(std::string_view name);

}  // namespace continuo::model::detail
