// continuo/language/syntax/ast_sweep.hpp
// `sweep { ... }` in the syntax tree: many runs of the model, and what is kept of each.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <continuo/language/syntax/ast_expression.hpp>
#include <continuo/language/syntax/ast_measure.hpp>

namespace continuo::model::ast {

/// `from 1 to 10 [N/m] count 50`, with `log` behind it in equal ratios.
struct SweepGrid {
  Range range;
  Expression count;
  bool is_logarithmic = false;
};

/// `in (1, 2, 5) [N/m]`: a List, or one value.
struct SweepList {
  Expression values;
};

/// `normal(0.5, 0.1) [N*s/m]`: a Call, or a Quantity of one.
struct SweepDistribution {
  Expression call;
};

/// `from "samples.csv"`.
struct SweepFile {
  std::string file;
  Span span;
};

/// What is varied, `k` or `x(0)`, and its values.
struct SweepAxis {
  Expression subject;  // a Name, or a Call with the time of an initial value
  std::variant<SweepGrid, SweepList, SweepDistribution, SweepFile> values;
};

/// `runs 10000 sobol seed 7`.
struct SweepRuns {
  Expression count;
  std::optional<Identifier> sampling;
  std::optional<Expression> seed;
};

/// `x at end`, `max(abs(x)) as peak`, `x at 0..10 by 0.1`: of a series the moment of the measure says nothing.
struct SweepKeep {
  struct Times {
    Range range;
    Expression interval;
  };
  Measure measure;
  std::optional<Times> times;
  std::optional<Identifier> name;
  Span span;  // without the name
};

struct SweepKeeps {
  std::vector<SweepKeep> items;
};

struct SweepItem {
  std::variant<SweepAxis, SweepRuns, SweepKeeps> node;
  Span span;
};

struct Sweep {
  std::vector<SweepItem> items;
};

}  // namespace continuo::model::ast
