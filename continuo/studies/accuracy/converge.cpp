// Runs a method with ever smaller steps against the true solution of a problem.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/converge.hpp>

namespace continuo::studies {

namespace {

using LongValues = ConvergenceProblem::LongValues;

// Equations of implicit steps are solved as closely as rounding lets Newton's iteration see that it converges.
constexpr double newton_tolerance = 1e-12;
constexpr double of_rounding = 30;   // errors below so many epsilon are made of it
constexpr std::size_t stations = 8;  // times at which runs are compared, all of them multiples of every step

/// The true solution at the stations, and one step of any size further on from each.
class Truth {
 public:
  Truth(const ConvergenceProblem& problem, const std::atomic<bool>* interrupt)
      : problem_(problem), interrupt_(interrupt) {
    const LongValues start(problem.x0.begin(), problem.x0.end());
    for (std::size_t k = 0; k <= stations && status; ++k)
      states_.push_back(k == 0 ? start : move(states_.back(), time(k - 1), time(k)));
    sizes_.assign(start.size(), 0);
    for (const LongValues& state : states_)
      for (std::size_t i = 0; i < state.size(); ++i) sizes_[i] = std::max(sizes_[i], std::abs(state[i]));
    for (long double& size : sizes_)
      if (!(size > 0)) size = 1;
  }

  Status status{};  // a failure where there is none

  long double time(std::size_t k) const {
    const long double from = problem_.interval.from, to = problem_.interval.to;
    return from + static_cast<long double>(k) * (to - from) / static_cast<long double>(stations);
  }
  const LongValues& at(std::size_t k) const { return states_[k]; }

  /// One step of the size h from station k on. Asked by every method for the same steps.
  const LongValues& after(std::size_t k, double h) {
    const auto [place, is_new] = after_.try_emplace({k, h});
    if (is_new) place->second = move(states_[k], time(k), time(k) + static_cast<long double>(h));
    return place->second;
  }

  template <class Real>
  double error(const std::vector<Real>& x, const LongValues& exact) const {
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto error = static_cast<double>(std::abs(static_cast<long double>(x[i]) - exact[i]) / sizes_[i]);
      worst = error > worst || std::isnan(error) ? error : worst;
    }
    return worst;
  }

 private:
  LongValues move(const LongValues& x, long double from, long double to) {
    if (problem_.exact) return problem_.exact(to);
    // Explicit while it goes, with Radau's methods from where it does not.
    auto solution = strict(x, {from, to});
    if (solution.outcome.ending == Ending::too_many_steps && !stiff_) {
      stiff_ = true;
      solution = strict(x, {from, to});
    }
    if (!succeeded(solution.outcome.ending)) {
      status = {.ending = solution.outcome.ending,
                .message = fmt::format("there is no reference run: {} at t = {}", to_string(solution.outcome.ending),
                                       static_cast<double>(solution.outcome.t))};
      return LongValues(x.size(), std::numeric_limits<long double>::quiet_NaN());
    }
    return solution.final_state();
  }

  Solution<LongValues> strict(const LongValues& x, Interval<long double> interval) const {
    // As far beyond double as the extended format lets one go: its epsilon is 1.1e-19.
    return named_solve<long double>(stiff_ ? "radau" : "verner9", problem_.in_long_double, x, interval,
                                    {.rtol = stiff_ ? 1e-16L : 1e-17L,
                                     .atol = 1e-20L,
                                     .max_steps = 100'000,
                                     .save = Save<LongValues>::only_end(),
                                     .interrupt = interrupt_});
  }

  const ConvergenceProblem& problem_;
  const std::atomic<bool>* interrupt_;
  bool stiff_ = false;
  std::vector<LongValues> states_;
  LongValues sizes_;
  std::map<std::pair<std::size_t, double>, LongValues> after_;
};

/// Numbers of steps of which each run has a multiple of the stations: about 1.4 times as many from one to the next.
std::vector<std::size_t> step_counts(std::size_t most) {
  std::vector<std::size_t> counts;
  for (double per_station = 1; static_cast<double>(stations) * per_station <= static_cast<double>(most);
       per_station *= std::sqrt(2.0)) {
    const std::size_t count = stations * static_cast<std::size_t>(std::lround(per_station));
    if (counts.empty() || counts.back() != count) counts.push_back(count);
  }
  return counts;
}

class Study {
 public:
  Study(const ConvergenceProblem& problem, const ConvergeRequest& request, Truth& truth)
      : problem_(problem), request_(request), truth_(truth) {}

