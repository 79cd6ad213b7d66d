// continuo/methods/structural/central_difference.hpp
#pragma once
#include <string_view>
#include <utility>

#include <continuo/methods/support/second_order_method.hpp>

namespace continuo {

/// The central difference (q_next - 2 q + q_last) / h^2 = a, order 2, carried as a leapfrog: its history is the
/// velocity w half a step back, which loses no digits where q_next - q_last would. With h_last the step before:
///
///   w_new = w + (h_last + h)/2 a,   q_new = q + h w_new,   v_new = w_new + h/2 a_new (to report v at q_new).
///
/// The first step and every one after a jump begin with w = v at the same time and h_last = 0. Where a depends on v,
/// a_new is taken at w_new + h/2 a, which keeps order 2. Components in no pair take a step of the trapezoidal rule.
/// E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed. (2006), I.1.4, eq. 1.15-1.17.
struct CentralDifference : SecondOrderMethod {
  static constexpr std::string_view name = "central_difference";
  static constexpr int order = 2, dense_order = 2;

  template <State X>
  struct Workspace : EndDerivatives<X> {
    X half;                     // w, at the velocities' places
    X half_new;                 // w of the step not yet accepted
    Scalar<X> h_last, h_taken;  // of the last accepted step (0: none since a jump) and of the last one tried
    bool has_history = false;

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      EndDerivatives<X>::transfer(archive);
      archive(half, half_new, h_last, h_taken, has_history);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {{x, x}, x, x, Scalar<X>(0), Scalar<X>(0)};
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    const int evaluations = work.evaluate_start(system, t, x, discontinuity);
    if (discontinuity || !work.has_history) {
      work.half = x;
      work.h_last = Scalar<X>(0);
      work.has_history = true;
    }
    const Scalar<X> half = h * Scalar<X>(0.5), kick = half + work.h_last * Scalar<X>(0.5);
    euler(x, h, work.start, x_new);
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      const Scalar<X> a = work.start.data()[velocity], w_new = work.half.data()[velocity] + kick * a;
      work.half_new.data()[velocity] = w_new;
      x_new.data()[position] = x.data()[position] + h * w_new;
      x_new.data()[velocity] = w_new + half * a;
    });
    evaluate(system, t + h, x_new, work.end);
    correct(system, x, half, work, x_new);
    work.h_taken = h;
    return evaluations + 1;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    SecondOrderMethod::accept<X>(work);
    swap(work.half, work.half_new);
    work.h_last = work.h_taken;
  }
  /// The velocities half a step before are moved by the same way.
  template <State X>
  static void moved(Workspace<X>& work, const X& from, const X& to) {
    for (std::size_t i = 0; i < dimension(to); ++i) work.half.data()[i] += to.data()[i] - from.data()[i];
    SecondOrderMethod::moved<X>(work, from, to);
  }
  template <State X, class Mask>
  static void accept(Workspace<X>& work, const Mask& accepted) {
    SecondOrderMethod::accept<X>(work, accepted);
    choose(accepted, work.half_new, work.half);
    work.h_last = select(accepted, work.h_taken, work.h_last);
  }
};

}  // namespace continuo
