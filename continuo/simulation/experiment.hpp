// continuo/simulation/experiment.hpp
// What is asked of a run: the model's `run` statement, item by item overridden by a caller.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/language/text/diagnostic.hpp>

namespace continuo::model {

/// What stands here replaces what the model says. Numbers are in the model's units.
struct Experiment {
  std::optional<std::string> method{};
  std::optional<double> rtol{};    // takes the place of a fixed step
  std::optional<double> step{};    // takes the place of a tolerance
  std::vector<double> atol{};      // empty, one, or one per state
  Overrides rtol_of{}, atol_of{};  // of single states or families of them, by their columns: "x'", "u[3]", "u"
  std::optional<double> from{}, to{};
  std::optional<double> output{};  // a row every so much time
  bool output_steps = false;       // a row at every step
  Overrides parameters{};
  Overrides initial{};  // of single states or families of them, by their columns: "x'", "u[3]", "u"
  std::optional<double> max_step{};
  std::optional<std::size_t> max_steps{};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};  // of conditions at several times: with the part that is done, 0 to 1
  bool estimate_error = false;               // by a second run, a hundred times as strict
  bool doubts = false;                       // Outcome::hint says where errors have grown: see error_estimate.hpp
  bool keep_rows = true;                     // false: only the first and the last state, for sweeps
};

inline constexpr std::size_t usual_max_steps = 10'000'000;

/// The experiment as it will run: nothing is left open.
struct Plan {
  std::string method;
  std::string reason;             // why this one
  double rtol = 0;                // the smallest of them
  std::vector<double> rtol_each;  // one per state where they differ, else empty
  std::vector<double> atol;       // one, or one per state
  double step = 0;                // > 0: fixed, and the tolerances say nothing
  double max_step = std::numeric_limits<double>::infinity();
  std::size_t max_steps = usual_max_steps;  // accepted and rejected together
  double from = 0, to = 0;
  OutputPlan::Kind output = OutputPlan::Kind::steps;
  double interval = 0;            // of Kind::every
  int per_decade = 0;             // of Kind::logarithmic,
  double first = 0;               // and its first time
  std::vector<double> variables;  // the register file at the start
  Overrides initial{};            // what the experiment has put in place of the model's initial values

  /// The relative tolerance of a state.
  [[nodiscard]] double rtol_of(std::size_t state) const { return rtol_each.empty() ? rtol : rtol_each[state]; }
  /// The absolute tolerance of a state, in its unit.
  [[nodiscard]] double atol_of(std::size_t state) const { return atol.size() == 1 ? atol.front() : atol[state]; }
};

/// The limit of steps where nobody gives one: steps of a given size are as many as they are.
[[nodiscard]] std::size_t max_steps_of(const Plan& plan);

/// The plan of an integration from the start, or nothing where `problems` has the reason: E33x, E34x; E321 and E323 for
/// conditions at several times and for bodies, which runs::plan plans as well.
[[nodiscard]] std::optional<Plan> plan(const Model& model, const Experiment& experiment,
                                       std::vector<Diagnostic>& problems);

/// E323: a study of equations does not see collisions.
[[nodiscard]] Diagnostic no_study_of_worlds(const Model& model);

/// E340, E344 with the names that may have been meant.
[[nodiscard]] Diagnostic no_parameter(const Model& model, std::string_view name, Span span);
/// E330, with the name that may have been meant.
[[nodiscard]] Diagnostic no_method(std::string_view name, Span span);
/// E344, with the names that may have been meant.
[[nodiscard]] Diagnostic no_state(const Model& model, std::string_view name, Span span);

/// The times at which rows are wanted, one after the other; infinity when there are no more.
class OutputTimes {
 public:
  /// The times of the plan's rows.
  explicit OutputTimes(const Plan& plan) : plan_(plan) {}
  /// Time number k; infinity behind the last one.
  double operator[](std::size_t k) const;

 private:
  Plan plan_;
};

}  // namespace continuo::model
