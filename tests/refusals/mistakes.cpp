// Programs with one mistake each, of which the compiler must name the mistake: the text behind `refused:` is a part of
// its first error. Program 0 has none.
#include "user.hpp"

using namespace continuo;
using X = std::array<double, 2>;
using V = std::vector<double>;

namespace {
[[maybe_unused]] const auto f = [](double, const X& x) { return X{x[1], -x[0]}; };
[[maybe_unused]] const auto g = [](double, const X& x) { return x[0]; };
[[maybe_unused]] const X x0{1, 0};
[[maybe_unused]] const auto sensitive = [](auto, const auto& x, const auto& p, auto& dxdt) {
  dxdt[0] = p[0] * x[1];
  dxdt[1] = -p[1] * x[0];
};

struct Base {
  X operator()(double, const X& x) const { return {x[1], -x[0]}; }
};
}  // namespace

#if MISTAKE == 0  // refused:
struct Whole : Base {
  double mass = 1;  // in kilograms
  void jacobian(double, const X&, std::span<double> rows) const { rows[1] = 1; }
};
int main() {
  const auto kept = [](double t, const X&) { return t < 1; };
  const auto floor = falls("floor", g, [](auto& now) { now.x[1] = -now.before[1]; });
  auto stop = rises("stop", g);
  stop.stop_after = 3;
  const auto tick = at("tick", {1, 2}, [](auto&) {});
  const auto beat = every("beat", 0.5, 0, [](EventAction<X>&) {});
  const Options<X> options{.rtol = 1e-9};
  return solve(Whole{}, x0, {0, 1}, Radau{},
               {.events = {floor, stop, tick, beat}, .save = save_at({0.5, 1}).into(kept)})
                     .outcome &&
                 solve(f, x0, {0, 1}, Dop853{}, {.events = {floor.then([](auto& now) { now.stop = true; })}}).outcome &&
                 solve(f, x0, {0, 1}, {.save = save_every(0.5)}).outcome && solve(f, x0, {0, 1}, options).outcome &&
                 solve(f, x0, {0, 1}, Dop853{}, {.events = {falls<X>("named", g)}, .save = Save<X>::dense()}).outcome
             ? 0
             : 1;
}
#elif MISTAKE == 1   // refused: the state has whole numbers as components
int main() {
  return solve(f, std::array{1, 0}, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 2   // refused: the state has complex components
int main() {
  using Z = std::array<std::complex<double>, 1>;
  const auto turn = [](double, const Z& z) { return z; };
  return solve(turn, Z{}, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 3   // refused: one number is std::array{1.0}
int main() {
  const auto decay = [](double, double x) { return -x; };
  return solve(decay, 1.0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 4   // refused: the state must be a std::array
int main() {
  double start[2] = {1, 0};
  return solve(f, start, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 5   // refused: f does not take the time
int main() {
  const auto timeless = [](const X& x) { return X{x[1], -x[0]}; };
  return solve(timeless, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 6   // refused: f has the time as its last argument
int main() {
  const auto odeint = [](const X& x, X& dxdt, double) { dxdt = {x[1], -x[0]}; };
  return solve(odeint, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 7   // refused: it must take it as const X&
int main() {
  const auto writer = [](double, X& x) { return X{x[1], -x[0]}; };
  return solve(writer, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 8   // refused: f can be called neither as dxdt = f(t, x) nor as f(t, x, dxdt)
int main() {
  const auto with_parameters = [](double, const X& x, X& dxdt, const V&) { dxdt = x; };
  return solve(with_parameters, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 9   // refused: f can be called neither as dxdt = f(t, x) nor as f(t, x, dxdt)
int main() {
  const auto scalar = [](double, double x) { return -x; };
  return solve(scalar, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 10  // refused: f(t, x) returns another type than that of the state x0
int main() {
  const auto longer = [](double, const X& x) { return std::array{x[1], -x[0], 0.0}; };
  return solve(longer, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 11  // refused: f takes dxdt by value
int main() {
  const auto copies = [](double, const X& x, X dxdt) { dxdt = {x[1], -x[0]}; };
  return solve(copies, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 12  // refused: f takes dxdt by value
int main() {
  const auto copies = [](auto, const auto& x, auto dxdt) { dxdt[0] = x[1]; };
  return solve(copies, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 13  // refused: f takes dxdt as a constant
int main() {
  const auto reads = [](double, const X&, const X&) {};
  return solve(reads, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 14  // refused: f can be called neither as dxdt = f(t, x) nor as f(t, x, dxdt)
int main() {
  return solve(f, V{1, 0}, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 15  // refused: the member `jacobian` of the system would be ignored
struct Pointer : Base {
  void jacobian(double, const X&, double*) const {}
};
int main() {
  return solve(Pointer{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 16  // refused: the member `mass_matrix` of the system would be ignored: it must be public
class Hidden : public Base {
  void mass_matrix(std::span<double>) const {}
};
int main() {
  return solve(Hidden{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 17  // refused: the member `mass` of the system would be ignored
struct Changing : Base {
  double mass(std::size_t) { return 2; }
};
int main() {
  return solve(Changing{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 18  // refused: the member `jacobian_values` of the system would be ignored
struct Alone : Base {
  void jacobian_values(double, const X&, std::span<double>) const {}
};
int main() {
  return solve(Alone{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 19  // refused: the member `time_derivative` of the system would be ignored
struct Returning : Base {
  X time_derivative(double, const X& x) const { return x; }
};
int main() {
  return solve(Returning{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 20  // refused: the preconditioner of the system would be ignored
struct Half : Base {
  void precondition(X&) const {}
};
int main() {
  return solve(Half{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 21  // refused: the parts of the system would be ignored
struct Part : Base {
  void stiff(double, const X& x, X& dxdt) const { dxdt = x; }
};
int main() {
  return solve(Part{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 22  // refused: the member `spectral_radius` of the system would be ignored
struct Radius : Base {
  static double spectral_radius() { return 1; }
};
int main() {
  return solve(Radius{}, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 23  // refused: the member `autonomous` of the system would be ignored
struct Asked : Base {
  [[nodiscard]] bool autonomous() const { return true; }
};
int main() {
  return solve(Asked{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 24  // refused: the system has two mass matrices
struct Double : Base {
  [[nodiscard]] double mass(std::size_t) const { return 2; }
  void mass_matrix(std::span<double>) const {}
};
int main() {
  return solve(Double{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 25  // refused: the guard returns bool
int main() {
  const auto below = falls("floor", [](double, const X& x) { return x[0] < 0; });
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {below}}).outcome ? 0 : 1;
}
#elif MISTAKE == 26  // refused: the guard returns bool
int main() {
  const auto below = falls<X>("floor", [](double, const X& x) { return x[0] < 0; });
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {below}}).outcome ? 0 : 1;
}
#elif MISTAKE == 27  // refused: the guard returns a whole number
int main() {
  const auto sign = [](double, const X& x) { return x[0] < 0 ? -1 : 1; };
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {crosses("sign", sign)}}).outcome ? 0 : 1;
}
#elif MISTAKE == 28  // refused: a guard is called as g(t, x)
int main() {
  const auto timeless = [](const X& x) { return x[0]; };
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {falls("floor", timeless)}}).outcome ? 0 : 1;
}
#elif MISTAKE == 29  // refused: an action is called with its data by reference
int main() {
  const auto floor = falls("floor", g, [](auto now) { now.stop = true; });
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {floor}}).outcome ? 0 : 1;
}
#elif MISTAKE == 30  // refused: the action returns bool, which has no effect
int main() {
  const auto floor = falls("floor", g, [](auto&) { return true; });
  return solve(f, x0, {0, 1}, Dop853{}, {.events = {floor}}).outcome ? 0 : 1;
}
#elif MISTAKE == 31  // refused: a callback of a run returns nothing, or a bool
int main() {
  const auto call = [](double, const X&) { return 1; };
  return solve(f, x0, {0, 1}, Dop853{}, {.save = save_every_step().into(call)}).outcome ? 0 : 1;
}
#elif MISTAKE == 32  // refused: a callback of a run gets constants
int main() {
  const auto call = [](double, X& x) { x[0] = 0; };
  return solve(f, x0, {0, 1}, Dop853{}, {.save = save_every_step().into(call)}).outcome ? 0 : 1;
}
#elif MISTAKE == 33  // refused: a callback of a run gets constants
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.progress = [](double, double) {}}).outcome ? 0 : 1;
}
#elif MISTAKE == 34  // refused: the method is a text
int main() {
  return solve(f, x0, {0, 1}, "dop853").outcome ? 0 : 1;
}
#elif MISTAKE == 35  // refused: the type is no method
struct Mine {};
int main() {
  return solve(f, x0, {0, 1}, Mine{}).outcome ? 0 : 1;
}
#elif MISTAKE == 36  // refused: rtoll
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.rtoll = 1e-9}).outcome ? 0 : 1;
}
#elif MISTAKE == 37  // refused: Dop853
int main() {
  return solve(f, x0, {0, 1}, Dop853, {.rtol = 1e-9}).outcome ? 0 : 1;
}
#elif MISTAKE == 38  // refused: Interval<
int main() {
  return solve(f, x0, 0, 1, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 39  // refused: solve(f, {1.0, 0.0}
int main() {
  return solve(f, {1.0, 0.0}, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 40  // refused: the numbers of the state have expression templates
int main() {
  using Decimal = std::vector<boost::multiprecision::cpp_dec_float_50>;
  const auto decay = [](const auto&, const Decimal& x, Decimal& dxdt) { dxdt[0] = -x[0]; };
  return solve(decay, Decimal(1, 1), {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 41  // refused: the acceleration is written into a copy
int main() {
  const auto pendulum = [](double, const std::array<double, 1>& q, std::array<double, 1> a) { a[0] = -q[0]; };
  return solve(second_order(pendulum), x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 42  // refused: the method is one for q'' = a(t, q)
int main() {
  return solve(f, x0, {0, 1}, VelocityVerlet{}, {.step = 0.1}).outcome ? 0 : 1;
}
#elif MISTAKE == 43  // refused: Save
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.save = Save::every(0.1)}).outcome ? 0 : 1;
}
#elif MISTAKE == 44  // refused: the members `pair_count` and `pair` of the system would be ignored
struct Unpaired : Base {
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return 1; }
};
int main() {
  return solve(Unpaired{}, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 45  // refused: the member `component_name` of the system would be ignored
struct Naming : Base {
  std::string component_name(std::size_t) { return "x"; }
};
int main() {
  return solve(Naming{}, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 46  // refused: the member `ignores_velocity` of the system would be ignored
struct Ignoring : Base {
  [[nodiscard]] bool ignores_velocity() const { return true; }
};
int main() {
  return solve(Ignoring{}, x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 47  // refused: the member `jacobian_action` of the system would be ignored
struct Product : Base {
  X jacobian_action(double, const X&, const X& v) const { return v; }
};
int main() {
  return solve(Product{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 48  // refused: the member `stiff_jacobian` of the system would be ignored
struct Stiff : Base {
  void stiff_jacobian(double, const X&, std::span<double>) const {}
};
int main() {
  return solve(Stiff{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 49  // refused: the member `has_mass` of the system would be ignored
struct Maybe : Base {
  bool has_mass() { return false; }
};
int main() {
  return solve(Maybe{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 50  // refused: the acceleration is called neither
int main() {
  const auto pendulum = [](std::array<double, 1> q) { return q; };
  return solve(second_order(pendulum), x0, {0, 1}, Dop853{}).outcome ? 0 : 1;
}
#elif MISTAKE == 51  // refused: the member `jacobian` of the system would be ignored
struct Unconst : Base {
  void jacobian(double, X&, std::span<double>) {}
};
int main() {
  const Unconst system;
  return solve(std::ref(system), x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 52  // refused: the member `mass` of the system would be ignored
struct Changing : Base {
  double mass(std::size_t) { return 2; }
};
int main() {
  Integrator integrator(Changing{}, x0, {0, 1}, Radau{});
  return integrator.advance() ? 0 : 1;
}
#elif MISTAKE == 53  // refused: the state has whole numbers as components
int main() {
  return solve(f, std::array{1, 0}, {0, 1}).outcome ? 0 : 1;
}
#elif MISTAKE == 54  // refused: the member `jacobian` of the system would be ignored
struct Writing : Base {
  void jacobian(double, const X&, std::span<double>) {}
};
int main() {
  const Writing system;
  return solve(std::ref(system), x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 55  // refused: the projection takes x by value or as a constant, so that its result is lost
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.projection = [](double, X x) { x[0] = 1; }}).outcome ? 0 : 1;
}
#elif MISTAKE == 56  // refused: a projection moves x itself, and returns nothing, or a bool
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.projection = [](double, X& x) { return x; }}).outcome ? 0 : 1;
}
#elif MISTAKE == 57  // refused: a projection is called as projection(t, x)
int main() {
  return solve(f, x0, {0, 1}, Dop853{}, {.projection = [](X& x) { x[0] = 1; }}).outcome ? 0 : 1;
}
#elif MISTAKE == 58  // refused: the method chooses its order and its step together: it has a controller of its own
#include <continuo/methods/with_controller.hpp>
int main() {
  return solve(f, x0, {0, 1}, with_controller(Radau{}, H211b{})).outcome ? 0 : 1;
}
#elif MISTAKE == 59  // refused: a norm is an empty type that is called as norm(std::span<const Real> errors)
#include <continuo/methods/with_norm.hpp>
struct Sum {
  double operator()(const X& errors) const { return errors[0] + errors[1]; }
};
int main() {
  return solve(f, x0, {0, 1}, with_norm(Dop853{}, Sum{})).outcome ? 0 : 1;
}
#elif MISTAKE == 60  // refused: the adjoint goes back over the steps of Runge-Kutta methods
int main() {
  return solve_for_adjoint(sensitive, x0, x0, {0, 1}, Radau{}).status ? 0 : 1;
}
#elif MISTAKE == 61  // refused: what follows the options must be events as falls
int main() {
  return forward_sensitivities(sensitive, x0, x0, {0, 1}, Dop853{}, {}, falls<X>("named", g)).status ? 0 : 1;
}
#elif MISTAKE == 62  // refused: the guard of an event must take any number type
int main() {
  return forward_sensitivities(sensitive, x0, x0, {0, 1}, Dop853{}, {}, falls("plain", g)).status ? 0 : 1;
}
#elif MISTAKE == 63  // refused: the member `jacobian` would be ignored: with parameters
struct WithoutParameters {
  X operator()(double, const X& x, const X& p) const { return {x[1] * p[0], -x[0]}; }
  void jacobian(double, const X&, std::span<double>) {}
};
int main() {
  return forward_sensitivities(WithoutParameters{}, x0, x0, {0, 1}, Dop853{}).status ? 0 : 1;
}
#elif MISTAKE == 64  // refused: a mass matrix is not supported
struct Heavy {
  X operator()(double, const X& x, const X& p) const { return {x[1] * p[0], -x[0]}; }
  double mass(std::size_t) const { return 2; }
};
int main() {
  return forward_sensitivities(Heavy{}, x0, x0, {0, 1}, Radau{}).status ? 0 : 1;
}
#elif MISTAKE == 65  // refused: an objective has the terms
int main() {
  const auto run = solve_for_adjoint(sensitive, x0, x0, {0, 1}, Dop853{});
  return run.gradient([](auto, const auto& x, auto) { return x[0]; }).status ? 0 : 1;
}
#elif MISTAKE == 66  // refused: where events accumulate the motion has no derivative
int main() {
  const auto floor = falls("floor", [](auto, const auto& x) { return x[0]; }, [](auto& now) { now.x[1] *= -0.5; });
  return forward_sensitivities(sensitive, x0, x0, {0, 1}, Dop853{}, {}, floor.then([](auto&) {})).status ? 0 : 1;
}
#elif MISTAKE == 67  // refused: sensitivities use jacobian
struct Ignored {
  X operator()(double, const X& x, const X& p) const { return {x[1] * p[0], -x[0]}; }
  void time_derivative(double, const X&, X&) {}
};
int main() {
  return forward_sensitivities(Ignored{}, x0, x0, {0, 1}, Dop853{}).status ? 0 : 1;
}
#elif MISTAKE == 68  // refused: the state has a fixed size, and its equations are solved in registers
int main() {
  return solve(f, x0, {0, 1}, Krylov<Radau>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 69  // refused: the method is explicit: it has no linear systems
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, Krylov<Dop853>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 70  // refused: `factor` of the linear solver must return a Status
struct Optimist {
  bool factor(const ShiftedMatrix<V>&) { return true; }
  Status solve(const ShiftedMatrix<V>&, std::span<double>) { return {}; }
};
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, WithSolver<Radau, Optimist>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 71  // refused: the linear solver lacks a public member `solve`
struct Copying {
  Status factor(ShiftedOperator<V>&) { return {}; }
  Status solve(V b) { return b.empty() ? Status{} : Status{}; }
};
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, WithSolver<Radau, Copying>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 72  // refused: `factor` of the linear solver takes both kinds of matrices
struct Anything {
  Status factor(auto&) { return {}; }
  Status solve(auto&, std::span<double>) { return {}; }
};
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, WithSolver<Radau, Anything>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 73  // refused: `factor` of the linear solver takes complex matrices
struct Half {
  Status factor(const ShiftedMatrix<V>&) { return {}; }
  Status factor(const ShiftedMatrix<V, ComplexNumber<double> >&) { return {}; }
  Status solve(const ShiftedMatrix<V>&, std::span<double>) { return {}; }
};
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, WithSolver<Radau, Half>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 74  // refused: the linear solver lacks a public member `factor`
struct Nothing {};
int main() {
  const auto decay = [](double, const V& x) { return x; };
  return solve(decay, V{1, 0}, {0, 1}, WithSolver<Radau, Nothing>{}).outcome ? 0 : 1;
}
#elif MISTAKE == 75  // refused: f has a member that is not that of M^-1 f and would be ignored
struct Patterned : Base {
  SparsePattern pattern;
  const SparsePattern& jacobian_pattern() const { return pattern; }
};
int main() {
  const auto heavy = [](double, const X&, std::span<double> rows) { rows[0] = rows[3] = 2; };
  return solve(with_mass(Patterned{}, heavy), x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 76  // refused: the mass can not be called as mass(t, x, rows)
int main() {
  const auto heavy = [](const X&, std::span<double> rows) { rows[0] = rows[3] = 2; };
  return solve(with_mass(f, heavy), x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#elif MISTAKE == 77  // refused: a mass that depends on t and x is given by with_mass(f, mass)
struct Lagrange : Base {
  void mass_matrix(double, const X&, std::span<double> rows) const { rows[0] = rows[3] = 2; }
};
int main() {
  return solve(Lagrange{}, x0, {0, 1}, Radau{}).outcome ? 0 : 1;
}
#else
#error "there is no such mistake"
#endif
