// continuo/language/check/check.cpp
// The order of the checks; each step needs what those before it found.
#include <algorithm>
#include <filesystem>
#include <tuple>

#include <fmt/format.h>

#include <continuo/language/check/check.hpp>
#include <continuo/language/check/names/checker.hpp>

namespace continuo::model {

Checked check(const ast::Model& tree, const Source& source, const CheckOptions& options) {
  return detail::Checker(tree, source, options.overrides).run();
}

namespace detail {

Checker::Checker(const ast::Model& tree, const Source& source, const Overrides& overrides)
    : tree_(tree), source_(source), overrides_(overrides) {
  model_.name = tree.name ? tree.name->text : std::filesystem::path(source.name()).stem().string();
  model_.heading = tree.heading;
  model_.text = {source.name(), source.text()};
}

Checked Checker::run() {
  declare();
  if (bases_.empty()) {
    if (errors_ == 0) nothing_to_simulate();
  } else if (written_out_ <= most_written_out) {  // else it is too large to go on
    fill();
  }
  std::ranges::sort(diagnostics_, {}, [](const Diagnostic& d) { return std::tie(d.span.begin, d.span.end, d.code); });
  Checked result;
  if (errors_ == 0) result.model = std::move(model_);
  result.diagnostics = std::move(diagnostics_);
  return result;
}

/// Names, families, orders, places.
void Checker::declare() {
  declare_modes();
  declare_top_level();
  Scope scope;
  find_time_unit();
  declare_world();
  walk(tree_.statements, scope, false);
  declare_measures();
  lay_out();
}

void Checker::fill() {
  for (std::size_t i = 0; i < conditions_.size(); ++i) bases_[conditions_[i].base].conditions.push_back(i);
  make_parameters();
  make_inputs();
  for (std::size_t i = 0; i < conditions_.size(); ++i) condition_value(i);
  measure_world();
  name_states();
  make_world();
  make_unknowns();
  for (std::size_t i = 0; i < definitions_.size(); ++i) defined(i, definitions_[i].text->name, {});
  make_run();
  make_conditions();
  make_equations();
  pair_up();
  make_forces();
  make_quantities();
  if (start_) model_.start_mode = mode_named(start_->mode).value_or(0);
  make_events();
  make_plots();
  make_drawings();
  make_checks();
  append_unknowns();
  check_method_fits();
  mark_structural();
  look_at_groups();
  if (world_.text && errors_ == 0) look_at_start();
  if (world_.text) model_.world = std::make_shared<const WorldDescription>(std::move(world_.made));
}

void Checker::nothing_to_simulate() {
  const auto size = static_cast<std::uint32_t>(source_.text().size());
  const bool blank = tree_.statements.empty();
  fail("E280", {0, std::min(size, 1u)}, blank ? "the model is empty" : "the model has nothing that moves", {},
       "write an equation and a start, as in x' = -x and x(0) = 1");
}

}  // namespace detail
}  // namespace continuo::model
