// Columns of a family, `T[1]`, `T[2]`, ..., `u[1,1]'`, ..., found by their names: what belongs into one array.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// A single column has no axes. The columns of a family stand in the order of their indices, the last counting fastest.
struct ColumnFamily {
  /// An index of the family: its first value, and the number of values.
  struct Axis {
    long first = 0;
    std::size_t count = 0;
    friend bool operator==(const Axis&, const Axis&) = default;
  };
  std::string name, unit;  // "T", "u'"
  std::vector<Axis> axes;
  std::vector<std::size_t> places;  // in `columns`
};

/// In the order of their first columns. What is no whole rectangle of indices, or differs in its unit, stays apart.
[[nodiscard]] std::vector<ColumnFamily> families_of(std::span<const model::Column> columns);

}  // namespace continuo::results
