// Reads a text into parts that say on which indices they depend, and makes those again whose indices have changed.
#include <algorithm>
#include <bit>
#include <cmath>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/expressions/family_translator.hpp>
#include <continuo/language/check/names/functions.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::size_t members_before = 4;  // that are translated as any text: small families gain nothing

/// Which of these indices a text names, and whether it has names with indices of their own.
struct Mentions {
  bool index = false, indexed_name = false, other = false;
};

void look_at(const ast::Expression& text, const std::vector<std::string_view>& indices, Mentions& found);

void look_at(const ast::Name& name, const std::vector<std::string_view>& indices, Mentions& found) {
  if (!name.member.empty()) found.other = true;
  if (!name.indices.empty()) found.indexed_name = true;
  if (std::ranges::find(indices, name.text) != indices.end()) found.index = true;
  for (const ast::Expression& index : name.indices) look_at(index, indices, found);
}

void look_at(const ast::Expression& text, const std::vector<std::string_view>& indices, Mentions& found) {
  const auto visit = [&](const ast::Expression& part) { look_at(part, indices, found); };
  if (const auto* name = std::get_if<ast::Name>(&text.node)) return look_at(*name, indices, found);
  if (const auto* unary = std::get_if<ast::Unary>(&text.node)) return visit(*unary->operand);
  if (const auto* binary = std::get_if<ast::Binary>(&text.node)) {
    visit(*binary->left);
    return visit(*binary->right);
  }
  if (const auto* call = std::get_if<ast::Call>(&text.node)) {
    if (!find_function(call->callee.text) || !call->callee.indices.empty()) found.other = true;
    std::ranges::for_each(call->arguments, visit);
    return;
  }
  if (const auto* quantity = std::get_if<ast::Quantity>(&text.node)) return visit(*quantity->value);
  if (!std::holds_alternative<ast::Number>(text.node)) found.other = true;
}

Mentions mentions_of(const ast::Expression& text, const std::vector<std::string_view>& indices) {
  Mentions found;
  look_at(text, indices, found);
  return found;
}

std::optional<Op> arithmetic(ast::BinaryOperator op) {
  constexpr std::array all = {Op::add, Op::subtract, Op::multiply, Op::divide, Op::power};
  const Op found = operation_of(op);
  return std::ranges::find(all, found) != all.end() ? std::optional(found) : std::nullopt;
}

bool are_same(const Measured& a, const Measured& b) {
  return a.kind == b.kind && (!a.is_known() || a.unit == b.unit);
}

}  // namespace

Value FamilyTranslator::translate(const Expressions& expressions, const ast::Expression& text, Scope& scope) {
  if (!scope.innermost || is_busy_) return expressions.translator.translate(text, scope);
  is_busy_ = true;
  Value value = translate_member(expressions, text, scope);
  is_busy_ = false;
  return value;
}

Value FamilyTranslator::translate_member(const Expressions& expressions, const ast::Expression& text, Scope& scope) {
  if (text_ != &text || mode_ != scope.mode) begin(text, scope);
  if (is_given_up_ || ++members_ < members_before) return expressions.translator.translate(text, scope);
  if (members_ > members_before) return translate_path(expressions, text, scope);
  const std::size_t errors = expressions.report.errors(), highest = scope.highest ? scope.highest->size() : 0;
  Value value = expressions.translator.translate(text, scope);
  std::optional<Part> root;
  const bool is_plain = !scope.highest || scope.highest->size() == highest;
  if (is_plain && !value.bad && !value.condition && expressions.report.errors() == errors)
    root = read(expressions, text, scope);
  is_given_up_ = !root || expressions.report.errors() != errors;
  root_ = root.value_or(0);
  return value;
}

void FamilyTranslator::begin(const ast::Expression& text, const Scope& scope) {
  *this = {};
  is_busy_ = true;
  text_ = &text;
  mode_ = scope.mode;
  for (const Index* index = scope.innermost; index; index = index->outer) names_.push_back(index->name);
  is_given_up_ = names_.size() > most_indices;
}

