// An implicit method whose linear systems are solved by GMRES, or by a linear solver of your own:
//
//   solve(heat, x0, {0, 1}, Krylov<Rodas5P>{});               // with the preconditioner of the system, if it has one
//   solve(heat, x0, {0, 1}, WithSolver<Radau5, Multigrid>{});
//
// GMRES in a step: P. N. Brown, A. C. Hindmarsh, "Reduced storage matrix methods in stiff ODE systems", Appl. Math.
// Comp. 31 (1989).
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <continuo/methods/implicit/solver_view.hpp>
#include <continuo/methods/implicit/weighted_gmres.hpp>
#include <continuo/methods/linear_solver.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

namespace detail {
template <class M, class System, class X>
concept TreatsAsSplit = IsSplit<System, X> && requires { requires M::tableau.is_additive(); };

}  // namespace detail

/// The implicit method M with a linear solver of type Solver (see LinearSolver): one for each matrix that a step
/// decomposes, made by Solver{} or, where that does not exist, by Solver(const System&) at the first step. A method
/// with complex matrices (Radau, Gauss) by a solver of real ones has a real system solved in each of some ten products
/// of GMRES. A run that ends because a solver failed has its message as a hint.
template <class M, class Solver>
struct WithSolver : M {
  /// The workspace of M, and what the solvers reported.
  template <State X>
  struct Workspace : M::template Workspace<X> {
    /// The workspace of M becomes a part of it.
    explicit Workspace(typename M::template Workspace<X> work) : M::template Workspace<X>(std::move(work)) {}

    Tolerance<Scalar<X>> weights{Scalar<X>(1e-6), Scalar<X>(1e-9)};  ///< The tolerance of the step.
    StepStatus solver_status = StepStatus::done;                     ///< How solvers failed in the last step.
    std::string reason{};                                            ///< What they said.
  };
  /// Refuses, by a sentence, what cannot be combined for states X; true where all can.
  template <State X>
  [[nodiscard]] static consteval bool check_for_states() {
    constexpr bool implicit = detail::is_implicit<M>();
    static_assert(implicit, "the method is explicit: it has no linear systems that a solver could solve");
    constexpr bool automatic = detail::is_automatic<M>();
    static_assert(!automatic,
                  "the method hands over between two methods: give the solver to the stiff one of them, as in "
                  "Switching<Tsitouras5, WithSolver<Rodas5P, MySolver>>");
    constexpr bool accelerations = M::second_order;
    static_assert(!accelerations,
                  "the method solves for accelerations by a matrix of its own, half the size of the state: it takes no "
                  "linear solver");
    constexpr bool fixed = FixedSize<X>;
    static_assert(
        !fixed,
        "the state has a fixed size, and its equations are solved in registers: a linear solver needs a state "
        "of run-time size, such as std::vector<double>");
    return implicit && !automatic && !accelerations && !fixed && check_linear_solver<Solver, X>();
  }
  /// The workspace for states like x.
  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    static_assert(check_for_states<X>());
    return Workspace<X>(M::workspace(x));
  }

  /// Before every step: solvers are as accurate as the step needs.
  template <class Work, class Real>
  static void set_tolerance(Work& work, const Tolerance<Real>& tolerance) {
    work.weights = tolerance;
    M::set_tolerance(work, tolerance);
  }
  /// How the last step ended; a failure of a solver comes first.
  template <class Work>
  [[nodiscard]] static StepStatus status(const Work& work) {
    return work.solver_status == StepStatus::done ? M::status(work) : work.solver_status;
  }
  /// What a solver said that failed in the last step.
  template <class Work>
  [[nodiscard]] static std::string_view failure(const Work& work) {
    return work.reason;
  }

  /// A step of M.
  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    constexpr bool splits = detail::TreatsAsSplit<M, System, X>;
    static_assert(!splits,
                  "the method treats the parts of a split system apart, and takes no linear solver for the stiff one: "
                  "give the system as a whole");
    constexpr bool made =
        std::is_default_constructible_v<Solver> || std::is_constructible_v<Solver, const ReferredSystem<System>&>;
    static_assert(made,
                  "the linear solver can be made neither by Solver{} nor from the system, by Solver(const System&)");
    detail::SolverView<System, Solver, X> view(system, work.weights);
    typename M::template Workspace<X>& own = work;
    const int evaluations = M::step(view, t, x, h, discontinuity, own, x_new);
    if (!view.bound)
      view.note(StepStatus::singular_matrix, {Ending::invalid_input, "the method takes no linear solver"});
    work.solver_status = view.status;
    work.reason = std::move(view.reason);
    return evaluations + view.evaluations;
  }
};

/// Solves (c M - J) y = b without a matrix, by GMRES from the left with the preconditioner of the system, or the
/// diagonal of c M without one, to a millionth of the tolerance. Memory: 50 states, 100 for the complex matrices of
/// Radau and Gauss.
template <class Real = double>
class KrylovSolver {
 public:
  /// Does nothing: the preconditioner is set up when it is needed.
  template <State X, class Number>
  [[nodiscard]] Status factor(ShiftedOperator<X, Number>&) {
    return {};
  }
  /// b becomes the solution. Fails after 500 products.
  template <State X, class Number>
  [[nodiscard]] Status solve(ShiftedOperator<X, Number>& a, std::span<Number> b) {
    a.precondition(b);
    const auto apply = [&](std::span<const Number> v, std::span<Number> image) {
      a.multiply(v, image);
      a.precondition(image);
    };
    const auto scale = [&](std::size_t i) { return a.scale(i); };
    if constexpr (std::is_same_v<Number, Real>) {
      return real_.solve(b, apply, scale);
    } else {
      return complex_.solve(b, apply, scale);
    }
  }

 private:
  detail::WeightedGmres<Real> real_;
  detail::WeightedGmres<ComplexNumber<Real>> complex_;
};

/// The implicit method M, its linear systems solved by GMRES: for systems too large for a matrix. J v is the member
/// `jacobian_action` of the system, else from the entries that it gives, else a difference of f. Real is the scalar of
/// the state.
template <class M, class Real = double>
using Krylov = WithSolver<M, KrylovSolver<Real>>;

}  // namespace continuo
