// The method of Taylor series: the solution from t on is x(t + s) = c_0 + c_1 s + ... + c_p s^p, with coefficients by
// recurrences of the operations that f is made of (series_program.hpp). The order p follows from the tolerance and the
// step from the last two coefficients: A. Jorba, M. Zou, "A software package for the numerical integration of ODEs by
// means of high-order Taylor methods", Experimental Mathematics 14 (2005),
//
//   p = ceil(2 - ln(tolerance)/2),   h = exp(-0.7/(p - 1)) min over j = p - 1, p of (e^(2 (p - 2 - j)) / |c_j|)^(1/j),
//
// |c_j| in tolerances: their steps, and one order more. A series of radius of convergence r has c_j ~ r^-j; then h is
// r/e^2, and what is cut off is the tolerance times e^-6. With their order, errors after a long run are ten times those
// of other methods at the same tolerance. In small systems the series costs less than the step around it: three orders
// more give longer steps, by a third at 1e-10. The coefficients at the end of a step, which the next one begins with,
// are computed at once: they give the size of the next step, and c_1 there is f, by which the defect of the polynomial
// at its end is known. Where f may have jumps or corners, or depends on time, the defect is measured within the step as
// well.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>  // the greater one
#include <continuo/methods/taylor_series/coarse_power.hpp>
#include <continuo/methods/taylor_series/series_number.hpp>
#include <continuo/methods/taylor_series/series_steps.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/rebound_state.hpp>

namespace continuo {

/// The system gives the series of its solution itself: of n components, c[k n + i] becomes the coefficient of s^k of
/// component i of x(t + scale s), those of s^0 being there. Returns why it has none, a sentence; empty where it has.
template <class F, class X>
concept HasTaylorCoefficients = requires(F& f, const Scalar<X>& t, const Scalar<X>& scale, std::span<Scalar<X>> c) {
  { f.taylor_coefficients(t, scale, c) } -> std::convertible_to<std::string_view>;
};
/// The system says whether it has jumps or corners between the events of a run.
template <class F>
concept KnowsItsCorners = requires(const F& f) {
  { f.has_corners() } -> std::convertible_to<bool>;
};

namespace detail {

/// Whether f can be called with numbers that write down how they were computed.
template <class F, class X>
[[nodiscard]] consteval bool takes_series() {
  if constexpr (HasTaylorCoefficients<F, X>) {
    return true;
  } else {
    using Series = SeriesNumber<Scalar<X>>;
    return RightHandSide<F, ReboundState<X, Series>>;
  }
}

}  // namespace detail

/// For smooth problems that are not stiff, and strict tolerances. For models, and for systems in C++ that take any
/// number type: [](auto t, const auto& x, auto& dxdt) { ... }. Steps of a fixed size have order 8.
struct TaylorSeries {
  static constexpr std::string_view name = "taylor";
  static constexpr int order = 20, error_order = 19, starting_order = 8, dense_degree = 20, dense_order = 20;
  static constexpr int order_of_fixed_steps = 8;
  static constexpr bool second_order = false;
  /// Of the next step, `next_factor` knows all there is to know: no controller has to follow the errors.
  static constexpr bool sizes_its_steps = true;
  /// No coefficients can be had of every system.
  static constexpr bool needs_series = true;
  /// Components of a vector of 256 bits.
  static constexpr std::size_t widest = 4;

  /// The series at one instant, in units of a time `scale`: the coefficients of s^0, then those of s^1, ...
  template <State X>
  struct Expansion {
    std::vector<Scalar<X>> c;  // and some zeros, for vectors that begin in the last row
    Scalar<X> scale{};
    bool is_known = false;

    explicit Expansion(const X& x) : c((dense_degree + 1) * dimension(x) + widest - 1) {}
    template <class Archive>
    void transfer(Archive& archive) {
      archive(c, scale, is_known);
    }
  };

  /// What a step and the next one are judged by, as mean squares in units of a tolerance.
  template <class Real>
  struct Measure {
    Real error{};                      // of the greatest of the defect and what `allowance` says of the last two terms
    std::array<Real, 2> next_terms{};  // the last two coefficients at the end of the step
  };

