// continuo/language/check/views/drawing.cpp
// Plots and drawings: expressions kept for those who show them.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/checker.hpp>

namespace continuo::model::detail {

namespace {

Shape shape_of(ast::ShapeKind kind) {
  switch (kind) {
    case ast::ShapeKind::floor:
      return Shape::floor;
    case ast::ShapeKind::ball:
      return Shape::ball;
    case ast::ShapeKind::spring:
      return Shape::spring;
    case ast::ShapeKind::rod:
      return Shape::rod;
    case ast::ShapeKind::rope:
      return Shape::rope;
    case ast::ShapeKind::arrow:
      return Shape::arrow;
    case ast::ShapeKind::trail:
      return Shape::trail;
    case ast::ShapeKind::box:
      return Shape::box;
    case ast::ShapeKind::text:
      return Shape::text;
  }
  return Shape::ball;
}

}  // namespace

Series Checker::series(const ast::Expression& expression, Scope& scope) {
  const Value value = number_of(expression, scope);
  std::string label = quote(expression.span);
  label = label.substr(1, label.size() - 2);
  return {label, value.node, value.measured.is_known() ? to_text(value.measured.unit) : std::string()};
}

void Checker::make_plots() {
  for (Placed<ast::Plot>& text : plots_) {
    Plot plot{{}, {"t", model_.graph.variable(Layout::time), model_.time_unit}, text.span};
    for (const ast::Expression& curve : text.text->curves) plot.curves.push_back(series(curve, text.scope));
    if (text.text->against) plot.against = series(*text.text->against, text.scope);
    model_.plots.push_back(std::move(plot));
  }
}

NodeId Checker::drawn(const ast::Expression& expression, Scope& scope, bool of_point) {
  const Value value = number_of(expression, scope);
  if (!value.measured.is_known()) return value.node;
  if (of_point && !drawn_in_.is_known()) drawn_in_ = value.measured;
  const auto factor = factor_between(value.measured, drawn_in_);
  return !factor || *factor == 1 ? value.node : model_.graph.multiply(value.node, model_.graph.constant(*factor));
}

DrawArgument Checker::draw_argument(const ast::Expression& expression, Scope& scope, bool of_point) {
  DrawArgument argument;
  if (const auto* text = std::get_if<ast::Text>(&expression.node)) {
    argument.text = text->value;
  } else if (const auto* list = std::get_if<ast::List>(&expression.node)) {
    for (const ast::Expression& item : list->items) argument.numbers.push_back(drawn(item, scope, of_point));
  } else {
    argument.numbers.push_back(drawn(expression, scope, of_point));
  }
  return argument;
}

bool Checker::depends_on_states(const DrawArgument& point) const {
  const auto is_moved = [this](std::uint32_t variable) {
    const std::uint32_t first = model_.layout.states;
    return variable >= first && variable < first + model_.states.size() && !model_.states[variable - first].algebraic;
  };
  return std::ranges::any_of(variables_of(model_.graph, point.numbers), is_moved);
}

void Checker::make_drawings() {
  for (Placed<ast::Draw>& draw : draws_) make_drawing(draw.text->items, draw.scope);
}

void Checker::make_drawing(const std::vector<ast::DrawItem>& items, Scope& scope) {
  for (const ast::DrawItem& item : items) {
    if (const auto* family = std::get_if<ast::DrawFamily>(&item.node)) {
      for_each_index(family->index, family->range, scope, [&] { make_drawing(family->body, scope); });
      continue;
    }
    const ast::Shape& text = std::get<ast::Shape>(item.node);
    DrawItem made{shape_of(text.kind), {}, {}, item.span};
    for (const ast::Expression& argument : text.arguments)
      made.arguments.push_back(draw_argument(argument, scope, true));
    for (const ast::Attribute& attribute : text.attributes) {
      made.attributes.push_back({attribute.name.text, draw_argument(attribute.value, scope, false)});
    }
    if (is_dragged(made) && !depends_on_states(made.arguments.front())) {
      fail("E265", item.span, "there is nothing to drag", "no state moves this point",
           "drag is for a point that depends on the states of the model, as in ball (x, y) drag");
    }
    model_.drawing.push_back(std::move(made));
  }
}

}  // namespace continuo::model::detail
