// continuo/simulation/check_derivatives.cpp
// Compares the derivatives of a model with differences at points spread over a run.
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/simulation/check_derivatives.hpp>
#include <continuo/simulation/drive/model_method.hpp>
#include <continuo/simulation/program/model_events.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/system/check_jacobian.hpp>

namespace continuo::model {

namespace {

using X = ModelSystem::X;

struct Point {
  double t;
  X x;
  ModelSystem system;  // in its mode
};

/// Moments spread over a run of unknown length: where there are too many, every second goes.
class Points {
 public:
  void add(double t, const X& x, const ModelSystem& system) {
    for (std::size_t i = 0; i < x.size(); ++i) sizes_[i] = std::max(sizes_[i], std::abs(x[i]));
    if (seen_++ % stride_ != 0) return;
    kept_.push_back({t, x, system});
    if (kept_.size() < most) return;
    for (std::size_t k = 0; k < kept_.size(); k += 2) std::swap(kept_[k / 2], kept_[k]);
    kept_.erase(kept_.begin() + most / 2, kept_.end());
    stride_ *= 2;
  }

  explicit Points(std::size_t states) : sizes_(states, 0.0) {}
  std::vector<Point>& kept() { return kept_; }
  const X& sizes() const { return sizes_; }

 private:
  static constexpr std::size_t most = 32;  // even
  std::vector<Point> kept_;
  X sizes_;  // the largest of each state
  std::size_t seen_ = 0, stride_ = 1;
};

Points points_of(const std::shared_ptr<const ModelProgram>& program, const Plan& plan, const Experiment& experiment) {
  constexpr std::size_t most_steps = 2000;
  const Model& model = program->model;
  const auto first = plan.variables.begin() + model.layout.states;
  X x0(first, first + static_cast<std::ptrdiff_t>(model.states.size()));
  Options<X> options{.rtol = plan.rtol, .atol = plan.rtol};
  options.max_steps = most_steps;
  options.interrupt = experiment.interrupt;
  Integrator integrator(ModelSystem(program, plan.variables), std::move(x0), {plan.from, plan.to},
                        model_method<Rodas5P>().method, std::move(options),
                        ModelEvents(*program, plan.variables, plan.from));
  Points points(model.states.size());
  points.add(integrator.t(), integrator.x(), integrator.system());
  while (integrator.advance()) points.add(integrator.t(), integrator.x(), integrator.system());
  return points;
}

/// The largest of each component of f.
X rates_at(std::vector<Point>& points) {
  X rates(points.front().x.size(), 0.0), now = rates;
  for (Point& point : points) {
    point.system(point.t, point.x, now);
    for (std::size_t i = 0; i < now.size(); ++i) rates[i] = std::max(rates[i], std::abs(now[i]));
  }
  return rates;
}

DerivativeEntry named(const Point& point, const continuo::JacobianEntry<double>& entry) {
  return {.name = entry_name(point.system, entry, point.x.size()),
          .mode = point.system.model().modes[point.system.mode()].name,
          .t = point.t,
          .exact = entry.given,
          .measured = entry.measured,
          .below = entry.below,
          .above = entry.above,
          .apart = entry.apart};
}

/// Each entry once.
void keep(std::vector<DerivativeEntry>& kept, DerivativeEntry entry, bool worst) {
  const auto found = std::ranges::find_if(
      kept, [&](const DerivativeEntry& other) { return other.name == entry.name && other.mode == entry.mode; });
  if (found == kept.end()) {
    kept.push_back(std::move(entry));
  } else if (worst && entry.apart > found->apart) {
    *found = std::move(entry);
  }
}

void add(Point& point, const JacobianCheck<double>& check, DerivativeReport& report) {
  ++report.points;
  report.compared += check.compared;
  for (const auto& entry : check.wrong) keep(report.wrong, named(point, entry), true);
  for (const auto& entry : check.kinks) keep(report.kinks, named(point, entry), false);
  for (const auto& entry : check.undecided) keep(report.undecided, named(point, entry), false);
  for (const auto& entry : check.right) {
    if (!report.furthest || entry.apart > report.furthest->apart) report.furthest = named(point, entry);
  }
}

}  // namespace

std::optional<DerivativeReport> check_derivatives(const std::shared_ptr<const ModelProgram>& program,
                                                  const Experiment& experiment, std::vector<Diagnostic>& problems) {
  constexpr double rtol = 1e-4;  // any states near the motion will do
  Experiment wanted = experiment;
  wanted.method = Rodas5P::name;
  wanted.step.reset();
  wanted.rtol = rtol;
  const auto planned = plan_run(*program, wanted, problems);
  if (!planned) return std::nullopt;

  Points points = points_of(program, *planned, experiment);
  DerivativeReport report;
  report.states = program->model.states.size();
  report.from = points.kept().front().t;
  report.to = points.kept().back().t;
  const JacobianCheckOptions<double> options{
      .sizes = points.sizes(),
      .rates = rates_at(points.kept()),
      .time = report.to - report.from,
      .by_time = program->linear_inputs.empty()};  // else df/dt is a difference itself
  for (Point& point : points.kept()) {
    add(point, check_jacobian(point.system, point.t, point.x, options), report);
    report.interrupted = experiment.interrupt != nullptr && experiment.interrupt->load();
    if (report.interrupted) break;
  }
  const SparsePattern& pattern = points.kept().front().system.jacobian_pattern();
  report.entries = pattern.entries();
  report.band = pattern.bandwidth();
  std::ranges::sort(report.wrong, std::greater(), &DerivativeEntry::apart);
  return report;
}

}  // namespace continuo::model
