// What a sweep varies, and its values.
#pragma once
#include <optional>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/sweep.hpp>

namespace continuo::model::detail {

class SweepAxes {
 public:
  SweepAxes(Expressions& expressions, const Model& model)
      : expressions_(expressions), report_(expressions.report), model_(model) {}

  /// Nothing after saying what is wrong.
  [[nodiscard]] std::optional<SweepAxis> axis(const ast::SweepAxis& text, Span span);

 private:
  [[nodiscard]] std::optional<Measured> find_subject(const ast::Expression& subject, SweepAxis& axis);
  [[nodiscard]] std::optional<Measured> subject_at_start(const ast::Call& call, Span span, SweepAxis& axis);
  [[nodiscard]] bool is_state_with_start(std::size_t state, Span span);
  std::optional<Measured> cannot_be_varied(Span span, std::string help);
  [[nodiscard]] std::optional<double> number(const ast::Expression& text, const Measured& wanted,
                                             std::string_view what);
  [[nodiscard]] std::optional<SweepPoints> grid(const ast::SweepGrid& text, const Measured& wanted);
  [[nodiscard]] std::optional<SweepPoints> list(const ast::SweepList& text, const Measured& wanted);
  [[nodiscard]] std::optional<SweepPoints> file(const ast::SweepFile& text, const SweepAxis& axis,
                                                const Measured& wanted);
  [[nodiscard]] std::optional<SweepDistribution> distribution(const ast::SweepDistribution& text,
                                                              const Measured& wanted);
  [[nodiscard]] bool is_possible(const SweepDistribution& distribution, Span span);

  Expressions& expressions_;
  Report& report_;
  const Model& model_;
};

}  // namespace continuo::model::detail