  template <State X>
  struct Workspace {
    using Real = Scalar<X>;
    std::array<Expansion<X>, 2> expansions;  // at the start of the step and at its end, in turn
    bool begins_with_second = false;
    X rest, next_rest;       // what rounding has taken from x, and will have taken from x_new
    X defect, point, slope;  // f less the slope of the polynomial, times h/(p + 1); scratch
    X polynomial_slope;      // where the polynomial was evaluated last, by `scale`
    Measure<Real> measure;   // of the step by `tolerance`
    bool is_measured = false;
    Tolerance<Real> tolerance{Real(1e-6), Real(1e-9)};
    std::size_t order = 0;        // p; 0: not chosen
    bool is_retaken = false;      // the step begins where the last try did
    bool is_controlled = false;   // somebody asked for the size of the next step
    bool is_fixed = false;        // nobody has
    std::string_view failure{};   // why there is no series
    SeriesProgram<Real> program;  // of f where it is recorded
    using Number = SeriesNumber<Real>;
    ReboundState<X, Number> recorded_x, recorded_f;
    std::vector<std::uint32_t> derivatives;  // their registers

    explicit Workspace(const X& x)
        : expansions{Expansion<X>(x), Expansion<X>(x)},
          rest(x),
          next_rest(x),
          defect(x),
          point(x),
          slope(x),
          polynomial_slope(x),
          derivatives(dimension(x)) {
      if constexpr (requires { recorded_x.resize(dimension(x)); }) {
        recorded_x.resize(dimension(x));
        recorded_f.resize(dimension(x));
      }
    }

