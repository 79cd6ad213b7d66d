// continuo/live/kept_step.hpp
// The step that an event ended, kept: after the event's actions the method's dense output is that of the step to come.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace continuo::live {

/// A step as a polynomial of degree 16 through its Chebyshev points: exactly that of every method in the catalogue,
/// whose dense outputs are polynomials of lower degrees.
class KeptStep {
 public:
  using X = std::vector<double>;
  static constexpr std::size_t degree = 16;

  void forget() { end_ = begin_; }
  double end() const { return end_; }
  bool covers(double t) const { return begin_ != end_ && (t - begin_) * (end_ - t) >= 0; }

  /// From `begin` to `end`, where it is x_end; `at(t, x)` gives the state between.
  template <class At>
  void keep(double begin, double end, const X& x_end, At&& at) {
    begin_ = begin;
    end_ = end;
    for (std::size_t k = 0; k < degree; ++k) at(begin + place(k) * (end - begin), points_[k]);
    points_[degree] = x_end;
  }

  /// The barycentric formula of the second kind (J.-P. Berrut, L. N. Trefethen, SIAM Review 46 (2004), eq. 5.4): the
  /// weights of Chebyshev points are 1 with alternating signs, half of that at both ends.
  void at(double t, X& x) const {
    const double part = (t - begin_) / (end_ - begin_);
    double whole = 0;
    x.assign(points_[0].size(), 0);
    for (std::size_t k = 0; k <= degree; ++k) {
      const double distance = part - place(k);
      if (distance == 0) {
        x = points_[k];
        return;
      }
      const double weight = (k % 2 == 0 ? 1.0 : -1.0) * (k == 0 || k == degree ? 0.5 : 1.0) / distance;
      whole += weight;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += weight * points_[k][i];
    }
    for (double& value : x) value /= whole;
  }

 private:
  /// Chebyshev's points of the second kind, from 0 to 1.
  static double place(std::size_t k) {
    const double half = std::sin(std::numbers::pi * static_cast<double>(k) / (2.0 * degree));
    return half * half;
  }

  double begin_ = 0, end_ = 0;
  std::array<X, degree + 1> points_;
};

}  // namespace continuo::live
