// Runs of foreign systems: the driver, and the method by its name.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <continuo/foreign/foreign_run.hpp>
#include <continuo/foreign/methods/foreign_method.hpp>
#include <continuo/methods/all.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/solve/steps/first_step.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {
namespace {

using X = std::vector<double>;

template <class System>
class Run final : public ForeignRun {
 public:
  Run(System system, X x0, Interval<double> interval, AnyMethod<System, X> method, Options<X> options,
      std::size_t evaluations)
      : integrator_(std::move(system), std::move(x0), interval, method, std::move(options)),
        evaluations_before_(evaluations) {}

  bool advance(ForeignRecord& record) override {
    const bool goes_on = integrator_.advance(record);
    record.step(integrator_.t(), integrator_.x(), integrator_.outcome().ending == Ending::stopped_by_event);
    return goes_on;
  }
  bool advance() override { return integrator_.advance(); }
  [[nodiscard]] double t() const override { return integrator_.t(); }
  [[nodiscard]] const X& x() const override { return integrator_.x(); }
  [[nodiscard]] const Outcome<double>& outcome() const override { return integrator_.outcome(); }
  [[nodiscard]] Statistics statistics() const override {
    Statistics statistics = integrator_.statistics();
    statistics.evaluations += evaluations_before_;
    return statistics;
  }
  [[nodiscard]] std::span<const X> dense_output() override { return integrator_.dense_output(); }
  [[nodiscard]] double step_begin() const override { return integrator_.step_begin(); }
  [[nodiscard]] double step_size() const override { return integrator_.step_size(); }
  void at(double t, X& x) override { integrator_.at(t, x); }
  void set_state(const X& x) override { integrator_.set_state(x); }
  void restart() override {
    integrator_.change_system([](System&) {});
  }
  void extend_to(double to) override { integrator_.extend_to(to); }

 private:
  Integrator<System, X, AnyMethod<System, X>> integrator_;
  std::size_t evaluations_before_;
};

// BDF begins with order 1: a first step for its greatest order would be rejected, and cost a Jacobian more. It is half
// of what is proposed for that order, as the error of the first steps is carried on. Returns the number of evaluations.
template <class System>
[[nodiscard]] std::size_t set_first_step(System system, const X& x0, const Interval<double>& interval,
                                         Options<X>& options) {
  if (options.first_step > 0 || options.step > 0 || has_mass<X>(system)) return 0;
  const double forward = interval.to < interval.from ? -1 : 1;
  const double longest = std::min(std::abs(interval.to - interval.from), options.max_step);
  X slope = x0, scratch = x0, further = x0;
  evaluate(system, interval.from, x0, slope);
  if (!detail::is_finite_state(slope)) return 1;  // the run says what is wrong
  options.first_step = 0.5 * std::abs(first_step(system, interval.from, x0, slope, 1, forward, longest,
                                                 tolerance_of(options), scratch, further));
  return 2;
}

using MethodsWithMatrix = std::tuple<Rodas5P, Radau5, Radau, Bdf>;

template <class Methods, class System>
[[nodiscard]] ForeignRun::Pointer begin(std::string_view name, std::shared_ptr<const ForeignFunctions> functions, X x0,
                                        Interval<double> interval, Options<X> options) {
  AnyMethod<System, X> method{nullptr};
  for_each_method<Methods>([&]<class M>() {
    if (M::name == name) method = foreign_method<M, System>();
  });
  if (!method.begin) return nullptr;
  System system(std::move(functions));
  const std::size_t evaluations = name == Bdf::name ? set_first_step(system, x0, interval, options) : 0;
  return std::make_unique<Run<System>>(std::move(system), std::move(x0), interval, method, std::move(options),
                                       evaluations);
}

}  // namespace

void ForeignDense::add(double begin, double end, double origin, double h, std::span<const X> terms, const X& x) {
  pieces.push_back({begin, end, origin, h, size == 0 ? 0 : coefficients.size() / size, terms.size()});
  for (const X& term : terms) coefficients.insert(coefficients.end(), term.begin(), term.end());
  ends.insert(ends.end(), x.begin(), x.end());
}

void ForeignDense::add_constant(double begin, double end, const X& x) {
  size = x.size();
  add(begin, end, begin, 1, std::span(&x, 1), x);
}

void ForeignDense::evaluate(std::size_t piece, double t, double* x) const {
  const Piece& of = pieces[piece];
  if (t == of.end) {
    std::copy_n(ends.data() + piece * size, size, x);
    return;
  }
  const double theta = (t - of.origin) / of.h;
  const double* c = coefficients.data() + (of.first + of.terms - 1) * size;
  std::copy_n(c, size, x);
  for (std::size_t j = of.terms - 1; j-- > 0;) {
    c -= size;
    for (std::size_t i = 0; i < size; ++i) x[i] = x[i] * theta + c[i];
  }
}

ForeignRun::Pointer begin_foreign_run(std::shared_ptr<const ForeignFunctions> functions, X x0,
                                      Interval<double> interval, std::string_view method, Options<X> options) {
  const std::string_view name = canonical_name(method);
  if (!functions->mass_rows.empty())
    return begin<MethodsWithMatrix, ForeignSystemWithMatrix>(name, std::move(functions), std::move(x0), interval,
                                                             std::move(options));
  return begin<PlainMethods, ForeignSystem>(name, std::move(functions), std::move(x0), interval, std::move(options));
}

bool solves_with_matrix(std::string_view method) {
  bool solves = false;
  for_each_method<MethodsWithMatrix>([&]<class M>() { solves = solves || M::name == canonical_name(method); });
  return solves;
}

}  // namespace continuo