    [[nodiscard]] Expansion<X>& now() { return expansions[begins_with_second ? 1 : 0]; }
    [[nodiscard]] const Expansion<X>& now() const { return expansions[begins_with_second ? 1 : 0]; }
    [[nodiscard]] Expansion<X>& next() { return expansions[begins_with_second ? 0 : 1]; }
    [[nodiscard]] const Expansion<X>& next() const { return expansions[begins_with_second ? 0 : 1]; }

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(now(), next(), rest, next_rest);
      archive.index(order, dense_degree);
      archive(is_controlled, is_fixed);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return Workspace<X>(x);
  }

  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System&, const X&) {
    if constexpr (detail::takes_series<System, X>()) return {};
    return "needs a system that takes any number type, [](auto t, const auto& x, auto& dxdt) { ... }, or has the "
           "member "
           "taylor_coefficients: take dop853";
  }

  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    work.tolerance = tolerance;
  }

  template <State X>
  [[nodiscard]] static int error_order_of(const Workspace<X>& work) {
    return static_cast<int>(std::max<std::size_t>(work.order, 3)) - 1;
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    int evaluations = 0;
    const bool is_retaken = std::exchange(work.is_retaken, false);
    work.is_measured = false;
    if (discontinuity && !is_retaken) {
      work.now().is_known = work.is_fixed = work.is_controlled = false;
      std::fill_n(work.rest.data(), dimension(x), Real(0));
    }
    work.next().is_known = false;
    if (!work.now().is_known) {
      work.order = order_of_step(work);
      evaluations += expand(system, t, x, h, work, work.now());
      if (work.failure.empty() && !has_series(work)) {
        work.failure =
            "the solution has no Taylor series at this time, as where a root or a power with a fraction begins at 0: "
            "take dop853";
      }
    }
    if (!work.failure.empty()) return evaluations;
    advance(x, h, work, x_new);
    if (is_retaken) return evaluations;
    if (!detail::is_finite_state(x_new)) {
      std::fill_n(work.defect.data(), dimension(x), Real(0));
      return evaluations;
    }
    evaluations += expand(system, Real(t + h), x_new, h, work, work.next());
    if (!work.failure.empty()) return evaluations;
    work.measure = measure_of<true>(work, h, x, x_new, work.tolerance);
    work.is_measured = true;
    if (may_have_corners<X>(system)) {
      for (const double theta : within) {
        at(Real(theta), h, work, work.point);
        evaluate(system, Real(t + Real(theta) * h), work.point, work.slope);
        note_defect(h, work, work.slope);
        ++evaluations;
      }
      work.measure = measure_of<false>(work, h, x, x_new, work.tolerance);
    }
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(error_square(work, h, x, x_new, tolerance));
  }
  /// Its square; not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    if (work.is_measured && is_same(tolerance, work.tolerance)) return work.measure.error;
    return measure_of<false>(work, h, x, x_new, tolerance).error;
  }
  /// The greatest of the defect, and of the last two terms times what `allowance` says.
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>& h, std::size_t i) {
    const std::size_t n = dimension(work.rest);
    const Scalar<X>* const before = work.now().c.data() + (work.order - 1) * n + i;
    return error_of(before[0], before[n], work.defect.data()[i], last_factors(work, h));
  }

  /// The next step by the coefficients it begins with.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>& factor, const Scalar<X>& h,
                                             const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    using std::abs, std::min;
    work.is_controlled = true;
    const Expansion<X>& next = work.next();
    if (!next.is_known) return factor;
    const bool is_measured = work.is_measured && is_same(tolerance, work.tolerance);
    std::array<Real, 2> squares =
        is_measured ? work.measure.next_terms : measure_of<false>(work, h, x, x_new, tolerance).next_terms;
    const std::size_t p = work.order;
    for (std::size_t j = 0; j < 2; ++j) {
      const Real allowed = allowance<Real>(p, p - 1 + j);
      squares[j] *= allowed * allowed;
    }
    if (!detail::is_finite(Real(squares[0] + squares[1]))) return factor;
    return min(Real(greatest_factor), Real(abs(next.scale / h) * least_inverse_root(squares, 2 * (p - 1)))) *
           safety<Real>(p);
  }

  /// Many steps after the last one that was accepted, by the system: see SeriesSteps. `own` is detail::OwnSteps.
  template <class System, class Own, State X>
    requires TakesSeriesSteps<System, X>
  static std::size_t take_steps(System& system, const Own& own, Workspace<X>& work) {
    using Real = Scalar<X>;
    Expansion<X>&now = work.next(), &next = work.now();  // of the step to come
    if (!now.is_known || !work.is_controlled || !work.failure.empty() || may_have_corners<X>(system)) return 0;
    const std::size_t p = work.order;
    SeriesSteps<Real> steps{.x = own.x.data(),
                            .rest = work.next_rest.data(),
                            .now = now.c.data(),
                            .next = next.c.data(),
                            .t = own.t,
                            .scale = now.scale,
                            .size = own.next,
                            .carried = own.carried,
                            .limit = own.limit,
                            .longest = own.longest,
                            .until = own.until,
                            .forward = own.forward,
                            .components = dimension(own.x),
                            .order = p,
                            .most = own.most,
                            .tolerance = own.tolerance,
                            .terms = {allowance<Real>(p, p - 1), allowance<Real>(p, p)},
                            .greatest_factor = Real(greatest_factor),
                            .safety = safety<Real>(p),
                            .times = own.times,
                            .has_guards = own.has_guards};
    const std::size_t made = system.take_series_steps(steps);
    if (made == 0) return 0;
    if (made % 2 == 1) std::swap(now.c, next.c);
    now.scale = steps.scale;
    own.t = steps.t, own.next = steps.size, own.carried = steps.carried;
    return made;
  }
  /// What a step costs that begins with its series.
  template <State X>
  [[nodiscard]] static std::size_t evaluations_of_step(const Workspace<X>& work) {
    return work.order;
  }

  /// x at this part of the last step, by its series: what `interpolate` gives would have to be made first, and its
  /// terms wait for one another.
  template <State X>
  static void at_part(const Workspace<X>& work, const Scalar<X>& h, const Scalar<X>& theta, X& x) {
    for_sums(work, Scalar<X>(theta * h / work.now().scale),
             [&](std::size_t i, const Scalar<X>& sum, const Scalar<X>&) { x.data()[i] = work.now().c[i] + sum; });
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X&, const Scalar<X>& h, const X& x_new, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const Real theta = h / work.now().scale;
    const std::size_t n = dimension(x_new);
    Real factor(1);
    std::size_t k = 0;
    for (; k <= work.order; ++k, factor *= theta)
      scale_row(work.now().c.data() + k * n, factor, n, interpolant.c[k].data());
    for (; k < interpolant.c.size(); ++k) std::fill_n(interpolant.c[k].data(), n, Real(0));
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    if (!std::exchange(work.is_controlled, false)) {
      work.is_fixed = true;
      work.next().is_known = work.next().is_known && work.order == order_of_step(work);
    }
    work.begins_with_second = !work.begins_with_second;
    std::swap(work.rest, work.next_rest);
    work.next().is_known = false;
  }
  /// The next step begins elsewhere.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.now().is_known = false;
    std::fill_n(work.rest.data(), dimension(work.rest), Scalar<X>(0));
  }
  template <State X>
  static void retaken(Workspace<X>& work) {
    work.is_retaken = work.now().is_known;
  }
  template <State X>
  [[nodiscard]] static StepStatus status(const Workspace<X>& work) {
    return work.failure.empty() ? StepStatus::done : StepStatus::newton_diverged;
  }
  template <State X>
  [[nodiscard]] static std::string_view failure(const Workspace<X>& work) {
    return work.failure;
  }
  template <State X>
  [[nodiscard]] static X derivative(const Workspace<X>& work) {
    X slope = work.rest;
    for (std::size_t i = 0; i < dimension(slope); ++i)
      slope.data()[i] = first_coefficients<X>(work.now())[i] / work.now().scale;
    return slope;
  }

 private:
  static constexpr std::size_t least_order = 4;
  static constexpr std::size_t small_dimension = 8, more_of_small = 3;
  static constexpr double greatest_factor = 10;          // of one step to the next
  static constexpr std::array within{0.27, 0.52, 0.77};  // where defects are measured in a step

  template <class Real>
  [[nodiscard]] static Real number(std::size_t k) {
    return Real(static_cast<double>(k));
  }
  template <class Real>
  [[nodiscard]] static Real power(Real x, std::size_t n) {
    Real result(1);
    for (; n > 0; n /= 2, x *= x)
      if (n % 2 == 1) result *= x;
    return result;
  }
  /// The lesser of x_0^(-1/n) and x_1^(-1/(n + 2)); very long where x is 0.
  template <class Real>
  [[nodiscard]] static Real least_inverse_root(const std::array<Real, 2>& x, std::size_t n) {
    using std::max, std::min, std::pow;
    const std::array<Real, 2> inverse{Real(1) / number<Real>(n), Real(1) / number<Real>(n + 2)};
    if constexpr (std::is_same_v<Real, double>) {
      const double log = max(inverse[0] * detail::coarse_log2(x[0]), inverse[1] * detail::coarse_log2(x[1]));
      return detail::coarse_exp2(-log);
    } else {
      Real least = std::numeric_limits<Real>::max();
      for (std::size_t j = 0; j < 2; ++j)
        if (x[j] > Real(0)) least = min(least, Real(pow(x[j], -inverse[j])));
      return least;
    }
  }
  /// e^(-0.7/(p - 1))
  template <class Real>
  [[nodiscard]] static Real safety(std::size_t p) {
    using std::exp;
    static const auto all = [] {
      std::array<Real, dense_degree + 1> result{};
      for (std::size_t k = 2; k < result.size(); ++k) result[k] = exp(Real(-0.7) / number<Real>(k - 1));
      return result;
    }();
    return all[p];
  }
  /// c_1
  template <State X>
  [[nodiscard]] static const Scalar<X>* first_coefficients(const Expansion<X>& expansion) {
    return expansion.c.data() + expansion.c.size() / (dense_degree + 1);
  }
  /// A loop of a few components takes less time than what decides how to make it one of vectors.
  template <class Real>
  static void scale_row(const Real* row, const Real& factor, std::size_t n, Real* to) {
    const auto first = [&]<std::size_t count>() {
      for (std::size_t i = 0; i < count; ++i) to[i] = factor * row[i];
    };
    switch (n) {
      case 1:
        return first.template operator()<1>();
      case 2:
        return first.template operator()<2>();
      case 3:
        return first.template operator()<3>();
      case 4:
        return first.template operator()<4>();
      default:
        for (std::size_t i = 0; i < n; ++i) to[i] = factor * row[i];
    }
  }
  /// What coefficients p - 1 and p are multiplied by, for their terms in units of a tolerance.
  template <State X>
  [[nodiscard]] static std::array<Scalar<X>, 2> last_factors(const Workspace<X>& work, const Scalar<X>& h) {
    using std::abs;
    using Real = Scalar<X>;
    const Real theta = abs(h / work.now().scale), before = power(theta, work.order - 1);
    return {before * allowance<Real>(work.order, work.order - 1),
            before * theta * allowance<Real>(work.order, work.order)};
  }
  template <class Real>
  [[nodiscard]] static Real error_of(const Real& before, const Real& last, const Real& defect,
                                     const std::array<Real, 2>& factors) {
    using std::abs;
    return detail::greater(detail::greater(Real(abs(before) * factors[0]), Real(abs(last) * factors[1])), defect);
  }

  template <class Real>
  [[nodiscard]] static bool is_same(const Tolerance<Real>& a, const Tolerance<Real>& b) {
    return a.rtol == b.rtol && a.atol == b.atol && a.rtol_each == b.rtol_each && a.atol_each == b.atol_each;
  }

  /// What the parts of a measure are multiplied by.
  template <class Real>
  struct MeasureFactors {
    std::array<Real, 2> terms;
    Real defect, of_polynomial, of_slope;  // the difference of the slopes, and these, which are in units of a time
  };
  template <State X>
  [[nodiscard]] static MeasureFactors<Scalar<X>> measure_factors(const Workspace<X>& work, const Scalar<X>& h) {
    using Real = Scalar<X>;
    return {.terms = last_factors(work, h),
            .defect = Real(h / number<Real>(work.order + 1)),
            .of_polynomial = Real(Real(1) / work.now().scale),
            .of_slope = Real(Real(1) / work.next().scale)};
  }

  /// Of one component, or of `widest` side by side in a register.
  template <class Number>
  struct MeasureSums {
    Number error{}, before{}, last{};  // of squares
  };
  /// The absolute value, by a conditional expression that registers have too.
  template <class Number>
  [[gnu::always_inline]] static inline void make_positive(Number& v) {
    v = v < Number{} ? Number(-v) : v;
  }

  /// With the defect as it was noted, or noting that at the end of the step.
  template <bool notes_defect, class Work, State X>
  [[nodiscard]] static Measure<Scalar<X>> measure_of(Work& work, const Scalar<X>& h, const X& x, const X& x_new,
                                                     const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    if constexpr (std::is_same_v<Real, double>) {
#if defined(__x86_64__)
      static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
      if (is_wide) return measure_in_wide_registers<notes_defect>(work, h, x, x_new, tolerance);
#endif
      return measure_in_registers<notes_defect>(work, h, x, x_new, tolerance);
    } else {
      MeasureSums<Real> sums;
      const MeasureFactors<Real> factors = measure_factors(work, h);
      for (std::size_t i = 0; i < dimension(x); ++i)
        measure_piece<notes_defect, 1>(work, factors, x, x_new, tolerance, i, sums);
      const Real part = Real(1) / number<Real>(dimension(x));
      return {.error = sums.error * part, .next_terms = {Real(sums.before * part), Real(sums.last * part)}};
    }
  }
  using Register [[gnu::vector_size(32)]] = double;
