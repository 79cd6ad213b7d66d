// continuo/methods/multistep/bdf2.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/stage_solver.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// Of the workspace of Bdf2: see ImplicitMethod.
struct InFirstStep {
  template <class Work>
  auto& operator()(Work& work) const {
    return work.start.solver;
  }
};

/// Backward differentiation over two steps, L-stable, of order 2, with fixed steps; a step of another size (the last
/// one) is taken by the formula for it. The first step is one of TR-BDF2.
/// E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", III.5, eq. 5.8: with w = h /
/// h_before,
///   x_new = x + w^2 / (1 + 2 w) (x - x_before) + (1 + w) / (1 + 2 w) h f(t + h, x_new).
struct Bdf2 : ImplicitMethod<InFirstStep> {
  static constexpr std::string_view name = "bdf2";
  static constexpr int order = 2, error_order = 0, dense_degree = 3, dense_order = 2;
  static constexpr bool second_order = false;

  template <State X>
  struct Workspace {
    TrBdf2::Workspace<X> start;  // its solver is that of all steps
    X before, current;           // x where the step before began, where this one does
    X slope, end_slope;          // x' at both ends of this step
    Scalar<X> h_before{}, h_current{};
    bool started = false;  // this step was one of TR-BDF2

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(start, before, current, slope, end_slope, h_before, h_current, started);
    }
  };
  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    Workspace<X> work{TrBdf2::workspace(x), x, x, x, x};
    work.start.solver.insists = true;
    return work;
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    work.current = x;
    work.h_current = h;
    work.started = discontinuity || work.h_before == Scalar<X>(0);
    if (!work.started) return two_step(system, t, x, h, work, x_new);
    const int evaluations = TrBdf2::step(system, t, x, h, true, work.start, x_new);
    work.slope = work.start.k.front();
    work.end_slope = work.start.k.back();
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>&, const Scalar<X>&, const X&, const X& x_new,
                                            const Tolerance<Scalar<X>>&) {
    return detail::zero_if_all_finite(x_new);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>&, const Scalar<X>&, std::size_t) {
    return Scalar<X>(0);
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X& x_new,
                         const Workspace<X>& work, Interpolant<X, dense_degree>& interpolant) {
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Scalar<X>, 4> power{};
      detail::set_cubic_hermite<Scalar<X>>(x.data()[i], x_new.data()[i], Scalar<X>(h * work.slope.data()[i]),
                                           Scalar<X>(h * work.end_slope.data()[i]), power);
      for (std::size_t j = 0; j < power.size(); ++j) interpolant.c[j].data()[i] = power[j];
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    swap(work.before, work.current);
    swap(work.slope, work.end_slope);
    work.h_before = work.h_current;
    work.start.solver.accept();
  }
  /// The state of before is moved by the same way: the distance between them is a motion.
  template <State X>
  static void moved(Workspace<X>& work, const X& from, const X& to) {
    for (std::size_t i = 0; i < dimension(to); ++i) work.before.data()[i] += to.data()[i] - from.data()[i];
  }

  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.slope;
  }

 private:
  template <class System, State X>
  [[nodiscard]] static int two_step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                    Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    auto& solver = work.start.solver;
    const Real w = h / work.h_before, along = w * w / (1 + 2 * w), gamma = (1 + w) / (1 + 2 * w);
    X& base = work.start.base;
    X& z = work.start.z;
    int evaluations = solver.prepare(system, t, x, h, false);
    for (;;) {
      if (!solver.decompose(1 / (gamma * h))) return evaluations;
      for (std::size_t i = 0; i < dimension(x); ++i) {
        const Real moved = x.data()[i] - work.before.data()[i];
        base.data()[i] = x.data()[i] + along * moved;
        z.data()[i] = (w - along) * moved;  // as if the state went on in a line
      }
      if (solver.solve(system, Real(t + h), base, x, z, Real(1e-4), evaluations)) break;
      if (solver.cannot_try_again()) return evaluations;
      solver.status = StepStatus::done;
      evaluations += solver.evaluate_jacobian(system, t, x, h);
    }
    for (std::size_t i = 0; i < dimension(x); ++i) {
      x_new.data()[i] = base.data()[i] + z.data()[i];
      work.end_slope.data()[i] = solver.shift * z.data()[i];
    }
    return evaluations;
  }
};

}  // namespace continuo
