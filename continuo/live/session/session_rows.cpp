// continuo/live/session/session_rows.cpp
// The plotted rows: one for each picture, and more where a curve bends between two.
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/live/session.hpp>

namespace continuo::live {

void Session::append_values(double t, const std::vector<double>& x, double apart, std::vector<float>& row) {
  for (const model::TableInput& input : shown_->program->step_inputs)
    quantities_.set(input.variable, input.table.value(t));
  if (!values_.empty()) quantities_(t, x, values_);
  for (const std::size_t i : shown_->plotted) row.push_back(static_cast<float>(x[i]));
  for (const double value : values_) row.push_back(static_cast<float>(value));
  if (shown_->drift) {
    const double energy = values_[*shown_->energy - shown_->plotted.size()];
    row.push_back(static_cast<float>((energy - first_energy_) / std::abs(first_energy_)));
  }
  row.push_back(static_cast<float>(apart));
}

Row Session::row_at(double t, const std::vector<double>& x, const Instant* ghost) {
  use_variables(variables_);
  double apart = std::numeric_limits<double>::quiet_NaN();
  if (ghost) {
    double square = 0;
    for (const std::size_t i : shown_->apart) square += (x[i] - ghost->x[i]) * (x[i] - ghost->x[i]);
    apart = std::sqrt(square);
  }
  Row row{t, {}, {}, {}, {}};
  const bool trails = !shown_->paths.empty();
  append_values(t, x, apart, row.values);
  if (trails) append_points(paths_, t, x, row.path);
  if (ghost) {
    append_values(t, ghost->x, apart, row.ghost);
    if (trails) append_points(paths_, t, ghost->x, row.ghost_path);
  } else {
    constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
    row.ghost.assign(row.values.size(), nothing);
    row.ghost_path.assign(row.path.size(), nothing);
  }
  return row;
}

void Session::put(Row row) {
  const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  slice_->row_t.push_back(row.t);
  append(slice_->rows, row.values);
  append(slice_->ghost_rows, row.ghost);
  append(slice_->paths, row.path);
  append(slice_->ghost_paths, row.ghost_path);
  bends_.see(row);
  last_row_ = std::move(row);
  between_.clear();
  changed_ = true;
}

void Session::add_row(double t, const std::vector<double>& x, const Instant* ghost) {
  Row row = row_at(t, x, ghost);
  put_unless_straight(row);
  put(std::move(row));
}

/// The last row that was left out so far, if a line to the next would be seen to miss what is between. It would miss
/// most in the middle, or at a corner that has just been passed.
void Session::put_unless_straight(const Row& next) {
  if (between_.empty()) return;
  const bool bends = bends_.between(*last_row_, between_[between_.size() / 2], next) ||
                     bends_.between(*last_row_, between_.back(), next);
  if (!bends) return;
  Row last = std::move(between_.back());
  put(std::move(last));
}

/// A row that is put only where a line past it would be seen to miss it.
void Session::consider(double t) {
  if (!last_row_) return;
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(t, false);
  Row row = row_at(t, main_->instant_at(t, false).x, ghost ? &*ghost : nullptr);
  put_unless_straight(row);
  between_.push_back(std::move(row));
}

}  // namespace continuo::live