#if defined(__x86_64__)
  template <bool notes_defect, class Work, State X>
  [[gnu::target("avx2")]] static Measure<double> measure_in_wide_registers(Work& work, const double& h, const X& x,
                                                                           const X& x_new,
                                                                           const Tolerance<double>& tolerance) {
    return measure_in_registers<notes_defect>(work, h, x, x_new, tolerance);
  }
#endif
  template <bool notes_defect, class Work, State X>
  [[gnu::always_inline]] static inline Measure<double> measure_in_registers(Work& work, const double& h, const X& x,
                                                                            const X& x_new,
                                                                            const Tolerance<double>& tolerance) {
    MeasureSums<Register> sums;
    const MeasureFactors<double> factors = measure_factors(work, h);
    const auto add = [&]<std::size_t count>(std::size_t begin) __attribute__((always_inline)) {
      measure_piece<notes_defect, count>(work, factors, x, x_new, tolerance, begin, sums);
    };
    const std::size_t n = dimension(x);
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) add.template operator()<4>(i);
    if (n - i == 3) add.template operator()<3>(i);
    if (n - i == 2) add.template operator()<2>(i);
    if (n - i == 1) add.template operator()<1>(i);
    const double part = 1 / number<double>(n);
    const auto mean = [&](const Register& sum) { return ((sum[0] + sum[1]) + (sum[2] + sum[3])) * part; };
    return {.error = mean(sums.error), .next_terms = {mean(sums.before), mean(sums.last)}};
  }
  /// The numbers that lie there; `other` in the places of a register that no component has.
  template <std::size_t count, class Number, class Real>
  [[gnu::always_inline]] static inline void read(Number& to, const Real* v, [[maybe_unused]] const Real& other) {
    if constexpr (std::is_same_v<Number, Real>) {
      to = *v;
    } else {
      to = Number{v[0], count > 1 ? v[1] : other, count > 2 ? v[2] : other, count > 3 ? v[3] : other};
    }
  }
  template <std::size_t count, class Number, class Real>
  [[gnu::always_inline]] static inline void write(Real* to, const Number& v) {
    if constexpr (std::is_same_v<Number, Real>) {
      *to = v;
    } else {
      for (std::size_t k = 0; k < count; ++k) to[k] = v[k];
    }
  }
  /// Places of a register that no component has are such that they add 0.
  template <bool notes_defect, std::size_t count, class Work, class Number, State X>
  [[gnu::always_inline]] static inline void measure_piece(Work& work, const MeasureFactors<Scalar<X>>& factors,
                                                          const X& x, const X& x_new,
                                                          const Tolerance<Scalar<X>>& tolerance, std::size_t begin,
                                                          MeasureSums<Number>& sums) {
    using Real = Scalar<X>;
    const std::size_t n = dimension(work.rest), row = (work.order - 1) * n;
    const Real none(0), one(1), *const now = work.now().c.data() + row, *const next = work.next().c.data() + row;
    Number before{}, last{}, next_before{}, next_last{}, from{}, to{}, defect{}, slope{};
    read<count>(before, now + begin, none), read<count>(last, now + n + begin, none);
    read<count>(next_before, next + begin, none), read<count>(next_last, next + n + begin, none);
    read<count>(from, x.data() + begin, one), read<count>(to, x_new.data() + begin, one);
    if constexpr (notes_defect) {
      read<count>(slope, work.polynomial_slope.data() + begin, none);
      read<count>(defect, work.next().c.data() + n + begin, none);
      defect = factors.defect * (defect * factors.of_slope - slope * factors.of_polynomial);
      make_positive(defect);
      write<count>(work.defect.data() + begin, defect);
    } else {
      read<count>(defect, work.defect.data() + begin, none);
    }
    Number relative = Number{} + tolerance.rtol, absolute = Number{} + tolerance.atol;
    if (tolerance.rtol_each) read<count>(relative, tolerance.rtol_each + begin, one);
    if (tolerance.atol_each) read<count>(absolute, tolerance.atol_each + begin, one);
    const Number zero_if_finite = (to - to) + (defect - defect);
    make_positive(before), make_positive(last), make_positive(from), make_positive(to);
    before *= factors.terms[0], last *= factors.terms[1];
    const Number size = from > to ? from : to, term = before > last ? before : last;
    const Number error = (term > defect ? term : defect) / (absolute + relative * size);
    sums.error += error * error + zero_if_finite;
    const Number weight = Real(1) / (absolute + relative * to);
    next_before *= weight, next_last *= weight;
    sums.before += next_before * next_before;
    sums.last += next_last * next_last;
  }
  /// In what units of a tolerance term j is measured: the last one is to be e^-4 tolerances, that before it e^-2.
  template <class Real>
  [[nodiscard]] static Real allowance(std::size_t last, std::size_t j) {
    return j == last ? Real(54.598150033144236) : Real(7.38905609893065);
  }

  template <State X>
  [[nodiscard]] static std::size_t order_of_step(const Workspace<X>& work) {
    using std::ceil, std::log;
    if (work.is_fixed) return order_of_fixed_steps;
    const Tolerance<Scalar<X>>& tolerance = work.tolerance;
    const Scalar<X> relative = tolerance.rtol_each
                                   ? *std::min_element(tolerance.rtol_each, tolerance.rtol_each + dimension(work.rest))
                                   : tolerance.rtol;
    const double asked = static_cast<double>(relative > Scalar<X>(0) ? relative : tolerance_as_number(tolerance));
    const double wanted = std::ceil(2 - 0.5 * std::log(std::max(asked, 1e-16)));
    const auto p = static_cast<std::size_t>(std::max(wanted, static_cast<double>(least_order)));
    return std::min<std::size_t>(p + (dimension(work.rest) <= small_dimension ? more_of_small : 0), dense_degree);
  }

  template <State X, class System>
  [[nodiscard]] static bool may_have_corners(const System& system) {
    if constexpr (KnowsItsCorners<System>) return system.has_corners();
    return true;
  }

  /// False where f is finite, and a derivative of it is not.
  template <State X>
  [[nodiscard]] static bool has_series(const Workspace<X>& work) {
    const std::size_t n = dimension(work.rest);
    const auto are_finite = [&](std::size_t begin, std::size_t end) {
      return std::ranges::all_of(std::span(work.now().c).subspan(begin * n, (end - begin) * n),
                                 [](const Scalar<X>& c) { return detail::is_finite(c); });
    };
    return are_finite(2, work.order + 1) || !are_finite(1, 2);
  }

  /// The coefficients at (t, x).
  template <class System, State X>
  static int expand(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& scale, Workspace<X>& work,
                    Expansion<X>& expansion) {
    expansion.scale = scale;
    expansion.is_known = true;
    work.failure = {};
    const std::size_t n = dimension(x);
    std::copy_n(x.data(), n, expansion.c.data());
    const auto c = std::span(expansion.c).first((work.order + 1) * n);
    if constexpr (HasTaylorCoefficients<System, X>) {
      work.failure = system.taylor_coefficients(t, scale, c);
      expansion.is_known = work.failure.empty();
    } else if constexpr (detail::takes_series<System, X>()) {
      record(system, t, work, x);
      expand_solution<Scalar<X>>(work.program, work.derivatives, t, scale, c);
    } else {
      work.failure = unsupported_reason(system, x);
      expansion.is_known = false;
    }
    return static_cast<int>(work.order);
  }

  /// The operations of f at (t, x): one evaluation. Register 0 is the time, then come the components.
  template <class System, State X>
  static void record(System& system, const Scalar<X>& t, Workspace<X>& work, const X& x) {
    using Number = SeriesNumber<Scalar<X>>;
    work.program.clear();
    const Number time(work.program, work.program.add_variable(), t);
    for (std::size_t i = 0; i < dimension(x); ++i)
      work.recorded_x[i] = Number(work.program, work.program.add_variable(), x.data()[i]);
    evaluate(system, time, work.recorded_x, work.recorded_f);
    for (std::size_t i = 0; i < dimension(x); ++i) work.derivatives[i] = work.recorded_f[i].place_in(work.program);
  }

  /// use(i, sum, slope) for every component: the sum of c_k theta^k for k from 1 to p, and of k c_k theta^(k - 1). Even
  /// and odd terms apart, and some components at once: one product does not wait for the other.
  template <State X, class Use>
  static void for_sums(const Workspace<X>& work, const Scalar<X>& theta, Use&& use) {
    const std::size_t n = dimension(work.rest);
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) sums_of<4>(work, theta, use, i);
    switch (n - i) {
      case 3:
        return sums_of<3>(work, theta, use, i);
      case 2:
        return sums_of<2>(work, theta, use, i);
      case 1:
        return sums_of<1>(work, theta, use, i);
      default:
        return;
    }
  }
  template <std::size_t count, State X, class Use>
  static void sums_of(const Workspace<X>& work, const Scalar<X>& theta, Use&& use, std::size_t begin) {
#if defined(__x86_64__)
    if constexpr (std::is_same_v<Scalar<X>, double> && count >= 3) {
      static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
      if (is_wide) return sums_of_wide<count>(work, theta, use, begin);
    }
#endif
    sums_of_one_width<count, count>(work, theta, use, begin);
  }
