// `sweep { ... }`: what is varied, how many runs there are, and what is kept of each.
#pragma once
#include <memory>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/sweep.hpp>

namespace continuo::model::detail {

class SweepReader {
 public:
  /// `model`: all of it but the sweep.
  SweepReader(Expressions& expressions, const Model& model)
      : expressions_(expressions), report_(expressions.report), model_(model) {}

  /// Null where the text has none.
  [[nodiscard]] std::shared_ptr<const SweepPlan> read();

 private:
  void read_axis(const ast::SweepAxis& text, Span span);
  void read_runs(const ast::SweepRuns& text, Span span);
  void read_keeps(const ast::SweepKeeps& text);
  void read_keep(const ast::SweepKeep& text);
  [[nodiscard]] bool read_extreme(const ast::SweepKeep& text, Scope& scope, SweepKeep& keep);
  [[nodiscard]] bool read_times(const ast::SweepKeep::Times& text, Scope& scope, SweepKeep& keep);
  void add(SweepKeep keep);
  void keep_last_states();
  void count_runs();

  Expressions& expressions_;
  Report& report_;
  const Model& model_;
  SweepPlan made_;
  bool has_keeps_ = false;
  Span runs_span_{};
};

}  // namespace continuo::model::detail
