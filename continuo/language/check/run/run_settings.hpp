// continuo/language/check/run/run_settings.hpp
// `run ...`: the default experiment.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

/// Empty where the text has no `run`.
class RunReader {
 public:
  explicit RunReader(Expressions& expressions) : expressions_(expressions), report_(expressions.report) {}
  [[nodiscard]] RunSettings read();

 private:
  void read_times(const ast::Run& run);
  void read_output(const ast::Run& run);
  void read_tolerances(const ast::Run& run);
  void read_limits(const ast::Run& run);
  void read_method(const ast::Identifier& method);

  Expressions& expressions_;
  Report& report_;
  RunSettings made_;
};

/// What the method and the limits of steps ask of the model; known when the equations are solved.
void check_method_fits(const Model& model, Expressions& expressions);

}  // namespace continuo::model::detail