/// The first member of each path goes through the translator as well: the two must agree.
Value FamilyTranslator::translate_path(const Expressions& expressions, const ast::Expression& text, Scope& scope) {
  note_indices(scope);
  choices_ = 0;
  const std::size_t highest = scope.highest ? scope.highest->size() : 0;
  const NodeId node = make(expressions, root_, scope);
  const bool holds_highest = scope.highest && scope.highest->size() != highest;
  if (holds_highest) scope.highest->resize(highest);
  if (!node.valid() || holds_highest) return expressions.translator.translate(text, scope);
  if (recent_path_ >= paths_.size() || paths_[recent_path_].choices != choices_) {
    const auto path = std::ranges::find(paths_, choices_, &Path::choices);
    recent_path_ = static_cast<std::size_t>(path - paths_.begin());
  }
  if (recent_path_ < paths_.size()) return {.node = node, .measured = paths_[recent_path_].measured};
  Value value = expressions.translator.translate(text, scope);
  if (value.bad) return value;
  if (value.node == node && !value.condition && (!scope.highest || scope.highest->size() == highest)) {
    paths_.push_back({choices_, value.measured});
  } else {
    is_given_up_ = true;
  }
  return value;
}

void FamilyTranslator::note_indices(const Scope& scope) {
  std::size_t d = 0;
  for (const Index* index = scope.innermost; index; index = index->outer, ++d) {
    const auto value = static_cast<double>(index->value);
    if (values_[d] == value && changes_[d] > 0) continue;
    values_[d] = value;
    ++changes_[d];
  }
}

/// Changes are only counted up: their sum is the same only where none of the indices has changed.
std::uint64_t FamilyTranslator::stamp_of(std::uint32_t depends) const {
  std::uint64_t stamp = 1;
  for (std::size_t d = 0; depends != 0; ++d, depends >>= 1u)
    if ((depends & 1u) != 0) stamp += changes_[d];
  return stamp;
}

// -- reading ----------------------------------------------------------------------------------------------------------

FamilyTranslator::Part FamilyTranslator::add(Node node) {
  node.is_by_value = node.is_of_numbers && std::has_single_bit(node.depends);
  nodes_.push_back(std::move(node));
  return static_cast<Part>(nodes_.size() - 1);
}

std::optional<FamilyTranslator::Part> FamilyTranslator::read(const Expressions& expressions,
                                                             const ast::Expression& text, Scope& scope) {
  const Mentions mentions = mentions_of(text, names_);
  if (!mentions.index && !mentions.indexed_name && !mentions.other) {
    const Value value = expressions.translator.translate(text, scope);
    if (value.bad || value.condition) return std::nullopt;
    return add({.kind = Node::Kind::fixed, .is_of_numbers = true, .node = value.node, .measured = value.measured});
  }
  if (const auto* name = std::get_if<ast::Name>(&text.node)) return read(expressions, *name, scope);
  if (const auto* binary = std::get_if<ast::Binary>(&text.node)) return read(expressions, *binary, scope);
  if (const auto* call = std::get_if<ast::Call>(&text.node)) return read(expressions, *call, scope);
  if (const auto* choice = std::get_if<ast::Conditional>(&text.node)) return read(expressions, *choice, scope);
  const auto* unary = std::get_if<ast::Unary>(&text.node);
  if (!unary || unary->op != ast::UnaryOperator::negate) return std::nullopt;
  const auto operand = read(expressions, *unary->operand, scope);
  if (!operand) return std::nullopt;
  return add({.kind = Node::Kind::negation,
              .is_of_numbers = nodes_[*operand].is_of_numbers,
              .depends = nodes_[*operand].depends,
              .parts = {*operand}});
}

