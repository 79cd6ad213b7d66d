// A method as a user writes it, with faults to choose: a member that is missing, or a wrong result.
#pragma once
#include <cstddef>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/method.hpp>

namespace continuo::testing {

/// What is wrong with the method.
enum class Fault {
  none,
  // a member is missing
  name,
  order,
  error_order,
  dense_order,
  dense_degree,
  second_order,
  workspace,
  step,
  interpolate,
  accept,
  error_norm,
  error_of,
  derivative,
  // a member is wrong
  weight,           // of a stage: the step has order 1
  order_claimed,    // 3 instead of 2
  interpolant,      // a line
  interpolant_end,  // does not end at x_new
  zero_estimate,
  large_estimate_order,  // claims an estimate of order 2, which has order 1
  nan_step,              // beyond t = 1, with an error norm that ignores it
  zero_factor,
  negative_factor,
  nan_factor,
};

template <Fault fault>
struct NamesOf {
  static constexpr std::string_view name = "own_heun";
};
template <>
struct NamesOf<Fault::name> {};
template <Fault fault>
struct OrderOf {
  static constexpr int order = fault == Fault::order_claimed ? 3 : 2;
};
template <>
struct OrderOf<Fault::order> {};
template <Fault fault>
struct ErrorOrderOf {
  static constexpr int error_order = fault == Fault::large_estimate_order ? 2 : 1;
};
template <>
struct ErrorOrderOf<Fault::error_order> {};
template <Fault fault>
struct DenseOrderOf {
  static constexpr int dense_order = 2;
};
template <>
struct DenseOrderOf<Fault::dense_order> {};
template <Fault fault>
struct DenseDegreeOf {
  static constexpr int dense_degree = 3;
};
template <>
struct DenseDegreeOf<Fault::dense_degree> {};
template <Fault fault>
struct SecondOrderOf {
  static constexpr bool second_order = false;
};
template <>
struct SecondOrderOf<Fault::second_order> {};

/// The factor for the next step, of the methods that have a wrong one.
template <Fault fault>
struct FactorOf {};
template <Fault fault>
  requires(fault == Fault::zero_factor || fault == Fault::negative_factor || fault == Fault::nan_factor)
struct FactorOf<fault> {
  template <class Work, class X, class Real>
  [[nodiscard]] static Real next_factor(Work&, const Real&, const Real&, const X&, const X&, const Tolerance<Real>&) {
    if (fault == Fault::zero_factor) return Real(0);
    return fault == Fault::nan_factor ? std::numeric_limits<Real>::quiet_NaN() : Real(-1);
  }
};

/// Heun's method with Euler's embedded and a cubic as dense output, three evaluations in each step.
template <Fault fault = Fault::none>
struct OwnHeun : NamesOf<fault>,
                 OrderOf<fault>,
                 ErrorOrderOf<fault>,
                 DenseOrderOf<fault>,
                 DenseDegreeOf<fault>,
                 SecondOrderOf<fault>,
                 FactorOf<fault> {
  template <State X>
  struct Workspace {
    X k1, k2, k_end, error;
  };
  template <State X>
    requires(fault != Fault::workspace)
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {x, x, x, x};
  }

  template <class System, State X>
    requires(fault != Fault::step)
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool, Workspace<X>& work,
                  X& x_new) {
    using Real = Scalar<X>;
    evaluate(system, t, x, work.k1);
    for (std::size_t i = 0; i < dimension(x); ++i) x_new.data()[i] = x.data()[i] + h * work.k1.data()[i];
    evaluate(system, t + h, x_new, work.k2);
    const Real second = fault == Fault::weight ? Real(0.25) : Real(0.5);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      const Real k1 = work.k1.data()[i], k2 = work.k2.data()[i];
      x_new.data()[i] = x.data()[i] + h * ((1 - second) * k1 + second * k2);
      work.error.data()[i] = fault == Fault::zero_estimate ? Real(0) : h * (k2 - k1) / 2;
    }
    if (fault == Fault::nan_step && t + h > 1) x_new.data()[0] = std::numeric_limits<Real>::quiet_NaN();
    return 2;
  }
  template <State X>
    requires(fault != Fault::error_norm)
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return weighted_norm(work.error, x, fault == Fault::nan_step ? x : x_new, tolerance);
  }
  template <State X>
    requires(fault != Fault::error_of)
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    return work.error.data()[i];
  }
  template <class System, State X, int Degree>
    requires(fault != Fault::interpolate)
  static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                         Workspace<X>& work, Interpolant<X, Degree>& interpolant) {
    evaluate(system, t + h, x_new, work.k_end);
    interpolant.set_cubic_hermite(x, work.k1, x_new, work.k_end, h);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      if (fault == Fault::interpolant_end) interpolant.c[3].data()[i] = Scalar<X>(0);
      if (fault != Fault::interpolant) continue;
      interpolant.c[1].data()[i] = x_new.data()[i] - x.data()[i];
      interpolant.c[2].data()[i] = interpolant.c[3].data()[i] = Scalar<X>(0);
    }
    return 1;
  }
  template <State X>
    requires(fault != Fault::accept)
  static void accept(Workspace<X>&) {}
  template <State X>
    requires(fault != Fault::derivative)
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.k1;
  }
};

}  // namespace continuo::testing
