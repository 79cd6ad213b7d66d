// The stepper of explicit Runge-Kutta methods whose stability reaches far along the negative real axis: for equations
// of diffusion, whose eigenvalues are large, real and negative, and where no linear system is to be solved. With s
// stages the step may be as long as about s^2 / spectral radius; each step takes as many as it needs.
//
// A method is a struct with a name, orders and
//   stages_for(z, greatest)  -> the stages that keep a step stable for eigenvalues between -z and 0
//   reach(s)                 -> the greatest such z of s stages
//   most_stages(rtol)        -> above these, rounding within the step would show
//   advance(system, t, x, h, s, work, x_new) -> evaluations of f besides those at both ends
//   set_error(x, h, x_new, work)  writes work.error, with f at both ends known
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/methods/support/spectral_radius.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

template <class Derived>
struct StabilizedRungeKutta {
  static constexpr int dense_degree = 3;
  static constexpr bool second_order = false;

  template <State X>
  struct Workspace {
    using Real = Scalar<X>;
    X start, end;     // f at both ends of the last step
    X before, slope;  // of the recurrence
    X error;
    SpectralRadius<X> spectrum;
    Tolerance<Real> tolerance{Real(1e-6), Real(1e-9)};
    Real radius{}, t{};          // the spectral radius, where the last step began
    std::size_t radius_age = 0;  // accepted steps since it was estimated
    std::size_t stages = 0;      // of the last step
    bool retry = false;          // the last step was rejected: f at its start is known
    bool moved = false;          // the end of the last step was moved: f at the start of this one is not known

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(start, end, spectrum, radius, t, radius_age, stages, retry, moved);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {x, x, x, x, x, SpectralRadius<X>(x)};
  }

  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    work.tolerance = tolerance;
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    using std::abs;
    int evaluations = 1;
    const bool again = work.retry && work.t == t;
    if (discontinuity && !again) {
      evaluate(system, t, x, work.start);
      ++evaluations;
      work.spectrum.known = false;
    } else if (work.moved) {
      evaluate(system, t, x, work.start);
      ++evaluations;
    }
    work.moved = false;
    const bool stale = discontinuity || work.radius_age >= oldest_radius || again;
    if constexpr (HasSpectralRadius<System, X>) {
      if (!again) work.radius = system.spectral_radius(t, x);
    } else if (stale && !(again && work.radius_age == 0)) {
      work.radius = work.spectrum.estimate(system, t, x, work.start, evaluations);
      work.radius_age = 0;
    }
    work.t = t;
    work.retry = false;
    work.stages = Derived::template stages_for<Real>(abs(h) * work.radius, most_stages(work));
    evaluations += Derived::advance(system, t, x, h, work.stages, work, x_new);
    evaluate(system, t + h, x_new, work.end);
    Derived::set_error(x, h, x_new, work);
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return strictness_of<Derived>(tolerance) * weighted_norm(work.error, x, x_new, tolerance) +
           detail::zero_if_all_finite(x_new);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    return work.error.data()[i];
  }

  /// Never beyond the reach of the stages that rounding allows.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(const Workspace<X>& work, const Scalar<X>& factor, const Scalar<X>& h,
                                             const X&, const X&, const Tolerance<Scalar<X>>&) {
    using std::abs, std::min;
    const Scalar<X> longest = Derived::template reach<Scalar<X>>(most_stages(work));
    return abs(h) * work.radius * factor > longest ? longest / (abs(h) * work.radius) : factor;
  }
  /// Whether stability limits the last step, despite nearly as many stages as a step may have.
  template <State X>
  [[nodiscard]] static bool stability_limits(const Workspace<X>& work) {
    return 10 * work.stages >= 9 * most_stages(work);
  }
  template <State X>
  static void rejected(Workspace<X>& work, const Scalar<X>&) {
    work.retry = true;
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X& x_new, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Real, dense_degree + 1> c{};
      detail::set_cubic_hermite<Real>(x.data()[i], x_new.data()[i], Real(h * work.start.data()[i]),
                                      Real(h * work.end.data()[i]), c);
      for (std::size_t j = 0; j < c.size(); ++j) interpolant.c[j].data()[i] = c[j];
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    std::swap(work.start, work.end);
    ++work.radius_age;
  }

  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.moved = true;
  }
  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.start;
  }

 private:
  static constexpr std::size_t oldest_radius = 25;  // accepted steps; Sommeijer, Shampine & Verwer, section 4

  template <State X>
  [[nodiscard]] static std::size_t most_stages(const Workspace<X>& work) {
    using std::max;
    const auto& tolerance = work.tolerance;
    const Scalar<X> rtol = tolerance.rtol_each ? tolerance.rtol_each[0] : tolerance.rtol;
    return Derived::most_stages(max(rtol, 100 * std::numeric_limits<Scalar<X>>::epsilon()));
  }
};

}  // namespace continuo
