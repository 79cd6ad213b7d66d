// Methods that `check_method` must refuse. This file does not compile: the test compares the errors of the compiler
// with the comments `refused:`, one for each error (refusals.sh).
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

#include <tests/methods/own_method.hpp>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/switching.hpp>

namespace continuo::refusals {

using testing::Fault;
using testing::OwnHeun;
using X = std::array<double, 2>;
using Right = OwnHeun<>;
using Weights = Tolerance<double>;
template <class M>
inline constexpr bool checked = check_method<M, X>();

// ---- members that are missing

// refused: the method lacks a public member `name`: static constexpr std::string_view name = "my_method"
template bool const checked<OwnHeun<Fault::name>>;
// refused: the method lacks a public member `order`, at least 1
template bool const checked<OwnHeun<Fault::order>>;
// refused: the method lacks a public member `error_order`
template bool const checked<OwnHeun<Fault::error_order>>;
// refused: the method lacks a public member `dense_order`
template bool const checked<OwnHeun<Fault::dense_order>>;
// refused: the method lacks a public member `dense_degree`
template bool const checked<OwnHeun<Fault::dense_degree>>;
// refused: the method lacks a public member `second_order`
template bool const checked<OwnHeun<Fault::second_order>>;
// refused: the method lacks its workspace
template bool const checked<OwnHeun<Fault::workspace>>;
// refused: the method lacks a public and static member `step`
template bool const checked<OwnHeun<Fault::step>>;
// refused: the method lacks a public and static member `interpolate`
template bool const checked<OwnHeun<Fault::interpolate>>;
// refused: the method lacks a public and static member `accept`
template bool const checked<OwnHeun<Fault::accept>>;
// refused: the method has an error_order above 0 and lacks a public and static member `error_norm`
template bool const checked<OwnHeun<Fault::error_norm>>;
// refused: the method has an error_order above 0 and lacks a public and static member `error_of`
template bool const checked<OwnHeun<Fault::error_of>>;
// refused: the method has an error_order above 0 and lacks a public and static member `derivative`
template bool const checked<OwnHeun<Fault::derivative>>;
// refused: the type is no method: see the concept Method, or name one of the library, such as Dop853{}
template bool const checked<const char*>;
// refused: the type is no method: see the concept Method
template bool const checked<Tolerance<double>>;

// ---- members that are nearly right

struct OrderZero : Right {
  static constexpr int order = 0;
};
// refused: the method lacks a public member `order`, at least 1
template bool const checked<OrderZero>;

struct PrivateName : Right {
 private:
  static constexpr std::string_view name = "private";
};
// refused: the method lacks a public member `name`
template bool const checked<PrivateName>;

struct WorkspaceThatCannotBeCopied : Right {
  template <State Y>
  struct Workspace {
    std::unique_ptr<Y> k;
  };
  template <State Y>
  static Workspace<Y> workspace(const Y& x);
};
// refused: the method lacks its workspace, a public template of a struct that can be copied
template bool const checked<WorkspaceThatCannotBeCopied>;

struct StepTellsSuccess : Right {
  template <class System, State Y>
  static bool step(System&, double, const Y&, double, bool, Workspace<Y>&, Y&);
};
// refused: the method lacks a public and static member `step` that returns its number of evaluations of f
template bool const checked<StepTellsSuccess>;

struct StepOfAnObject : Right {
  template <class System, State Y>
  int step(System&, double, const Y&, double, bool, Workspace<Y>&, Y&);
};
// refused: the method lacks a public and static member `step`
template bool const checked<StepOfAnObject>;

struct StepCopiesSystem : Right {
  template <class System, State Y>
  static int step(System, double, const Y&, double, bool, Workspace<Y>&, Y&);
};
// refused: the method copies the system in each step
template bool const checked<StepCopiesSystem>;

struct StepCopiesEnd : Right {
  template <class System, State Y>
  static int step(System&, double, const Y&, double, bool, Workspace<Y>&, Y);
};
// refused: `step` gets x_new by value or as a constant, so that the result of the step is lost: declare X& x_new
template bool const checked<StepCopiesEnd>;

struct StepCopiesWork : Right {
  template <class System, State Y>
  static int step(System&, const Scalar<Y>&, const Y&, const Scalar<Y>&, bool, Workspace<Y>, Y&);
};
// refused: `step` gets the workspace by value, so that the stages of the step are lost: declare Workspace<X>& work
template bool const checked<StepCopiesWork>;

struct AcceptCopiesWork : Right {
  template <State Y>
  static void accept(Workspace<Y>);
};
// refused: `accept` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<AcceptCopiesWork>;

struct InterpolateCopies : Right {
  template <class System, State Y, int Degree>
  static int interpolate(System&, double, const Y&, double, const Y&, Workspace<Y>&, Interpolant<Y, Degree>);
};
// refused: `interpolate` gets the interpolant by value or as a constant, so that its result is lost
template bool const checked<InterpolateCopies>;

struct ErrorTellsSuccess : Right {
  template <State Y>
  static bool error_norm(const Workspace<Y>&, double, const Y&, const Y&, const Weights&);
};
// refused: the method has an error_order above 0 and lacks a public and static member `error_norm`
template bool const checked<ErrorTellsSuccess>;

struct ErrorChangesWork : Right {
  template <State Y>
  static double error_norm(Workspace<Y>&, double, const Y&, const Y&, const Weights&);
};
// refused: static Real error_norm(const Workspace<X>& work, Real h, const X& x, const X& x_new, const Tolerance<Real>&
template bool const checked<ErrorChangesWork>;

// ---- optional members that would be ignored

struct PrivateImplicit : Right {
 private:
  static constexpr bool implicit = true;
};
// refused: the member `implicit` of the method would be ignored
template bool const checked<PrivateImplicit>;

struct AutomaticOfAnObject : Right {
  bool automatic = true;
};
// refused: the member `automatic` of the method would be ignored
template bool const checked<AutomaticOfAnObject>;

struct StartingOrderIsAFunction : Right {
  static constexpr int starting_order() { return 1; }
};
// refused: the member `starting_order` of the method would be ignored
template bool const checked<StartingOrderIsAFunction>;

struct OrderOfFixedStepsIsReal : Right {
  static constexpr double order_of_fixed_steps = 1.5;
};
// refused: the member `order_of_fixed_steps` of the method would be ignored
template bool const checked<OrderOfFixedStepsIsReal>;

struct ReasonChangesSystem : Right {
  template <class System, State Y>
    requires(!std::is_const_v<System>)
  static std::string_view unsupported_reason(System&, const Y&);
};
// refused: the member `unsupported_reason` of the method would be ignored
template bool const checked<ReasonChangesSystem>;

struct SquareWithoutTolerance : Right {
  template <State Y>
  static double error_square(const Workspace<Y>&, double, const Y&, const Y&);
};
// refused: the member `error_square` of the method would be ignored
template bool const checked<SquareWithoutTolerance>;

struct SetToleranceChangesIt : Right {
  template <State Y>
  static void set_tolerance(Workspace<Y>&, Weights&);
};
// refused: the member `set_tolerance` of the method would be ignored
template bool const checked<SetToleranceChangesIt>;

struct SetToleranceCopiesWork : Right {
  template <State Y>
  static void set_tolerance(Workspace<Y>, const Weights&);
};
// refused: `set_tolerance` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<SetToleranceCopiesWork>;

struct StatusIsATruthValue : Right {
  template <State Y>
  static bool status(const Workspace<Y>&);
};
// refused: the member `status` of the method would be ignored
template bool const checked<StatusIsATruthValue>;

struct CostsOfEachObject : Right {
  template <State Y>
  EquationCosts costs(const Workspace<Y>&) const;
};
// refused: the member `costs` of the method would be ignored
template bool const checked<CostsOfEachObject>;

struct ErrorOrderOfChangesWork : Right {
  template <State Y>
  static int error_order_of(Workspace<Y>&);
};
// refused: the member `error_order_of` of the method would be ignored
template bool const checked<ErrorOrderOfChangesWork>;

struct NextFactorWithFewArguments : Right {
  template <State Y>
  static double next_factor(Workspace<Y>&, double);
};
// refused: the member `next_factor` of the method would be ignored
template bool const checked<NextFactorWithFewArguments>;

struct NextFactorCopiesWork : Right {
  template <State Y>
  static double next_factor(Workspace<Y>, double, double, const Y&, const Y&, const Weights&);
};
// refused: `next_factor` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<NextFactorCopiesWork>;

struct RejectedWithoutStep : Right {
  template <State Y>
  static void rejected(Workspace<Y>&);
};
// refused: the member `rejected` of the method would be ignored
template bool const checked<RejectedWithoutStep>;

struct RejectedCopiesWork : Right {
  static void rejected(Workspace<X>, const double&);
};
// refused: `rejected` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<RejectedCopiesWork>;

struct PrivateRetaken : Right {
 private:
  template <State Y>
  static void retaken(Workspace<Y>&);
};
// refused: the member `retaken` of the method would be ignored
template bool const checked<PrivateRetaken>;

struct RetakenCopiesWork : Right {
  static void retaken(auto work);
};
// refused: `retaken` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<RetakenCopiesWork>;

struct PrivateMoved : Right {
 private:
  template <State Y>
  static void moved(Workspace<Y>&, const Y&, const Y&);
};
// refused: the member `moved` of the method would be ignored
template bool const checked<PrivateMoved>;

struct MovedCopiesWork : Right {
  static void moved(Workspace<X>, const X&, const X&);
};
// refused: `moved` gets the workspace by value, so that it changes nothing: declare Workspace<X>& work
template bool const checked<MovedCopiesWork>;

struct FinalMethod final : Right {};
// refused: the method is final: remove `final`, so that its optional members can be checked
template bool const checked<FinalMethod>;

// ---- a system that the method is not for

struct ForAccelerations : Right {
  static constexpr bool second_order = true;
};
struct Decay {
  void operator()(double, const X&, X&);
};
// refused: the method is one for q'' = a(t, q): the system must say which components are positions and which velocities
inline constexpr bool with_decay = check_method<ForAccelerations, X, Decay>();

// ---- pairs

struct PairWithoutStiffMethod : Switching<Right, Right> {
  static constexpr std::string_view name = "pair";
};
// refused: the second method of a pair is for stiff systems: it is implicit, and not only for x'' = a(t, x)

}  // namespace continuo::refusals
