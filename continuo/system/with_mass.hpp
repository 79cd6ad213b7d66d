// M(t, x) x' = f(t, x), with a mass matrix that depends on the time and on the state:
//
//   auto system = with_mass(f, [](double t, const X& x, std::span<double> rows) { ... });  // n*n numbers, row by row
//   auto system = with_mass(f, mass, {2});          // row and column 2 of M are zero: f[2] = 0 determines x[2]
//
// It is x' = M^-1 f for all methods, and of components without mass 0 = f, for the implicit ones. A constant M is a
// member of the system, mass_matrix(rows) or mass(i) (system.hpp).
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/system/check_system.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {

/// f and the names of its components, where it knows them.
template <class F>
struct WithNamesOf {
  F f;
};
template <Named F>
struct WithNamesOf<F> {
  F f;
  [[nodiscard]] std::string component_name(std::size_t i) const { return std::string(f.component_name(i)); }
};

/// A member of f that would be ignored, as it is not that of M^-1 f.
template <class F>
concept SaysMoreThanMassAllows =
    MentionsPairCount<F> || MentionsPair<F> || MentionsIgnoresVelocity<F> || MentionsJacobianPattern<F> ||
    MentionsJacobianValues<F> || MentionsJacobianBand<F> || MentionsJacobianAction<F> || MentionsTimeDerivative<F> ||
    MentionsSetUpPreconditioner<F> || MentionsPrecondition<F> || MentionsAutonomous<F> || MentionsSpectralRadius<F> ||
    MentionsMassMatrix<F> || MentionsMass<F> || MentionsHasMass<F> || MentionsStiff<F> || MentionsNonstiff<F> ||
    MentionsStiffJacobian<F>;

template <class M, class X>
concept WritesMass = requires(M& mass, const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) { mass(t, x, rows); };

/// M at one (t, x), decomposed; 1 stands on the diagonal of components without mass.
template <class Real, std::size_t N>
class MassFactors {
 public:
  explicit MassFactors(std::size_t size) : lu_(size) {}
  [[nodiscard]] std::size_t size() const { return lu_.size(); }

  /// Why M cannot be decomposed; null where it can.
  template <class M, State X>
  [[nodiscard]] const char* factor(M& mass, const Real& t, const X& x, std::span<const std::size_t> algebraic) {
    const std::size_t n = size();
    auto& rows = lu_.matrix();
    std::fill_n(rows.data(), n * n, Real(0));
    mass(t, x, std::span<Real>(rows.data(), n * n));
    for (std::size_t i = 0; i < n * n; ++i)
      if (!is_finite(rows[i])) return "the mass matrix is not finite";
    for (const std::size_t i : algebraic) {
      for (std::size_t j = 0; j < n; ++j)
        if (rows[i * n + j] != Real(0) || rows[j * n + i] != Real(0))
          return "the mass matrix has an entry in the row or the column of a component that is named as algebraic";
    }
    for (const std::size_t i : algebraic) rows[i * n + i] = Real(1);
    if (lu_.factor()) return nullptr;
    return "the mass matrix is singular: name the components whose rows and columns are zero, as in with_mass(f, mass, "
           "{2}); one that is singular in another way is not supported";
  }
  void solve(Real* b) { lu_.solve(b); }

 private:
  DenseLU<Real, N> lu_;
};

template <State X>
[[nodiscard]] consteval std::size_t size_of_type() {
  if constexpr (FixedSize<X>) {
    return std::tuple_size<X>::value;
  } else {
    return run_time_size;
  }
}

/// The right-hand side M^-1 f. Real is the scalar of states of run-time size, whose matrix is kept from call to call.
template <class F, class M, class Real>
class DividedByMass : public WithNamesOf<F> {
 public:
  DividedByMass(F function, M matrix, std::vector<std::size_t> algebraic)
      : WithNamesOf<F>{std::move(function)}, mass_(std::move(matrix)), algebraic_(std::move(algebraic)) {}

  /// Refuses, by a sentence, a mass that is not one for states X; true where it is.
  template <State X>
  [[nodiscard]] static consteval bool check_for_states() {
    constexpr bool writes_mass = WritesMass<M, X>;
    static_assert(writes_mass,
                  "the mass can not be called as mass(t, x, rows), with t a number, x of the type of x0, and the n*n "
                  "numbers row by row: void mass(Real t, const X& x, std::span<Real> rows)");
    return writes_mass;
  }

  /// x' of the components with mass, f of those without. Not a number where M(t, x) cannot be decomposed. Costs a
  /// decomposition, n^3 / 3 operations.
  template <State X>
    requires RightHandSide<F, X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) {
    evaluate(this->f, t, x, dxdt);
    with_factors(t, x, [&](auto* factors) {
      if (factors) return factors->solve(dxdt.data());
      for (std::size_t i = 0; i < dimension(x); ++i) dxdt.data()[i] = std::numeric_limits<Scalar<X>>::quiet_NaN();
    });
  }

  /// Whether a component has no mass.
  [[nodiscard]] bool has_mass() const { return !algebraic_.empty(); }
  /// 0 of a component without mass, otherwise 1: x' is solved for.
  [[nodiscard]] Real mass(std::size_t i) const {
    return std::ranges::find(algebraic_, i) == algebraic_.end() ? Real(1) : Real(0);
  }
  /// Why a run cannot begin with M(t, x); empty where it can.
  template <State X>
    requires WritesMass<M, X>
  [[nodiscard]] std::string start_problem(const Scalar<X>& t, const X& x) const {
    for (const std::size_t i : algebraic_)
      if (i >= dimension(x))
        return "component " + std::to_string(i) + " is named as algebraic and is not in the state, which has " +
               std::to_string(dimension(x)) + " components";
    M copy = mass_;  // of a function that may change when it is called
    MassFactors<Scalar<X>, run_time_size> factors(dimension(x));
    const char* const why = factors.factor(copy, t, x, algebraic_);
    return why ? why : "";
  }

 protected:
  /// Calls act with M decomposed at (t, x), or with null.
  template <State X, class Act>
  void with_factors(const Scalar<X>& t, const X& x, Act&& act) {
    if constexpr (FixedSize<X>) {
      MassFactors<Scalar<X>, size_of_type<X>()> factors(dimension(x));
      act(factors.factor(mass_, t, x, algebraic_) ? nullptr : &factors);
    } else {
      static_assert(std::same_as<Scalar<X>, Real>,
                    "the scalar of the state is another one: name it, as in with_mass<float>(f, mass)");
      if (factors_.size() != dimension(x)) factors_ = MassFactors<Real, run_time_size>(dimension(x));
      act(factors_.factor(mass_, t, x, algebraic_) ? nullptr : &factors_);
    }
  }

  M mass_;
  std::vector<std::size_t> algebraic_;

 private:
  MassFactors<Real, run_time_size> factors_{0};
};

