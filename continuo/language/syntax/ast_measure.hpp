// continuo/language/syntax/ast_measure.hpp
// What of a run a check or a sweep reads; ast.hpp holds the statements.
#pragma once
#include <string>
#include <variant>

#include <continuo/language/syntax/ast_expression.hpp>

namespace continuo::model::ast {

/// When the subject of a check is read.
struct AtTime {
  Expression time;
};
struct AtEnd {};
/// `event 3`, `event 3 of "h falls"`: counted from 1 among the events whose name begins with the text.
struct AtEvent {
  Expression number;
  std::string event;   // empty: all of them
  bool after = false;  // the state after the event's actions; before them by default
};
using Moment = std::variant<AtEnd, AtTime, AtEvent>;

/// What a check looks at.
struct ValueOf {  // `h(1)`, `x^2 + y^2 at 3`, `h at end`, `h' after event 2`; without a moment, the end of the run
  Expression expression;
  Moment moment;
};
struct AlwaysValueOf {  // `always h >= -1e-12`: at every accepted step, output and event
  Expression expression;
};
struct EnergyDrift {};  // `energy drift`: largest |E(t) - E(0)| over the run, relative to |E(0)| where that is not 0
struct TimeOfEvent {    // `time of event 3`, `time of event 3 of "h falls"`
  AtEvent event;
};
struct CountOfEvents {  // `count of events`, `count of "h falls"`
  std::string event;    // empty: all of them
};
struct TimeOfEnd {};  // `time of end`
using Measure = std::variant<ValueOf, AlwaysValueOf, EnergyDrift, TimeOfEvent, CountOfEvents, TimeOfEnd>;

}  // namespace continuo::model::ast
