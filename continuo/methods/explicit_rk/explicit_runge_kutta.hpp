// continuo/methods/explicit_rk/explicit_runge_kutta.hpp
// The stepper of every explicit Runge-Kutta method. A method is a struct with a name and a tableau:
//
//   struct Midpoint : ExplicitRungeKutta<Midpoint> {
//     static constexpr std::string_view name = "midpoint";
//     static constexpr int order = 2, dense_order = 2;
//     static constexpr Tableau<2> tableau{.c = {0, 1_c / 2}, .a = {{}, {1_c / 2}}, .b = {0, 1}};
//   };
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <continuo/methods/explicit_rk/own_step.hpp>
#include <continuo/methods/explicit_rk/tableau.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/methods/support/weighted_sum.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

template <class Derived>
struct ExplicitRungeKutta {
 private:
  /// The slot of k that keeps column j of the tableau: `end` shares the last stage's where both are the same.
  [[nodiscard]] static constexpr std::size_t slot(std::size_t j) {
    return j >= Derived::tableau.stages && Derived::tableau.first_same_as_last() ? j - 1 : j;
  }
  [[nodiscard]] static constexpr std::size_t column(std::size_t in_slot) {
    return in_slot >= Derived::tableau.end && Derived::tableau.first_same_as_last() ? in_slot + 1 : in_slot;
  }
  [[nodiscard]] static constexpr std::size_t end_slot() { return slot(Derived::tableau.end); }
  struct ErrorWeight {
    constexpr Coefficient operator()(std::size_t j) const {
      if (Derived::error_order == 0) return 0;
      return Derived::tableau.b[j] - Derived::tableau.embedded[j];
    }
  };
  [[nodiscard]] static constexpr std::size_t slots() { return slot(Derived::tableau.known - 1) + 1; }

 public:
  static constexpr int error_order = 0;   // no estimate, unless Derived says so
  static constexpr int dense_degree = 3;  // cubic Hermite, unless Derived says so
  static constexpr bool second_order = false;

