// continuo/language/check/expressions/expressions.hpp
// All that turns the text of an expression into a node of the model's graph. Passes use it so:
//
//   Scope scope = check.scope;
//   const Value value = expressions.values.number_of(check.text->value, scope);
//   if (!value.bad) ... value.node, value.measured
#pragma once
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include <continuo/language/check/expressions/calls.hpp>
#include <continuo/language/check/expressions/definition_values.hpp>
#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/expressions/lookup.hpp>
#include <continuo/language/check/expressions/operations.hpp>
#include <continuo/language/check/expressions/state_units.hpp>
#include <continuo/language/check/expressions/translator.hpp>
#include <continuo/language/check/expressions/values.hpp>
#include <continuo/language/check/expressions/world_expressions.hpp>
#include <continuo/language/check/names/declarations.hpp>
#include <continuo/language/check/names/report.hpp>
#include <continuo/language/check/names/time_unit.hpp>

namespace continuo::model::detail {

/// What expressions read and what is found out about names on the way; one for each check.
struct Workspace {
  Workspace(const Declarations& all_declared, const TimeUnit& time_unit, const Overrides& set, Model& made,
            Report& report_to)
      : declared(all_declared),
        time(time_unit),
        overrides(set),
        graph(made.graph),
        layout(made.layout),
        run(made.run),
        report(report_to) {}
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  const Declarations& declared;
  const TimeUnit& time;
  const Overrides& overrides;
  Graph& graph;
  Layout& layout;          // samples are added to it
  const RunSettings& run;  // empty until it is made
  Report& report;
  const WorldExpressions* world = nullptr;

  DefinitionValues definitions{*this};
  ConditionValues conditions{*this};
  StateUnits units{*this};
  std::vector<double> registers{};        // parameters and inputs as written, the rest 0
  std::vector<Measured> unknown_units{};  // by number, as their guesses state them
  std::vector<NodeId> solved{};           // highest derivative of each base where the model has one mode; empty before
  std::size_t written_out = 0;            // members of families and terms of sums so far
  std::deque<Index> kept_indices{};       // of the statements that stand in families
  std::unordered_map<std::uint32_t, Choice> choices{};  // conditions of parameters, by node
};

/// The translators, reporting to one report: that of the check, or a silent one for a trial.
class Expressions {
 public:
  explicit Expressions(Workspace& of_check) : Expressions(of_check, of_check.report) {}
  Expressions(Workspace& of_check, Report& report_to)
      : workspace(of_check), report(report_to), operations(of_check.graph, report_to) {}
  Expressions(const Expressions&) = delete;
  Expressions& operator=(const Expressions&) = delete;

  Workspace& workspace;
  Report& report;
  Operations operations;
  Indices indices{*this};
  Lookup lookup{*this};
  Calls calls{*this};
  Translator translator{*this};
  Values values{*this};
};

/// "h'", "k", "t": for messages, also before the states are named.
[[nodiscard]] std::string name_of_variable(const Workspace& workspace, std::uint32_t variable);

}  // namespace continuo::model::detail
