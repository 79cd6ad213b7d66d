// Brings the entries of df/dx to their rows, and those of df/dt to their components.
#include <algorithm>
#include <type_traits>
#include <utility>

#include <continuo/simulation/together/lane_derivatives.hpp>

namespace continuo::model {

LaneDerivatives::LaneDerivatives(std::shared_ptr<const DerivativeTapes> tapes, std::shared_ptr<NativeFunction> code,
                                 std::size_t mode)
    : tapes_(std::move(tapes)),
      moving_(tapes_->modes[mode].moving),
      entries_(tapes_->modes[mode].entries, std::move(code)),
      by_time_(tapes_->modes[mode].by_time, nullptr),
      values_(std::max(entries_.output_count(), by_time_.output_count())),
      wide_values_(values_.size()) {}

template <class Real>
std::vector<Real>& LaneDerivatives::values() {
  if constexpr (std::is_same_v<Real, double>) {
    return values_;
  } else {
    return wide_values_;
  }
}

template <class Real>
void LaneDerivatives::jacobian(const Real& t, std::span<const Real> x, std::span<Real> rows, std::span<const Real> p) {
  const SparsePattern& pattern = tapes_->pattern;
  const std::span<Real> entries = std::span(values<Real>()).first(entries_.output_count());
  entries_(t, x, entries, p);
  std::ranges::fill(rows, Real(0));
  for (std::size_t column = 0; column < pattern.size(); ++column)
    for (std::size_t k = pattern.begin(column); k < pattern.end(column); ++k)
      rows[pattern.row(k) * x.size() + column] = entries[k];
}

template <class Real>
void LaneDerivatives::time_derivative(const Real& t, std::span<const Real> x, std::span<Real> dfdt,
                                      std::span<const Real> p) {
  const std::span<Real> entries = std::span(values<Real>()).first(moving_.size());
  by_time_(t, x, entries, p);
  std::ranges::fill(dfdt, Real(0));
  for (std::size_t k = 0; k < moving_.size(); ++k) dfdt[moving_[k]] = entries[k];
}

template void LaneDerivatives::jacobian(const double&, std::span<const double>, std::span<double>,
                                        std::span<const double>);
template void LaneDerivatives::jacobian(const Wide&, std::span<const Wide>, std::span<Wide>, std::span<const Wide>);
template void LaneDerivatives::time_derivative(const double&, std::span<const double>, std::span<double>,
                                               std::span<const double>);
template void LaneDerivatives::time_derivative(const Wide&, std::span<const Wide>, std::span<Wide>,
                                               std::span<const Wide>);

}  // namespace continuo::model