/// The same with its Jacobian, of an f that gives one.
template <class F, class M, class Real>
class DividedByMassWithJacobian : public DividedByMass<F, M, Real> {
 public:
  using DividedByMass<F, M, Real>::DividedByMass;

  /// From M z = f follows M dz/dx = df/dx - (dM/dx) z. The derivatives of M are forward differences: n evaluations of
  /// M, and none of f but one.
  template <State X>
    requires HasJacobian<F, X>
  void jacobian(const Scalar<X>& t, const X& x, std::span<Scalar<X>> rows) {
    const std::size_t n = dimension(x);
    X z = x;
    (*this)(t, x, z);
    for (const std::size_t i : this->algebraic_) z.data()[i] = Scalar<X>(0);  // without mass
    this->f.jacobian(t, x, rows);
    subtract_change_of_mass(t, x, z, rows);
    std::vector<Scalar<X>> column(n);
    this->with_factors(t, x, [&](auto* factors) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < n; ++i) column[i] = rows[i * n + j];
        if (factors) factors->solve(column.data());
        for (std::size_t i = 0; i < n; ++i)
          rows[i * n + j] = factors ? column[i] : std::numeric_limits<Scalar<X>>::quiet_NaN();
      }
    });
  }

 private:
  template <State X>
  void subtract_change_of_mass(const Scalar<X>& t, const X& x, const X& z, std::span<Scalar<X>> rows) {
    using std::abs, std::max, std::sqrt;
    using R = Scalar<X>;
    const std::size_t n = dimension(x);
    std::vector<R> here(n * n, R(0)), moved_rows(n * n);
    this->mass_(t, x, std::span<R>(here));
    X moved = x;
    for (std::size_t k = 0; k < n; ++k) {
      // The increment of Hairer & Wanner's RADAU5, which knows no scale of a component that is 0.
      const R wanted = sqrt(std::numeric_limits<R>::epsilon() * max(R(1e-5), R(abs(x.data()[k]))));
      moved.data()[k] = x.data()[k] + wanted;
      const R increment = moved.data()[k] - x.data()[k];
      std::ranges::fill(moved_rows, R(0));
      this->mass_(t, moved, std::span<R>(moved_rows));
      moved.data()[k] = x.data()[k];
      for (std::size_t i = 0; i < n; ++i) {
        R sum(0);
        for (std::size_t j = 0; j < n; ++j) sum += (moved_rows[i * n + j] - here[i * n + j]) * z.data()[j];
        rows[i * n + k] -= sum / increment;
      }
    }
  }
};

template <class F, class M, class Real>
using DividedByMassOf =
    std::conditional_t<MentionsJacobian<F>, DividedByMassWithJacobian<F, M, Real>, DividedByMass<F, M, Real>>;

}  // namespace detail

/// The system M(t, x) x' = f(t, x): mass(t, x, rows) writes the n*n numbers of M row by row, which begin as zeros. M is
/// regular, except that the rows and columns of the components listed in `algebraic` are zero, always: their rows read
/// 0 = f, which must determine them (index 1). Of f the members `jacobian` and `component_name` are used; another one
/// is refused. An evaluation costs the decomposition of a dense matrix. Real is the scalar of states of run-time size;
/// states of fixed size may have any. Where M(t, x) is singular on the way the derivative is not a number, and a run
/// ends there.
template <class Real = double, class F, class M>
[[nodiscard]] auto with_mass(F&& f, M&& mass, std::vector<std::size_t> algebraic = {}) {
  using Function = std::decay_t<F>;
  constexpr bool says_more = detail::SaysMoreThanMassAllows<Function>;
  static_assert(
      !says_more,
      "f has a member that is not that of M^-1 f and would be ignored: with_mass uses f itself, its `jacobian` "
      "and its `component_name`");
  return detail::DividedByMassOf<Function, std::decay_t<M>, Real>(std::forward<F>(f), std::forward<M>(mass),
                                                                  std::move(algebraic));
}

}  // namespace continuo