  MethodConvergence of(const std::string& name, std::size_t number) {
    MethodConvergence result{.method = name};
    const MethodInfo* info = find_method(name);
    result.nominal = info == nullptr || !request_.tolerances.empty() ? 0 : info->order_of_fixed_steps;
    if (!request_.tolerances.empty() && info != nullptr && info->error_order == 0) {
      result.status = invalid_input("has no step control; it is studied by steps");
      return result;
    }
    const std::size_t count =
        request_.tolerances.empty() ? step_counts(request_.most_steps).size() : request_.tolerances.size();
    std::size_t beyond = 0;  // points in a row that rounding made worse
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count && beyond < 5 && result.status && !interrupted(); ++i) {
      const StepErrors errors =
          request_.tolerances.empty() ? with_step(name, i, result) : with_tolerance(name, i, result);
      // Five smaller steps that do worse are the floor, if there is an error to speak of.
      beyond = errors.global > least && least < 1e-6 ? beyond + 1 : 0;
      least = std::min(least, std::isnan(errors.global) ? least : errors.global);
      if (result.status) result.points.push_back(errors);
      if (request_.progress)
        request_.progress((static_cast<double>(number) + weight(i + 1, count)) /
                          static_cast<double>(request_.methods.size()));
    }
    read(result);
    return result;
  }

  bool interrupted() const { return request_.interrupt != nullptr && request_.interrupt->load(); }

 private:
  /// The part of the work that is done: the number of steps doubles with every second point.
  double weight(std::size_t done, std::size_t count) const {
    if (!request_.tolerances.empty()) return static_cast<double>(done) / static_cast<double>(count);
    return std::pow(2.0, (static_cast<double>(done) - static_cast<double>(count)) / 2);
  }
  StepErrors with_step(const std::string& name, std::size_t i, MethodConvergence& result) {
    const std::size_t steps = step_counts(request_.most_steps)[i];
    const double h = (problem_.interval.to - problem_.interval.from) / static_cast<double>(steps);
    StepErrors errors{.step = h,
                      .global = not_measured,
                      .local = not_measured,
                      .energy = not_measured,
                      .in_float = not_measured,
                      .in_long_double = not_measured};
    run<double>(name, problem_.system, {.rtol = newton_tolerance, .atol = newton_tolerance, .step = h}, steps, errors,
                result);
    if (!result.status) return errors;
    errors.local = local_error(name, h);
    if (request_.in_long_double && problem_.in_long_double.size > 0) {
      MethodConvergence ignored{.method = name};
      StepErrors longer = errors;
      const auto length =
          static_cast<long double>(problem_.interval.to) - static_cast<long double>(problem_.interval.from);
      run<long double>(name, problem_.in_long_double,
                       {.rtol = 1e-16L, .atol = 1e-17L, .step = length / static_cast<long double>(steps)}, steps,
                       longer, ignored);
      errors.in_long_double = longer.global;
    }
    if (request_.in_float && problem_.in_float.size > 0) {
      MethodConvergence ignored{.method = name};
      StepErrors of_float = errors;
      run<float>(name, problem_.in_float, {.rtol = 1e-6F, .atol = 1e-7F, .step = static_cast<float>(h)}, steps,
                 of_float, ignored);
      errors.in_float = of_float.global;
    }
    return errors;
  }

  StepErrors with_tolerance(const std::string& name, std::size_t i, MethodConvergence& result) {
    const double tolerance = request_.tolerances[i];
    StepErrors errors{.step = tolerance,
                      .global = not_measured,
                      .local = not_measured,
                      .energy = not_measured,
                      .in_float = not_measured,
                      .in_long_double = not_measured};
    run<double>(name, problem_.system, {.rtol = tolerance, .atol = tolerance}, 0, errors, result);
    return errors;
  }

