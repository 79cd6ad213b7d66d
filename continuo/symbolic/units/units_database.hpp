// continuo/symbolic/units/units_database.hpp
// What one unit name is worth: from the short table here, else from UDUNITS-2. Internal to units.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/symbolic/units/units.hpp>

namespace continuo::model::detail {

/// The usual names with their exact definitions; no database is read.
[[nodiscard]] std::optional<Unit> usual_unit(std::string_view name);

/// What UDUNITS-2 knows under this name.
[[nodiscard]] Result<Unit> database_unit(const std::string& name);

/// The usual name nearest to this one, or nothing.
[[nodiscard]] std::string nearest_usual_name(std::string_view name);

}  // namespace continuo::model::detail
