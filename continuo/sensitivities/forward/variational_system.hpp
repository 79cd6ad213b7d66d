// x' = f(t, x, p) with its sensitivities S = dx/dp and dx/dx0 as a System: S' = df/dx S + df/dp. The state is x, then
// the columns of S (E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", I.14).
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/sensitivities/derivatives/parameter_derivatives.hpp>
#include <continuo/system/autonomy.hpp>

namespace continuo {

/// x and `columns` columns of S; of these the first m are dx/dp, if there are more, the others are dx/dx0. Implicit
/// methods get the Jacobian: its diagonal blocks are df/dx, and the blocks dS'/dx come from central differences.
template <class F, State X, State P>
class VariationalSystem : public detail::AutonomyOf<F> {
 public:
  using Real = Scalar<X>;
  using Z = std::vector<Real>;

  /// The variational system of f at the parameters p; `sizes` as ParameterDerivatives has them.
  VariationalSystem(F f, const X& x0, P p, std::size_t columns, const std::vector<Real>& sizes,
                    const std::vector<Real>& sizes_of_p)
      : n_(dimension(x0)),
        columns_(columns),
        p_(std::move(p)),
        x_(x0),
        derivatives_(std::move(f), x0, p_, sizes, sizes_of_p),
        sizes_(sizes),
        by_x_(n_ * n_),
        by_p_(n_ * dimension(p_)) {
    if constexpr (KnowsAutonomous<F>) this->autonomous = is_autonomous(derivatives_.function());
  }

  /// z' at (t, z). One traced evaluation of f, or one of f with its derivatives.
  void operator()(const Real& t, const Z& z, Z& dzdt) {
    const std::size_t m = dimension(p_);
    go_to(t, z);
    dzdt.resize(z.size());
    for (std::size_t i = 0; i < n_; ++i) dzdt[i] = derivatives_.slope().data()[i];
    for (std::size_t k = 0; k < columns_; ++k) {
      const Real* const column = z.data() + n_ * (1 + k);
      for (std::size_t i = 0; i < n_; ++i) {
        Real sum = k < m ? by_p_[i * m + k] : Real(0);
        for (std::size_t j = 0; j < n_; ++j) sum += by_x_[i * n_ + j] * column[j];
        dzdt[n_ * (1 + k) + i] = sum;
      }
    }
  }

  /// f alone, at the x of z.
  void slope(const Real& t, const Z& z, X& dxdt) {
    take(z);
    derivatives_.derivative(t, x_, p_, dxdt);
  }

  [[nodiscard]] const SparsePattern& jacobian_pattern() {
    if (pattern_.size() == 0) make_pattern();
    return pattern_;
  }
  void jacobian_values(const Real& t, const Z& z, std::span<Real> values) {
    if (pattern_.size() == 0) make_pattern();
    go_to(t, z);
    for (std::size_t b = 0; b <= columns_; ++b)
      for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t j = 0; j < n_; ++j) values[diagonal_[(b * n_ + i) * n_ + j]] = by_x_[i * n_ + j];
    using std::abs, std::cbrt, std::max;
    Z moved = z, above(z.size()), below(z.size());
    for (std::size_t j = 0; j < n_; ++j) {
      const Real increment = cbrt(std::numeric_limits<Real>::epsilon()) * max(sizes_[j], Real(abs(z[j])));
      moved[j] = z[j] + increment;
      const Real high = moved[j];
      (*this)(t, moved, above);
      moved[j] = z[j] - increment;
      const Real apart = high - moved[j];
      (*this)(t, moved, below);
      moved[j] = z[j];
      for (std::size_t i = n_; i < z.size(); ++i) values[first_[(i - n_) * n_ + j]] = (above[i] - below[i]) / apart;
    }
  }

  /// "x[0]", "d x[0] / d p[1]", "d x[0] / d x[1](0)", with the names of f where it has them.
  [[nodiscard]] std::string component_name(std::size_t i) const {
    const std::string name = continuo::component_name(derivatives_.function(), i % n_);
    if (i < n_) return name;
    const std::size_t k = i / n_ - 1, m = dimension(p_);
    return "d " + name + " / d " +
           (k < m ? "p[" + std::to_string(k) + "]" : continuo::component_name(derivatives_.function(), k - m) + "(0)");
  }

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] const P& parameters() const { return p_; }
  [[nodiscard]] const DerivativeCosts& costs() const { return derivatives_.costs(); }
  /// The x of z, until the next call of any member.
  const X& take(const Z& z) {
    for (std::size_t i = 0; i < n_; ++i) x_.data()[i] = z[i];
    return x_;
  }

 private:
  void go_to(const Real& t, const Z& z) {
    derivatives_.go_to(t, take(z), p_);
    derivatives_.rows(by_x_, by_p_);
  }

  void make_pattern() {
    std::vector<MatrixPlace> places;
    const auto block = [&](std::size_t row, std::size_t column) {
      for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t j = 0; j < n_; ++j)
          places.push_back({static_cast<std::uint32_t>(row * n_ + i), static_cast<std::uint32_t>(column * n_ + j)});
    };
    for (std::size_t b = 0; b <= columns_; ++b) block(b, b);
    for (std::size_t b = 1; b <= columns_; ++b) block(b, 0);
    pattern_ = SparsePattern(n_ * (1 + columns_), places);
    const std::size_t diagonal = (1 + columns_) * n_ * n_;
    for (std::size_t k = 0; k < places.size(); ++k)
      (k < diagonal ? diagonal_ : first_).push_back(pattern_.find(places[k].row, places[k].column));
  }

  std::size_t n_, columns_;
  P p_;
  X x_;
  ParameterDerivatives<F, X, P> derivatives_;
  std::vector<Real> sizes_, by_x_, by_p_;
  SparsePattern pattern_;
  std::vector<std::size_t> diagonal_,
      first_;  // entries of the blocks on the diagonal, and of those in the first column
};

}  // namespace continuo
