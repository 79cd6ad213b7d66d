// Computes the rows, and leaves out those that a straight line replaces.
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/live/session/rows.hpp>

namespace continuo::live {

void Rows::show(std::shared_ptr<const LiveModel> shown, const Variables& variables) {
  shown_ = std::move(shown);
  quantities_ = LiveEvaluation(*shown_, shown_->quantities, variables);
  paths_ = LiveEvaluation(*shown_, shown_->paths, variables);
  values_.assign(shown_->quantities.size(), 0.0);
  bends_ = Bends(*shown_);
  last_.reset();
  between_.clear();
}

void Rows::use(const Variables& variables) {
  quantities_.use(variables);
  paths_.use(variables);
}

void Rows::append_values(double t, const X& x, double apart, std::vector<float>& row) {
  quantities_.set_step_inputs(t);
  if (!values_.empty()) quantities_(t, x, values_);
  for (const std::size_t i : shown_->plotted) row.push_back(static_cast<float>(x[i]));
  for (const double value : values_) row.push_back(static_cast<float>(value));
  if (shown_->drift) {
    const double energy = values_[*shown_->energy - shown_->plotted.size()];
    row.push_back(static_cast<float>((energy - first_energy_) / std::abs(first_energy_)));
  }
  row.push_back(static_cast<float>(apart));
}

Row Rows::row_at(double t, const X& x, const X* ghost) {
  double apart = std::numeric_limits<double>::quiet_NaN();
  if (ghost) {
    double square = 0;
    for (const std::size_t i : shown_->apart) square += (x[i] - (*ghost)[i]) * (x[i] - (*ghost)[i]);
    apart = std::sqrt(square);
  }
  Row row{t, {}, {}, {}, {}};
  const bool trails = !shown_->paths.empty();
  append_values(t, x, apart, row.values);
  if (trails) paths_.append(t, x, row.path);
  if (ghost) {
    append_values(t, *ghost, apart, row.ghost);
    if (trails) paths_.append(t, *ghost, row.ghost_path);
  } else {
    constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
    row.ghost.assign(row.values.size(), nothing);
    row.ghost_path.assign(row.path.size(), nothing);
  }
  return row;
}

void Rows::add(double t, const X& x, const X* ghost) {
  Row row = row_at(t, x, ghost);
  put_unless_straight(row);
  put(std::move(row));
}

void Rows::consider(double t, const X& x, const X* ghost) {
  Row row = row_at(t, x, ghost);
  put_unless_straight(row);
  between_.push_back(std::move(row));
}

void Rows::put(Row row) {
  pending_.add(row);
  bends_.see(row);
  last_ = std::move(row);
  between_.clear();
}

/// The last row that was left out so far, if a line to the next would be seen to miss what is between. It would miss
/// most in the middle, or at a corner that has just been passed.
void Rows::put_unless_straight(const Row& next) {
  if (between_.empty()) return;
  const bool bends =
      bends_.between(*last_, between_[between_.size() / 2], next) || bends_.between(*last_, between_.back(), next);
  if (!bends) return;
  Row last = std::move(between_.back());
  put(std::move(last));
}

double Rows::finest_spacing(double length) const {
  constexpr double most_looks = 64;  // for a picture
  return bends_.too_wide() ? std::numeric_limits<double>::infinity() : length / most_looks;
}

void Rows::rewind_to(double t) {
  pending_.rewind_to(t, shown_->columns.size(), shown_->paths.size());
  last_.reset();
  between_.clear();
}

void Rows::measure_drift_from(double t, const X& x) {
  first_energy_ = 0;
  if (!shown_->energy) return;
  quantities_(t, x, values_);
  first_energy_ = values_[*shown_->energy - shown_->plotted.size()];
}

}  // namespace continuo::live
