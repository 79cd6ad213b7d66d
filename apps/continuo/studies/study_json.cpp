// Comparisons, convergence and other studies as JSON.
#include <utility>

#include <apps/continuo/studies/study_json.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

using nlohmann::json;

json outcome_json(const Outcome<double>& outcome) {
  json result{{"ending", to_string(outcome.ending)}, {"t", outcome.t}};
  if (!outcome.hint.empty()) result["hint"] = outcome.hint;
  return result;
}

json curve_json(const studies::ErrorCurve& curve) {
  if (!curve.found && !curve.floor_reached) return nullptr;
  json result{{"floor_reached", curve.floor_reached}, {"least_error", curve.least_error}};
  if (curve.found) result.update({{"order", curve.order}, {"standard_error", curve.standard_error}});
  if (curve.best_step > 0) result["best_step"] = curve.best_step;
  return result;
}

json contender_json(const studies::Contender& contender) {
  json result{{"method", contender.method}};
  if (contender.step) result["step"] = *contender.step;
  if (contender.tolerance) result["tolerance"] = *contender.tolerance;
  if (!contender.simulated.run) {
    const auto& problems = contender.simulated.diagnostics;
    result["problem"] = problems.empty() ? "no run" : problems.front().message;
    return result;
  }
  const model::Run& run = *contender.simulated.run;
  result.update({{"final_error", contender.final_error},
                 {"largest_error", contender.largest_error},
                 {"outcome", outcome_json(run.outcome)},
                 {"steps", run.statistics.steps},
                 {"evaluations", run.statistics.evaluations},
                 {"seconds", run.statistics.seconds},
                 {"times", contender.times},
                 {"errors", contender.errors}});
  if (run.energy) result["energy_drift"] = run.energy->drift;
  return result;
}

json curves_json(const std::vector<studies::PlaneCurve>& curves) {
  json list = json::array();
  for (const studies::PlaneCurve& curve : curves) list.push_back(curve);
  return list;
}

}  // namespace

nlohmann::json sensitivity_json(const model::Model& model, const studies::SensitivityRun& run,
                                const std::vector<studies::Influence>& influences) {
  json rows = json::array(), events = json::array(), by = json::array(), states = json::array();
  for (const model::State& state : model.states) states.push_back(state.column);
  for (const studies::Influence& influence : influences) by.push_back(name_of(model, influence));
  for (std::size_t r = 0; r < run.rows(); ++r) {
    json derivatives = json::array();
    for (std::size_t k = 0; k < run.influences; ++k) {
      const auto column = run.row(r).subspan(run.states * (1 + k), run.states);
      derivatives.push_back(std::vector<double>(column.begin(), column.end()));
    }
    const auto x = run.row(r).first(run.states);
    rows.push_back({{"t", run.times[r]}, {"x", std::vector<double>(x.begin(), x.end())}, {"by", derivatives}});
  }
  for (const studies::SensitivityEvent& event : run.events)
    events.push_back({{"name", event.name}, {"t", event.t}, {"time_by", event.time_moves}});
  json result{
      {"states", states}, {"by", by}, {"rows", rows}, {"events", events}, {"outcome", outcome_json(run.outcome)}};
  if (run.has_no_derivative()) result["problem"] = run.status.message;
  return result;
}

nlohmann::json comparison_json(const studies::Comparison& comparison) {
  json contenders = json::array();
  for (const studies::Contender& contender : comparison.contenders) contenders.push_back(contender_json(contender));
  return {{"reference", {{"method", comparison.reference.run->plan.method}, {"tolerance", studies::reference_rtol}}},
          {"contenders", contenders}};
}

nlohmann::json convergence_json(const studies::Convergence& study) {
  json methods = json::array();
  for (const studies::MethodConvergence& method : study.methods) {
    json points = json::array();
    for (const studies::StepErrors& point : method.points) {
      points.push_back({{study.by_tolerance ? "tolerance" : "step", point.step},
                        {"global", point.global},
                        {"local", point.local},
                        {"energy", point.energy},
                        {"in_float", point.in_float},
                        {"in_long_double", point.in_long_double},
                        {"evaluations", point.evaluations},
                        {"seconds", point.seconds}});
    }
    json one{{"method", method.method}, {"points", points}};
    if (method.nominal > 0) one["nominal_order"] = method.nominal;
    for (const auto& [name, curve] : {std::pair{"global", &method.global},
                                      {"local", &method.local},
                                      {"energy", &method.energy},
                                      {"in_float", &method.in_float},
                                      {"in_long_double", &method.in_long_double}})
      if (json read = curve_json(*curve); !read.is_null()) one[name] = std::move(read);
    if (!method.status) one["problem"] = method.status.message;
    methods.push_back(std::move(one));
  }
  json result{{"reference", study.reference}, {"interrupted", study.interrupted}, {"methods", methods}};
  if (study.spoiled) {
    json kinks = json::array();
    for (const studies::Kink& kink : study.spoiled->kinks)
      kinks.push_back({{"text", kink.text}, {"jumps", kink.jumps}, {"times", kink.times}, {"first", kink.first}});
    result["spoiled_by"] = {{"kinks", kinks}, {"events", study.spoiled->events}};
  }
  return result;
}

nlohmann::json differences_json(const std::vector<studies::DifferenceErrors>& study, const std::string& expression,
                                double at) {
  const auto errors_json = [](const studies::ErrorCurve& curve, const studies::Balance& predicted,
                              const std::vector<double>& errors) {
    json result{{"errors", errors}, {"found", curve_json(curve)}, {"predicted", nullptr}};
    if (curve.found && predicted.step > 0) result["predicted"] = {{"step", predicted.step}, {"error", predicted.error}};
    return result;
  };
  json schemes = json::array();
  for (const studies::DifferenceErrors& errors : study)
    schemes.push_back({{"name", errors.scheme.name},
                       {"derivative", errors.scheme.derivative},
                       {"order", errors.scheme.order},
                       {"steps", errors.steps},
                       {"in_double", errors_json(errors.of_double, errors.predicted, errors.in_double)},
                       {"in_float", errors_json(errors.of_float, errors.predicted_in_float, errors.in_float)}});
  return {{"derivative", expression}, {"at", at}, {"schemes", schemes}};
}

nlohmann::json portrait_json(const model::Model& model, const studies::PhasePortrait& portrait,
                             const studies::PhasePlane& plane) {
  json equilibria = json::array(), arrows = json::array();
  for (const studies::Equilibrium& e : portrait.equilibria) {
    json eigenvalues = json::array();
    for (const auto& value : e.eigenvalues) eigenvalues.push_back({value.real(), value.imag()});
    equilibria.push_back({{"x", e.x}, {"stability", to_string(e.stability)}, {"eigenvalues", eigenvalues}});
  }
  for (const studies::FieldArrow& arrow : portrait.field)
    arrows.push_back({{"at", arrow.at}, {"direction", arrow.direction}, {"speed", arrow.speed}});
  return {{"states", {model.states[0].column, model.states[1].column}},
          {"low", plane.low},
          {"high", plane.high},
          {"complete", portrait.complete},
          {"equilibria", equilibria},
          {"nullclines", {curves_json(portrait.nullclines[0]), curves_json(portrait.nullclines[1])}},
          {"separatrices", curves_json(portrait.separatrices)},
          {"motions", curves_json(portrait.motions)},
          {"field", arrows}};
}

}  // namespace continuo::app
