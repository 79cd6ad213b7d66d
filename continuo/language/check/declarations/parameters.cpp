// continuo/language/check/declarations/parameters.cpp
// Parameters, inputs, unknowns and the named expressions.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r#");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

}  // namespace

/// The comment at the end of the line on which the definition ends.
std::string Checker::comment_beside(Span span) const {
  const int number = source_.place(span.end).line;
  const std::string_view line = source_.line(number);
  bool in_text = false;
  for (std::size_t i = span.end - source_.line_start(number); i < line.size(); ++i) {
    if (line[i] == '"') in_text = !in_text;
    if (line[i] == '#' && !in_text) return trimmed(line.substr(i));
  }
  return {};
}

std::optional<Range> Checker::slider(const Definition& definition, double value) {
  if (!definition.text->range) return std::nullopt;
  const ast::Range& range = *definition.text->range;
  Scope scope = definition.scope;
  Measured wanted = definition.result.measured;
  double factor = 1;
  if (range.unit) {
    const auto unit = unit_of(*range.unit);
    if (!unit) return std::nullopt;
    const auto converted = factor_between(Measured::known(*unit), wanted);
    if (!converted) {
      fail("E201", range.unit->span, "units do not match",
           fmt::format("`{}` is {}, its range {}", definition.name, unit_text(wanted), to_text(*unit)));
      return std::nullopt;
    }
    factor = *converted;
    wanted = Measured::unknown();
  }
  const auto low = constant(*range.first, scope, wanted, "the end of a range");
  const auto high = constant(*range.last, scope, wanted, "the end of a range");
  if (!low || !high) return std::nullopt;
  const Range result{*low * factor, *high * factor};
  if (!(result.low < result.high)) {
    fail("E221", range.span, "the range is empty", fmt::format("{:g} is not below {:g}", result.low, result.high));
  } else if (value < result.low || value > result.high) {
    warn("E290", range.span, fmt::format("`{}` lies outside its range", definition.name),
         fmt::format("its value is {:g}", value));
  }
  return result;
}

void Checker::make_parameters() {
  for (const std::size_t i : parameter_order_) defined(i, definitions_[i].text->name, {});
  const auto place = [&](std::size_t i) { return definitions_[i].variable - model_.layout.parameters; };
  for (const std::size_t i : evaluation_order_) {
    const Definition& definition = definitions_[i];
    if (definition.kind != Definition::Kind::parameter) continue;
    model_.parameter_order.push_back(place(i));
    double& value = registers_[definition.variable];
    value = evaluate(model_.graph, definition.result.node, registers_);
    if (!definition.result.bad && !std::isfinite(value)) {
      fail("E222", definition.value->span, "a parameter must be a finite number", not_finite(value));
    }
  }
  for (const std::size_t i : parameter_order_) {
    const Definition& d = definitions_[i];
    const double value = registers_[d.variable];
    const Measured& measured = d.result.measured;
    model_.parameters.push_back({d.name, d.variable, d.result.node, value,
                                 measured.is_known() ? to_text(measured.unit) : std::string(), slider(d, value),
                                 comment_beside(d.text->span), variables_of(model_.graph, d.result.node).empty(),
                                 d.structural, d.text->name.span});
  }
  check_overrides();
}

/// `structural` is complete only when the whole text has been read.
void Checker::mark_structural() {
  for (const std::size_t i : parameter_order_) {
    model_.parameters[definitions_[i].variable - model_.layout.parameters].structural = definitions_[i].structural;
  }
}

void Checker::check_overrides() {
  for (const auto& [name, value] : overrides_) {
    if (find_parameter(model_, name) != npos) continue;
    std::vector<std::string> names;
    for (const Parameter& parameter : model_.parameters) names.push_back(parameter.name);
    const std::string near = did_you_mean(name, names);
    const std::string all = names.empty() ? "the model has none" : "the parameters are " + listed(names);
    fail("E210", {}, fmt::format("there is no parameter `{}` to set", name), {}, near.empty() ? all : near);
  }
}

void Checker::make_inputs() {
  for (std::size_t i = 0; i < definitions_.size(); ++i) {
    if (definitions_[i].kind != Definition::Kind::input) continue;
    defined(i, definitions_[i].text->name, {});
    const Definition& d = definitions_[i];
    double& value = registers_[d.variable];
    value = evaluate(model_.graph, d.result.node, registers_);
    const Measured& measured = d.result.measured;
    const auto between =
        d.input->interpolation == ast::Interpolation::step ? Table::Between::step : Table::Between::linear;
    const std::string file = d.input->file ? file_of(*d.input->file, d.input->file_span) : std::string();
    auto points = file.empty() ? std::nullopt : points_of(file, d.input->file_span, between, d.name);
    model_.inputs.push_back({d.name, d.variable, value, measured.is_known() ? to_text(measured.unit) : std::string(),
                             slider(d, value), d.input->key.value_or(""), file, std::move(points),
                             comment_beside(d.text->span), d.text->name.span});
  }
}

void Checker::make_unknowns() {
  for (UnknownText& unknown : unknowns_) {
    const Value guess = number_of(unknown.text->guess, unknown.scope);
    unknown.measured = guess.measured.is_known() ? guess.measured : Measured::unknown();
    if (!guess.bad) only_parameters(guess.node, unknown.text->guess.span, "a guess");
    model_.unknowns.push_back({unknown.name, unknown.variable, guess.node,
                               guess.measured.is_known() ? to_text(guess.measured.unit) : std::string(), unknown.span});
  }
}

/// Lets of a mode stand only in its equations and are not named outside.
void Checker::make_quantities() {
  for (std::size_t i = 0; i < definitions_.size(); ++i) {
    const Definition::Kind kind = definitions_[i].kind;
    if (kind == Definition::Kind::parameter || kind == Definition::Kind::input) continue;
    std::vector<std::uint32_t> highest;
    Scope scope;
    scope.highest = &highest;
    Value value = defined(i, definitions_[i].text->name, scope);
    const Definition& d = definitions_[i];
    const bool let = kind == Definition::Kind::let;
    if (let && (value.condition || d.scope.mode != Scope::no_mode)) continue;
    if (let && !highest.empty() && model_.modes.size() > 1) continue;
    value = settle(std::move(value), d.value->span, highest);
    if (value.bad) continue;
    auto& list = let ? model_.lets : kind == Definition::Kind::output ? model_.outputs : model_.energies;
    list.push_back({d.name, value.node, value.measured.is_known() ? to_text(value.measured.unit) : std::string(),
                    d.text->name.span});
  }
  std::vector<std::uint32_t> highest;
  Scope scope;
  scope.highest = &highest;
  const Span span = model_.energies.empty() ? Span{} : model_.energies.front().span;
  Value total = total_energy(span, scope);
  model_.total_energy = settle(std::move(total), span, highest).node;
}

std::string Checker::file_of(const std::string& name, Span span) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(source_.name()).parent_path() / name;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    fail("E270", span, "there is no such file", fmt::format("looked for {}", path.string()),
         "files are found relative to the model's folder");
    return {};
  }
  return path.string();
}

/// The column of this name where the file has one, else the second.
std::optional<Table> Checker::points_of(const std::string& file, Span span, Table::Between between,
                                        std::string_view column) {
  if (file.empty()) return std::nullopt;
  if (!column.empty()) {
    if (ReadTable named = read_table(file, between, {}, column); named.table) return std::move(named.table);
  }
  ReadTable read = read_table(file, between);
  if (!read.table) fail("E272", span, "this file is not a table", read.problem);
  return std::move(read.table);
}

}  // namespace continuo::model::detail
