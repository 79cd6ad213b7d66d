// continuo/simulation/drive/planner.hpp
// The parts of a plan, in the order in which they depend on each other. Whoever moves a model puts them together:
//
//   Planner planner(model, experiment, problems);
//   planner.begin();
//   planner.set_integration();  // or the method and the steps of bodies (worlds/plan_world.hpp)
//   return planner.finish();
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/solve/choice.hpp>

namespace continuo::model {

class Planner {
 public:
  Planner(const Model& model, const Experiment& experiment, std::vector<Diagnostic>& problems)
      : model_(model), experiment_(experiment), run_(model.run), problems_(problems), before_(problems.size()) {}

  /// The parameters, the values at the start and the interval.
  void begin();
  /// The method, its tolerances, its steps and their limits.
  void set_integration();
  /// The output; then the plan, or nothing where one of the parts failed.
  [[nodiscard]] std::optional<Plan> finish();

  /// The plan as far as it is made.
  [[nodiscard]] Plan& plan() { return plan_; }
  /// A problem of this code at the run statement. `overridden`: the experiment asked for it, not the model.
  void fail(const char* code, std::string message, std::string help, bool overridden = false);
  /// The value of a setting of the run statement with the parameters of the experiment; nothing where it is not given.
  [[nodiscard]] std::optional<double> value(const std::optional<Setting>& setting) const;
  /// Whether the experiment names a tolerance.
  [[nodiscard]] bool asks_for_tolerance() const;

 private:
  [[nodiscard]] double value(const Setting& setting) const;
  void check_parameters();
  void set_start();
  void set_interval();
  void set_accuracy();
  void set_limits();
  void set_tolerances();
  void place_by_name(const Overrides& given, std::vector<double>& each);
  void set_method();
  [[nodiscard]] Choice choice() const;
  [[nodiscard]] bool is_banded() const;
  void accept(const MethodInfo& method);
  [[nodiscard]] std::string unpaired() const;
  void set_output();

  const Model& model_;
  const Experiment& experiment_;
  const RunSettings& run_;
  std::vector<Diagnostic>& problems_;
  std::size_t before_;  // so many problems were there before
  Plan plan_;
};

}  // namespace continuo::model
