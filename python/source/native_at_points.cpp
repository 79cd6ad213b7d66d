// A compiled right-hand side at many points, one after the other.
#include "native_at_points.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace py = pybind11;

namespace continuo::python {

NativeAtPoints::NativeAtPoints(Native native, std::size_t size, std::size_t parameters)
    : native_(std::move(native)),
      n_(size),
      k_(parameters),
      components_(size + parameters),
      slopes_(size + parameters),
      rows_((size + parameters) * (size + parameters)) {
  if (native_.size == 0 || native_.size == n_ + k_) return;
  const std::string given =
      k_ == 0 ? "`y` has " + std::to_string(n_) + " rows"
              : "`y` and `p`, which follow each other, have " + std::to_string(n_) + " and " + std::to_string(k_);
  throw py::value_error("the compiled `fun` is one of " + std::to_string(native_.size) + " components, but " + given);
}

void NativeAtPoints::gather(std::span<const double> y, std::size_t count, std::size_t point) {
  for (std::size_t i = 0; i < n_; ++i) components_[i] = y[i * count + point];
}

void NativeAtPoints::derivative(std::span<const double> x, std::span<const double> y, std::span<const double> p,
                                std::span<double> f) {
  std::ranges::copy(p, components_.begin() + static_cast<std::ptrdiff_t>(n_));
  for (std::size_t q = 0; q < x.size(); ++q) {
    gather(y, x.size(), q);
    if (native_.may_write_nothing) std::ranges::fill(slopes_, std::numeric_limits<double>::quiet_NaN());
    native_.derivative(x[q], components_.data(), slopes_.data(), native_.user);
    for (std::size_t i = 0; i < n_; ++i) f[i * x.size() + q] = slopes_[i];
    for (std::size_t l = n_; l < n_ + k_; ++l)
      if (slopes_[l] > 0 || slopes_[l] < 0)
        throw py::value_error("component " + std::to_string(l) + " of the compiled `fun` is p[" +
                              std::to_string(l - n_) + "], a constant; its derivative must be 0");
  }
}

void NativeAtPoints::jacobian(std::span<const double> x, std::span<const double> y, std::span<const double> p,
                              std::span<double> by_y, std::span<double> by_p) {
  std::ranges::copy(p, components_.begin() + static_cast<std::ptrdiff_t>(n_));
  for (std::size_t q = 0; q < x.size(); ++q) {
    gather(y, x.size(), q);
    std::ranges::fill(rows_, 0);
    native_.jacobian(x[q], components_.data(), rows_.data(), native_.user);
    for (std::size_t i = 0; i < n_; ++i) {
      const double* const row = rows_.data() + i * (n_ + k_);
      for (std::size_t j = 0; j < n_; ++j) by_y[(i * n_ + j) * x.size() + q] = row[j];
      for (std::size_t l = 0; l < k_; ++l) by_p[(i * k_ + l) * x.size() + q] = row[n_ + l];
    }
  }
}

}  // namespace continuo::python