std::optional<std::size_t> FamilyTranslator::index_called(const ast::Name& name) const {
  const auto found = std::ranges::find(names_, name.text);
  if (found == names_.end() || name.primes > 0 || !name.indices.empty() || !name.member.empty()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

std::optional<FamilyTranslator::Part> FamilyTranslator::read(const Expressions& expressions, const ast::Name& name,
                                                             Scope& scope) {
  if (const auto index = index_called(name))
    return add({.kind = Node::Kind::index, .is_of_numbers = true, .depends = 1u << *index, .number = *index});
  if (name.indices.empty() || !name.member.empty()) return std::nullopt;
  Node node{.kind = Node::Kind::name, .name = &name};
  for (std::size_t d = 0; d < names_.size(); ++d) {
    for (const ast::Expression& index : name.indices) {
      const Mentions mentions = mentions_of(index, {names_[d]});
      if (mentions.indexed_name || mentions.other) return std::nullopt;
      if (mentions.index) node.depends |= 1u << d;
    }
  }
  node.places = read_places(expressions, name, scope);
  if (!node.places.empty()) node.members = expressions.workspace.declared.symbols.members(name.text, scope.mode);
  if (node.members) node.number = states_of(*node.members, name.primes);
  return add(std::move(node));
}

/// The indices of a name, or nothing where one of them is more than a sum of whole numbers.
std::vector<FamilyTranslator::Sum> FamilyTranslator::read_places(const Expressions& expressions, const ast::Name& name,
                                                                 Scope& scope) {
  std::vector<Sum> places;
  for (const ast::Expression& index : name.indices) {
    const auto place = read_sum(expressions, index, scope);
    if (!place || place->number != std::floor(place->number) || places.size() == IndexValues::most) return {};
    places.push_back(*place);
  }
  return places;
}

std::optional<FamilyTranslator::Part> FamilyTranslator::read(const Expressions& expressions, const ast::Binary& text,
                                                             Scope& scope) {
  const auto op = arithmetic(text.op);
  if (!op) return std::nullopt;
  // The unit of a power depends on its exponent, which is no unit.
  if (*op == Op::power && mentions_of(*text.right, names_).index) return std::nullopt;
  const auto left = read(expressions, *text.left, scope), right = left ? read(expressions, *text.right, scope) : left;
  if (!right) return std::nullopt;
  return add({.kind = Node::Kind::operation,
              .is_of_numbers = nodes_[*left].is_of_numbers && nodes_[*right].is_of_numbers,
              .op = *op,
              .depends = nodes_[*left].depends | nodes_[*right].depends,
              .parts = {*left, *right}});
}

std::optional<FamilyTranslator::Part> FamilyTranslator::read(const Expressions& expressions, const ast::Call& text,
                                                             Scope& scope) {
  const Function* function = find_function(text.callee.text);
  const std::size_t count = text.arguments.size();
  if (!function || function->units == Function::Units::power || count < 1 || count > 2) return std::nullopt;
  if (!text.callee.indices.empty() || text.callee.primes > 0 || !text.callee.member.empty()) return std::nullopt;
  Node node{.kind = Node::Kind::function, .is_of_numbers = true, .function = text.callee.text, .arguments = count};
  for (std::size_t k = 0; k < count; ++k) {
    const auto part = read(expressions, text.arguments[k], scope);
    if (!part) return std::nullopt;
    node.parts[k] = *part;
    node.depends |= nodes_[*part].depends;
    node.is_of_numbers = node.is_of_numbers && nodes_[*part].is_of_numbers;
  }
  return add(std::move(node));
}

std::optional<FamilyTranslator::Part> FamilyTranslator::read(const Expressions& expressions,
                                                             const ast::Conditional& text, Scope& scope) {
  const auto* condition = std::get_if<ast::Binary>(&text.condition->node);
  const bool compares =
      condition && condition->op >= ast::BinaryOperator::less && condition->op <= ast::BinaryOperator::not_equal;
  if (!compares || choice_count_ == most_choices) return std::nullopt;
  Node node{.kind = Node::Kind::choice, .comparison = condition->op, .number = choice_count_++};
  const auto left = read_sum(expressions, *condition->left, scope);
  const auto right = read_sum(expressions, *condition->right, scope);
  if (!left || !right) return std::nullopt;
  node.sides = {*left, *right};
  const auto yes = read(expressions, *text.when_true, scope);
  const auto no = yes ? read(expressions, *text.when_false, scope) : yes;
  if (!no) return std::nullopt;
  node.parts = {*yes, *no};
  node.depends = left->depends | right->depends | nodes_[*yes].depends | nodes_[*no].depends;
  return add(std::move(node));
}

/// `i`, `i + 1`, `N - i` with numbers and parameters that are fixed while the model is what it is.
std::optional<FamilyTranslator::Sum> FamilyTranslator::read_sum(const Expressions& expressions,
                                                                const ast::Expression& text, Scope& scope) {
  Sum sum;
  if (const auto* number = std::get_if<ast::Number>(&text.node)) {  // which makes no node
    sum.number = number->value;
    return sum;
  }
  const Mentions mentions = mentions_of(text, names_);
  if (mentions.indexed_name || mentions.other) return std::nullopt;
  if (!mentions.index) {
    const Value value = expressions.translator.translate(text, scope);
    if (value.bad || value.condition || value.measured.is_known()) return std::nullopt;
    const auto number = expressions.translator.structural_number(value.node);
    if (!number) return std::nullopt;
    sum.number = *number;
    return sum;
  }
  if (const auto* name = std::get_if<ast::Name>(&text.node)) {
    const auto index = index_called(*name);
    if (!index) return std::nullopt;
    sum.factors[*index] = 1;
    sum.depends = 1u << *index;
    return sum;
  }
  const auto* binary = std::get_if<ast::Binary>(&text.node);
  const bool adds = binary && (binary->op == ast::BinaryOperator::add || binary->op == ast::BinaryOperator::subtract);
  const auto left = adds ? read_sum(expressions, *binary->left, scope) : std::nullopt;
  const auto right = left ? read_sum(expressions, *binary->right, scope) : std::nullopt;
  if (!right) return std::nullopt;
  const double sign = binary->op == ast::BinaryOperator::add ? 1 : -1;
  sum.number = left->number + sign * right->number;
  for (std::size_t d = 0; d < most_indices; ++d) {
    sum.factors[d] = left->factors[d] + sign * right->factors[d];
    if (sum.factors[d] != 0) sum.depends |= 1u << d;
  }
  // Where all are whole, the order of the terms does not matter.
  if (sum.number != std::floor(sum.number) || std::abs(sum.number) > 1e9) return std::nullopt;
  return sum;
}

// -- a member ---------------------------------------------------------------------------------------------------------

NodeId FamilyTranslator::make(const Expressions& expressions, Part part, Scope& scope) {
  Node& node = nodes_[part];
  if (node.kind == Node::Kind::fixed) return node.node;
  if (node.kind == Node::Kind::choice) {
    const bool yes = holds(node);
    if (yes) choices_ |= std::uint64_t{1} << node.number;
    return make(expressions, node.parts[yes ? 0 : 1], scope);
  }
  if (node.is_by_value) return make_by_value(expressions, node, scope);
  if ((node.depends & 1u) != 0) return make_anew(expressions, node, scope);  // no member has that of the one before
  const std::uint64_t stamp = stamp_of(node.depends);
  if (node.stamp != stamp) {
    const std::uint64_t before = std::exchange(choices_, 0);
    node.node = make_anew(expressions, node, scope);
    node.stamp = node.node.valid() ? stamp : 0;
    node.choices = std::exchange(choices_, before);
  }
  choices_ |= node.choices;
  return node.node;
}

/// What one index alone decides is made once for each of its values, however often the other indices go round.
NodeId FamilyTranslator::make_by_value(const Expressions& expressions, Node& node, Scope& scope) {
  constexpr long most = 1'000'000;
  const auto value = static_cast<long>(values_[static_cast<std::size_t>(std::countr_zero(node.depends))]);
  if (node.by_value.empty()) node.first_value = value;
  const long place = value - node.first_value;
  if (place < 0 || place >= most) return make_anew(expressions, node, scope);
  if (static_cast<std::size_t>(place) >= node.by_value.size())
    node.by_value.resize(static_cast<std::size_t>(place) + 1);
  NodeId& made = node.by_value[static_cast<std::size_t>(place)];
  if (!made.valid()) made = make_anew(expressions, node, scope);
  return made;
}

NodeId FamilyTranslator::make_anew(const Expressions& expressions, Node& node, Scope& scope) {
  Graph& g = expressions.workspace.graph;
  if (node.kind == Node::Kind::index) return g.constant(values_[node.number]);
  if (node.kind == Node::Kind::name) return make_name(expressions, node, scope);
  const NodeId a = make(expressions, node.parts[0], scope);
  if (!a.valid()) return a;
  if (node.kind == Node::Kind::negation) return g.negate(a);
  if (node.kind == Node::Kind::function && node.arguments == 1) return function_of_one(g, node.function, a);
  const NodeId b = make(expressions, node.parts[1], scope);
  if (!b.valid()) return b;
  return node.kind == Node::Kind::function ? function_of_two(g, node.function, a, b) : g.apply(node.op, a, b);
}

/// Of another unit than that of the members before it is another case.
NodeId FamilyTranslator::make_name(const Expressions& expressions, Node& node, Scope& scope) {
  if (const NodeId state = find_state(expressions, node, scope); state.valid()) return state;
  const Value value = expressions.lookup.lookup(*node.name, scope);
  if (value.bad || value.condition) return {};
  if (!node.measured) node.measured = value.measured;
  return are_same(*node.measured, value.measured) ? value.node : NodeId{};
}

/// A state by the place of its indices among the members of its family; not valid where the lookup has more to say.
NodeId FamilyTranslator::find_state(const Expressions& expressions, Node& node, Scope& scope) {
  if (!node.members || scope.is_constant() || scope.moment) return {};
  IndexValues indices;
  for (const Sum& place : node.places) indices.push_back(static_cast<long>(value_of(place)));
  const std::uint32_t number = node.members->number_of(indices);
  if (number == Members::none) return {};
  States& states = states_[node.number];
  if (number >= states.nodes.size()) states.nodes.resize(number + std::size_t{1});
  NodeId& state = states.nodes[number];
  if (!state.valid()) state = new_state(expressions, node, number, scope);
  if (!state.valid()) return {};
  if (!node.measured) node.measured = states.measured;
  return are_same(*node.measured, *states.measured) ? state : NodeId{};
}

/// One that no name has asked for yet; not valid where it is none, or of another unit than the others.
NodeId FamilyTranslator::new_state(const Expressions& expressions, const Node& node, std::uint32_t number,
                                   Scope& scope) {
  const Symbol& symbol = (*node.members)[number];
  if (symbol.kind != Symbol::Kind::base) return {};
  if (node.name->primes >= expressions.workspace.declared.bases[symbol.index].order) return {};
  const Value value = expressions.lookup.derivative(*node.name, symbol.index, scope);
  States& states = states_[node.number];
  if (!states.measured) states.measured = value.measured;
  return are_same(*states.measured, value.measured) ? value.node : NodeId{};
}

/// The states of this family and with so many primes.
std::size_t FamilyTranslator::states_of(const Members& members, int primes) {
  const auto known = std::ranges::find_if(
      states_, [&](const States& states) { return states.members == &members && states.primes == primes; });
  const auto number = static_cast<std::size_t>(known - states_.begin());
  if (known == states_.end()) states_.push_back({.members = &members, .primes = primes});
  return number;
}

double FamilyTranslator::value_of(const Sum& sum) const {
  double value = sum.number;
  for (std::uint32_t left = sum.depends; left != 0; left &= left - 1) {
    const auto d = static_cast<std::size_t>(std::countr_zero(left));
    value += sum.factors[d] * values_[d];
  }
  return value;
}

bool FamilyTranslator::holds(const Node& choice) const {
  const double left = value_of(choice.sides[0]), right = value_of(choice.sides[1]);
  switch (choice.comparison) {
    case ast::BinaryOperator::less:
      return left < right;
    case ast::BinaryOperator::less_equal:
      return left <= right;
    case ast::BinaryOperator::greater:
      return left > right;
    case ast::BinaryOperator::greater_equal:
      return left >= right;
    case ast::BinaryOperator::equal:
      return left == right;
    default:
      return left != right;
  }
}

}  // namespace continuo::model::detail
