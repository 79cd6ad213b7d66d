// continuo/language/check/views/drawing.cpp
// Numbers of points are brought to one unit; families are written out.
#include <algorithm>

#include <continuo/language/check/views/drawing.hpp>

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

NodeId Drawing::drawn(const ast::Expression& expression, Scope& scope, bool of_point) {
  const Value value = expressions_.values.number_of(expression, scope);
  if (!value.measured.is_known()) return value.node;
  if (of_point && !unit_.is_known()) unit_ = value.measured;
  const auto factor = factor_between(value.measured, unit_);
  return !factor || *factor == 1
             ? value.node
             : expressions_.workspace.graph.multiply(value.node, expressions_.workspace.graph.constant(*factor));
}

DrawArgument Drawing::argument_of(const ast::Expression& expression, Scope& scope, bool of_point) {
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

bool Drawing::depends_on_states(const DrawArgument& point) const {
  const auto is_moved = [this](std::uint32_t variable) {
    const std::uint32_t first = expressions_.workspace.layout.states;
    return variable >= first && variable < first + states_.size() && !states_[variable - first].algebraic;
  };
  return std::ranges::any_of(variables_of(expressions_.workspace.graph, point.numbers), is_moved);
}

std::vector<DrawItem> Drawing::make() {
  for (const Placed<ast::Draw>& draw : expressions_.workspace.declared.draws) {
    Scope scope = draw.scope;
    add(draw.text->items, scope);
  }
  return std::move(made_);
}

void Drawing::add(const std::vector<ast::DrawItem>& items, Scope& scope) {
  for (const ast::DrawItem& item : items) {
    if (const auto* family = std::get_if<ast::DrawFamily>(&item.node)) {
      expressions_.indices.for_each_index(family->index, family->range, scope,
                                          [&](std::size_t) { add(family->body, scope); });
    } else {
      add_shape(std::get<ast::Shape>(item.node), item.span, scope);
    }
  }
}

void Drawing::add_shape(const ast::Shape& text, Span span, Scope& scope) {
  DrawItem made{shape_of(text.kind), {}, {}, span};
  for (const ast::Expression& argument : text.arguments) made.arguments.push_back(argument_of(argument, scope, true));
  for (const ast::Attribute& attribute : text.attributes) {
    made.attributes.push_back({attribute.name.text, argument_of(attribute.value, scope, false)});
  }
  if (is_dragged(made) && !depends_on_states(made.arguments.front())) {
    expressions_.report.fail("E265", span, "there is nothing to drag", "no state moves this point",
                             "drag is for a point that depends on the states of the model, as in ball (x, y) drag");
  }
  made_.push_back(std::move(made));
}

}  // namespace continuo::model::detail