  /// f at the stages, at the end of the step (the last stage where that is the same) and at the extra stages.
  template <State X>
  struct Workspace {
    std::array<detail::Kept<X>, ExplicitRungeKutta::slots()> k;
    X argument;                        // of f, where X has no fixed size
    bool start_fresh = false;          // k[0] is f at the start of the next step
    bool end_fresh = false;            // k[end_slot()] is f at the end of the last step
    detail::OwnStep<Scalar<X>> own{};  // of a system that takes its steps itself

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(k[0], k[ExplicitRungeKutta::end_slot()], start_fresh, end_fresh);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      return Workspace<X>{{((void)j, detail::keep(x))...}, x};
    }(std::make_index_sequence<slots()>());
  }

  /// By which a system that takes the steps itself measures their errors.
  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    if constexpr (!detail::Packed<X>) work.own.tolerance = tolerance;
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    if constexpr (detail::Packed<X>) {
      return flat_step(system, t, x, h, discontinuity, work, x_new);
    } else if constexpr (detail::TakesSteps<System, Derived, X>) {
      work.start_fresh = work.start_fresh && !discontinuity;
      work.own.has_square = false;
      const int evaluations = static_cast<int>(Derived::tableau.stages) - (work.start_fresh ? 1 : 0);
      if (system.template take_step<Derived>(t, x, h, work, x_new)) return evaluations;
      return take_step(system, t, x, h, discontinuity, work, x_new);
    } else {
      return take_step(system, t, x, h, discontinuity, work, x_new);
    }
  }

  /// Root mean square of error_i / scale_i (0 without an estimate); not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(Derived::template error_square<X>(work, h, x, x_new, tolerance));
  }
  /// Its square, for who can do without the root: the next step waits for it.
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    if (work.own.is_measured_by(tolerance)) return work.own.square;
    using Error = detail::Row<ErrorWeight, Derived::tableau.stages>;
    const auto k = detail::stages_of<Error, X>(work.k);
    detail::Unit<X> sum{};
    detail::for_each_unit(x, [&](std::size_t i) __attribute__((always_inline)) {
      const detail::Unit<X> end = detail::load<X>(x_new.data(), i);
      const detail::Unit<X> nothing = detail::zero_if_finite(end);
      if constexpr (Derived::error_order > 0) {
        // The scale is known before the error where the last stage is not part of x_new: the division is done by then.
        const detail::Unit<X> weight = h / detail::error_scale<X>(tolerance, i, x, x_new);
        const detail::Unit<X> ratio = detail::row_sum<Error, X>(k, i) * weight;
        sum += ratio * ratio + nothing;
      } else {
        sum += nothing;
      }
    });
    return detail::total<X>(sum) * detail::one_over_dimension(x);
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>& h, std::size_t i) {
    using Error = detail::Row<ErrorWeight, Derived::tableau.stages>;
    return detail::size_of_sum<Error, X>(work.k, h, i);
  }

  /// Between `step` and `accept`.
  template <class System, State X, int Degree>
  static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                         Workspace<X>& work, Interpolant<X, Degree>& interpolant) {
    constexpr auto& tableau = Derived::tableau;
    static_assert(Degree == Derived::dense_degree && Degree == static_cast<int>(tableau.degree));
    int evaluations = static_cast<int>(tableau.extra);
    if (!work.end_fresh) {
      detail::evaluate_kept<X>(system, t + h, x_new, work.k[end_slot()]);
      work.end_fresh = true;
      ++evaluations;
    }
    [&]<std::size_t... e>(std::index_sequence<e...>) {
      (extra_stage<e>(system, t, x, h, work), ...);
    }(std::make_index_sequence<tableau.extra>());
    set_coefficients(x, h, x_new, work, interpolant);
    return evaluations;
  }

  /// The end of the last step is the start of the next.
  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    if (work.end_fresh) swap(work.k[0], work.k[end_slot()]);
    work.start_fresh = work.end_fresh;
    work.end_fresh = false;
  }

  /// The same where each lane of the state is a run of its own: only the lanes in `accepted` go on.
  template <State X, class Mask>
  static void accept(Workspace<X>& work, const Mask& accepted) {
    if (work.end_fresh) {
      for (std::size_t i = 0; i < dimension(work.argument); ++i) {
        auto& start = work.k[0].data()[i];
        start = select(accepted, work.k[end_slot()].data()[i], start);
      }
    }
    work.start_fresh = work.start_fresh && (work.end_fresh || none(accepted));
    work.end_fresh = false;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.start_fresh = false;
  }

  /// f at the start of the last step: after `step`, before `accept`.
  template <State X>
  static decltype(auto) derivative(const Workspace<X>& work) {
    return detail::unpack<X>(work.k[0]);
  }

 private:
  template <class System, State X>
  [[nodiscard]] [[gnu::always_inline]] static int take_step(System& system, const Scalar<X>& t, const X& x,
                                                            const Scalar<X>& h, bool discontinuity, Workspace<X>& work,
                                                            X& x_new) {
    constexpr auto& tableau = Derived::tableau;
    constexpr bool ends_with_f = tableau.first_same_as_last();
    constexpr std::size_t inner = tableau.stages - (ends_with_f ? 1 : 0);
    int evaluations = static_cast<int>(tableau.stages) - 1;
    if (discontinuity || !work.start_fresh) {
      detail::evaluate_kept<X>(system, t, x, work.k[0]);
      work.start_fresh = true;
      ++evaluations;
    }
    [&]<std::size_t... s>(std::index_sequence<s...>) __attribute__((always_inline)) {
      (stage<s + 1>(system, t, x, h, work), ...);
    }(std::make_index_sequence<inner - 1>());
    finish(x, h, work, x_new);
    if constexpr (ends_with_f) detail::evaluate_kept<X>(system, t + h, x_new, work.k[end_slot()]);
    work.end_fresh = ends_with_f;
    return evaluations;
  }
  /// With f compiled into it, however often it occurs: a call would cost more than the f of a small state, and would
  /// send what is kept in registers through memory.
  template <class System, State X>
  [[nodiscard]] [[gnu::flatten]] static int flat_step(System& system, Scalar<X> t, const X& x, Scalar<X> h,
                                                      bool discontinuity, Workspace<X>& work, X& x_new) {
    return take_step(system, t, x, h, discontinuity, work, x_new);
  }

  struct EndWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.b[j]; }
  };
  template <std::size_t s>
  struct StageWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.a[s][j]; }
  };
  template <std::size_t s>
  struct StageNode {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.c[s]; }
  };
  template <std::size_t e>
  struct ExtraNode {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.extra_c[e]; }
  };
  template <std::size_t e>
  struct ExtraWeight {  // by slot
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.extra_a[e][column(j)]; }
  };
  template <std::size_t n>
  struct DenseWeight {  // by slot
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.dense[column(j)][n]; }
  };

  /// t + c h.
  template <class C, class Real>
  [[nodiscard]] static Real node(const Real& t, const Real& h) {
    if constexpr (C{}(0).is_zero()) {
      return t;
    } else if constexpr (C{}(0) == Coefficient(1)) {
      return t + h;
    } else {
      return t + h * detail::Row<C, 1>::template weight<Real, 0>();
    }
  }

  template <std::size_t s, class System, State X>
  [[gnu::always_inline]] static void stage(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                           Workspace<X>& work) {
    using Weights = detail::Row<StageWeight<s>, s>;
    evaluate_at<Weights>(system, node<StageNode<s>>(t, h), x, h, work, work.k[s]);
  }
  template <std::size_t e, class System, State X>
  [[gnu::always_inline]] static void extra_stage(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                                 Workspace<X>& work) {
    using Weights = detail::Row<ExtraWeight<e>, slot(Derived::tableau.end + 1) + e>;
    evaluate_at<Weights>(system, node<ExtraNode<e>>(t, h), x, h, work, work.k[slot(Derived::tableau.end + 1) + e]);
  }
  template <class Weights, class System, State X>
  [[gnu::always_inline]] static void evaluate_at(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                                 Workspace<X>& work, detail::Kept<X>& derivative) {
    if constexpr (detail::FixedSize<X>) {
      X argument{};
      detail::advance<Weights>(x, h, work.k, argument);
      detail::evaluate_kept<X>(system, t, argument, derivative);
    } else {
      detail::advance<Weights>(x, h, work.k, work.argument);
      detail::evaluate_kept<X>(system, t, work.argument, derivative);
    }
  }

  /// x_new, where the sum is complete before it meets x: one rounding at the size of x.
  template <State X>
  [[gnu::always_inline]] static void finish(const X& x, const Scalar<X>& h, const Workspace<X>& work, X& x_new) {
    using Weights = detail::Row<EndWeight, Derived::tableau.stages>;
    const auto k = detail::stages_of<Weights, X>(work.k);
    detail::for_each_unit(x, [&, from = x.data(), to = x_new.data()](std::size_t i) __attribute__((always_inline)) {
      detail::store<X>(detail::load<X>(from, i) + h * detail::row_sum<Weights, X>(k, i), i, to);
    });
  }

  /// A cubic Hermite, and to it theta^2 (1 - 2 theta + theta^2) theta^n h sum_j dense[j][n] k_j for each n.
  template <State X, int Degree>
  static void set_coefficients(const X& x, const Scalar<X>& h, const X& x_new, const Workspace<X>& work,
                               Interpolant<X, Degree>& interpolant) {
    using Unit = detail::Unit<X>;
    const Unit* const first = detail::units_of<X>(work.k[0]);
    const Unit* const last = detail::units_of<X>(work.k[end_slot()]);
    detail::for_each_unit(x, [&](std::size_t i) __attribute__((always_inline)) {
      std::array<Unit, static_cast<std::size_t>(Degree) + 1> c{};
      detail::set_cubic_hermite<Scalar<X>>(detail::load<X>(x.data(), i), detail::load<X>(x_new.data(), i),
                                           Unit(h * first[i]), Unit(h * last[i]), c);
      [&]<std::size_t... n>(std::index_sequence<n...>) {
        (add_dense_term<n, X>(h, work, i, c), ...);
      }(std::make_index_sequence<Derived::tableau.dense_terms>());
      for (std::size_t j = 0; j < c.size(); ++j) detail::store<X>(c[j], i, interpolant.c[j].data());
    });
  }
  template <std::size_t n, State X, class Powers>
  static void add_dense_term(const Scalar<X>& h, const Workspace<X>& work, std::size_t i, Powers& c) {
    using Weights = detail::Row<DenseWeight<n>, slots()>;
    const detail::Unit<X> term = h * detail::row_sum<Weights, X>(detail::stages_of<Weights, X>(work.k), i);
    c[n + 2] += term;
    c[n + 3] -= term + term;
    c[n + 4] += term;
  }
};

}  // namespace continuo