#if defined(__x86_64__)
  /// The same in vectors of 256 bits: three components are four, the last of which is not used.
  template <std::size_t count, State X, class Use>
  [[gnu::target("avx2")]] static void sums_of_wide(const Workspace<X>& work, const Scalar<X>& theta, Use& use,
                                                   std::size_t begin) {
    sums_of_one_width<count, widest>(work, theta, use, begin);
  }
#endif
  /// With q = theta^2, the sum is theta (c_1 + theta (E(q) + theta O(q))), of the even and the odd terms from 2 on.
  template <std::size_t count, std::size_t width, State X, class Use>
  [[gnu::always_inline]] static inline void sums_of_one_width(const Workspace<X>& work, const Scalar<X>& theta,
                                                              Use& use, std::size_t begin) {
    using Real = Scalar<X>;
    struct Sums {
      Real value[width] = {}, slope[width] = {};  // by q
    } odd, even;
    const Real q = theta * theta;
    const auto add = [&q](Sums& sums, const Real* c) __attribute__((always_inline)) {
      for (std::size_t i = 0; i < width; ++i) {
        sums.slope[i] = sums.slope[i] * q + sums.value[i];
        sums.value[i] = sums.value[i] * q + c[i];
      }
    };
    const std::size_t n = dimension(work.rest);
    const Real *const first = work.now().c.data() + n + begin, *c = first + (work.order - 1) * n;
    std::size_t k = work.order;
    if (k % 2 == 1) add(odd, c), --k, c -= n;
    for (; k > 2; k -= 2, c -= 2 * n) add(even, c), add(odd, c - n);
    add(even, c);
    // The greatest term comes last, so that it is rounded once.
    for (std::size_t i = 0; i < count; ++i) {
      const Real second = even.value[i] + theta * odd.value[i];
      const Real rise = 2 * even.value[i] + theta * (3 * odd.value[i]) + 2 * q * (even.slope[i] + theta * odd.slope[i]);
      use(begin + i, Real(theta * (first[i] + theta * second)), Real(first[i] + theta * rise));
    }
  }

  /// The polynomial at a part of the step, and its slope for `note_defect`.
  template <State X>
  static void at(const Scalar<X>& part, const Scalar<X>& h, Workspace<X>& work, X& x) {
    using Real = Scalar<X>;
    for_sums(work, Real(part * h / work.now().scale), [&](std::size_t i, const Real& sum, const Real& slope) {
      x.data()[i] = work.now().c[i] + sum;
      work.polynomial_slope.data()[i] = slope;
    });
  }

  /// x_new, with what rounding has taken from x, and takes now; and the slope of the polynomial there.
  template <State X>
  static void advance(const X& x, const Scalar<X>& h, Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    for_sums(work, Real(h / work.now().scale), [&](std::size_t i, const Real& sum, const Real& slope) {
      const Real change = sum + work.rest.data()[i];
      x_new.data()[i] = x.data()[i] + change;
      work.next_rest.data()[i] = (x.data()[i] - x_new.data()[i]) + change;
      work.polynomial_slope.data()[i] = slope;
    });
  }

  /// The error that the defect within the step stands for, where it is greater than one before: a polynomial of order p
  /// whose first term missing is c s^(p + 1) has the defect (p + 1) c s^p.
  template <State X>
  static void note_defect(const Scalar<X>& h, Workspace<X>& work, const X& slope) {
    using std::abs;
    using Real = Scalar<X>;
    const MeasureFactors<Real> factors = measure_factors(work, h);
    for (std::size_t i = 0; i < dimension(work.slope); ++i) {
      const Real error = factors.defect * (slope.data()[i] - work.polynomial_slope.data()[i] * factors.of_polynomial);
      work.defect.data()[i] = detail::greater(Real(abs(error)), work.defect.data()[i]);
    }
  }
};

}  // namespace continuo