  /// A whole run, compared at the stations: every so many steps, without steps by dense output.
  template <class Real>
  void run(const std::string& name, const NamedSystem<Real>& system, Options<std::vector<Real>> options,
           std::size_t steps, StepErrors& errors, MethodConvergence& result) {
    const std::vector<Real> start(problem_.x0.begin(), problem_.x0.end());
    const Interval<Real> interval{static_cast<Real>(problem_.interval.from), static_cast<Real>(problem_.interval.to)};
    double worst = 0, worst_energy = 0;
    std::size_t taken = 0, station = 0;
    if (steps == 0)
      for (std::size_t k = 0; k <= stations; ++k) options.save.times.push_back(static_cast<Real>(truth_.time(k)));
    options.save.kind = steps == 0 ? Save<std::vector<Real>>::Kind::times : Save<std::vector<Real>>::Kind::steps;
    options.save.callback = [&](Real, const std::vector<Real>& x) {
      if (steps > 0 && taken++ % (steps / stations) != 0) return;
      if (station > stations) return;
      const double error = truth_.error(x, truth_.at(station));
      worst = error > worst || std::isnan(error) ? error : worst;
      if (problem_.energy) worst_energy = std::max(worst_energy, energy_error(x, station));
      ++station;
    };
    options.interrupt = request_.interrupt;
    const auto solution = named_solve<Real>(name, system, start, interval, options);
    if (solution.outcome.ending == Ending::invalid_input) result.status = invalid_input(solution.outcome.hint);
    errors.evaluations = solution.statistics.evaluations;
    errors.seconds = solution.statistics.seconds;
    if (!succeeded(solution.outcome.ending)) return;
    errors.global = worst;
    if (problem_.energy) errors.energy = worst_energy;
  }

  template <class Real>
  double energy_error(const std::vector<Real>& x, std::size_t station) {
    const std::vector<double> here(x.begin(), x.end()), exact(truth_.at(station).begin(), truth_.at(station).end());
    const auto t = static_cast<double>(truth_.time(station));
    const double wanted = problem_.energy(t, exact);
    double size = std::abs(wanted);
    for (std::size_t k = 0; k <= stations; ++k) {
      const std::vector<double> state(truth_.at(k).begin(), truth_.at(k).end());
      size = std::max(size, std::abs(problem_.energy(static_cast<double>(truth_.time(k)), state)));
    }
    return std::abs(problem_.energy(t, here) - wanted) / (size > 0 ? size : 1);
  }

  /// One step from each station, all but the last.
  double local_error(const std::string& name, double h) {
    double worst = 0;
    for (std::size_t k = 0; k < stations; ++k) {
      const std::vector<double> start(truth_.at(k).begin(), truth_.at(k).end());
      const auto t = static_cast<double>(truth_.time(k));
      const auto solution = named_solve<double>(name, problem_.system, start, {t, t + h},
                                                {.rtol = newton_tolerance, .atol = newton_tolerance, .step = h});
      if (!succeeded(solution.outcome.ending)) return not_measured;
      const double error = truth_.error(solution.final_state(), truth_.after(k, h));
      worst = error > worst || std::isnan(error) ? error : worst;
    }
    return worst;
  }

  void read(MethodConvergence& result) const {
    std::vector<double> steps;
    for (const StepErrors& point : result.points) steps.push_back(point.step);
    const auto curve = [&](double StepErrors::* error, double epsilon) {
      std::vector<double> errors;
      for (const StepErrors& point : result.points) errors.push_back(point.*error);
      return read_errors(steps, errors, of_rounding * epsilon);
    };
    constexpr double of_double = std::numeric_limits<double>::epsilon(),
                     of_float = std::numeric_limits<float>::epsilon();
    result.global = curve(&StepErrors::global, of_double);
    result.local = curve(&StepErrors::local, of_double);
    result.energy = curve(&StepErrors::energy, of_double);
    result.in_float = curve(&StepErrors::in_float, of_float);
    // A reference run is as good as its tolerance, a closed form as the numbers.
    result.in_long_double =
        curve(&StepErrors::in_long_double,
              problem_.exact ? static_cast<double>(std::numeric_limits<long double>::epsilon()) : 3e-18);
    if (!request_.tolerances.empty() || !result.global.found) return;
    result.floor = predict(result.global, of_double);
    result.floor_in_float = predict(result.global, of_float);
  }

  FloorPrediction predict(const ErrorCurve& method, double epsilon) const {
    const double length = std::abs(problem_.interval.to - problem_.interval.from);
    return {balance(method.constant, method.order, epsilon / 2 * std::sqrt(length / 3), 0.5),
            balance(method.constant, method.order, epsilon / 2 * length, 1)};
  }

  const ConvergenceProblem& problem_;
  const ConvergeRequest& request_;
  Truth& truth_;
};

}  // namespace

Result<Convergence> converge(const ConvergenceProblem& problem, const ConvergeRequest& request) {
  Convergence result{.by_tolerance = !request.tolerances.empty()};
  Truth truth(problem, request.interrupt);
  result.reference = problem.exact ? "the closed form" : "a strict run in long double";
  if (!truth.status) return truth.status;
  Study study(problem, request, truth);
  for (std::size_t i = 0; i < request.methods.size() && !study.interrupted(); ++i)
    result.methods.push_back(study.of(request.methods[i], i));
  result.interrupted = study.interrupted();
  return result;
}

}  // namespace continuo::studies
