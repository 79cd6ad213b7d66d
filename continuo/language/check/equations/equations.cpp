// continuo/language/check/equations/equations.cpp
// Solves single equations first, then the coupled ones together, mode by mode.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include <continuo/language/check/equations/equations.hpp>
#include <continuo/language/check/equations/reduction.hpp>

namespace continuo::model::detail {

namespace {
/// Symbolic elimination of more equations than this grows beyond all use.
constexpr std::size_t most_coupled = 24;
}  // namespace

SolvedEquations Equations::solve() {
  for (std::size_t mode = 0; mode < declared_.modes.size(); ++mode) solve_mode(mode);
  return std::move(made_);
}

/// The variable of this name in its mode.
std::optional<std::size_t> Equations::base_of(const ast::Name& name, Scope& scope) const {
  const auto indexed_name = expressions_.indices.name_of(name, scope);
  const Symbol* symbol = indexed_name ? declared_.symbols.find(*indexed_name, scope.mode) : nullptr;
  return symbol && symbol->kind == Symbol::Kind::base ? std::optional(symbol->index) : std::nullopt;
}

/// `x' = ...` where x' is the highest derivative of x: what it measures. Its node is not needed where the right side
/// holds no highest derivative.
std::optional<Value> Equations::explicit_left(const EquationText& equation, Scope& scope,
                                              std::vector<std::uint32_t>& held) const {
  const auto* name = std::get_if<ast::Name>(&equation.text->left.node);
  if (!name || name->primes == 0 || !name->member.empty()) return std::nullopt;
  const auto index = equation.base != EquationText::no_base ? std::optional(equation.base) : base_of(*name, scope);
  if (!index) return std::nullopt;
  const Base& base = declared_.bases[*index];
  if (base.in_world || base.order != name->primes) return std::nullopt;
  held.push_back(static_cast<std::uint32_t>(*index));
  return Value{.node = {}, .measured = expressions_.lookup.highest_unit(*index, scope)};
}

/// Both sides brought to one unit: left - right = 0, and what it holds.
EquationAtWork Equations::read_equation(ModeAtWork& mode, const EquationText& equation) {
  Scope scope = equation.scope;
  on_left_.clear();
  held_.clear();
  scope.highest = &on_left_;
  const std::optional<Value> highest = explicit_left(equation, scope, on_left_);
  Term left{equation.text->left, highest ? *highest : expressions_.translator.translate(equation.text->left, scope)};
  scope.highest = &held_;
  Term right{equation.text->right, right_sides_.translate(expressions_, equation.text->right, scope)};
  EquationAtWork work;
  work.span = equation.span;
  const bool is_explicit = highest && held_.empty();
  if (highest && !is_explicit) left.value.node = graph_.variable(highest_begin + on_left_.front());
  held_.insert(held_.end(), on_left_.begin(), on_left_.end());
  std::ranges::sort(held_);
  held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
  work.first_held = static_cast<std::uint32_t>(mode.held.size());
  work.holds = static_cast<std::uint32_t>(held_.size());
  mode.held.insert(mode.held.end(), held_.begin(), held_.end());
  if (!expressions_.operations.want_numbers(left, right) ||
      !expressions_.translator.align(left, right, equation.span, scope)) {
    work.bad = true;
    return work;
  }
  if (is_explicit) {
    work.solution = right.value.node;
  } else {
    work.residual = graph_.subtract(left.value.node, right.value.node);
  }
  return work;
}

void Equations::solve_mode(std::size_t mode) {
  ModeAtWork work;
  work.mode = mode;
  work.solved.assign(declared_.bases.size(), NodeId{});
  work.by.assign(declared_.bases.size(), npos);
  work.equations.reserve(declared_.equations.size());
  work.held.reserve(declared_.equations.size());
  for (const EquationText& equation : declared_.equations) {
    if (equation.scope.mode != Scope::no_mode && equation.scope.mode != static_cast<int>(mode)) continue;
    work.equations.push_back(read_equation(work, equation));
  }
  for (std::size_t i = 0; i < declared_.bases.size(); ++i) {
    if (declared_.bases[i].in_world) work.by[i] = 0;  // moved by forces
  }
  sort_out_algebraic(work);
  solve_one_by_one(work);
  solve_coupled(work);
  counts_.report_missing(work);
  for (std::size_t i = 0; i < declared_.bases.size(); ++i) {
    if (!work.solved[i].valid()) work.solved[i] = graph_.constant(0);
  }
  made_.derivatives.push_back(reduce(work.solved, expressions_.workspace));
  if (!declared_.has_modes()) made_.highest = std::move(work.solved);
}

/// An equation without a highest derivative: of an unknown, or one that says nothing.
void Equations::sort_out_algebraic(ModeAtWork& work) {
  std::size_t algebraic = 0;
  const Layout& layout = model_.layout;
  for (std::size_t e = 0; e < work.equations.size(); ++e) {
    EquationAtWork& equation = work.equations[e];
    if (equation.holds > 0) continue;
    equation.used = true;
    if (equation.bad) continue;
    const auto variables = variables_of(graph_, equation.residual);
    const bool has_unknown =
        std::ranges::any_of(variables, [&](std::uint32_t v) { return v >= layout.unknowns && v < layout.parameters; });
    if (has_unknown || !declared_.unknowns.empty()) {
      ++algebraic;
      made_.algebraic.push_back({equation.residual, work.mode, equation.span});
      continue;
    }
    counts_.report_empty_equation(work, e, variables);
  }
  count_algebraic(algebraic);
}

void Equations::count_algebraic(std::size_t algebraic) const {
  if (algebraic == declared_.unknowns.size() || report_.errors() > 0) return;
  if (algebraic == 0 && model_.needs_boundary_solver()) return;  // constants that the conditions determine
  std::vector<std::string> names;
  names.reserve(declared_.unknowns.size());
  for (const UnknownText& unknown : declared_.unknowns) names.push_back(unknown.name);
  const Span span = declared_.unknowns.front().span;
  report_.fail("E235", span, "as many algebraic equations as unknowns are needed",
               fmt::format("{} {} for {}", algebraic, algebraic == 1 ? "equation" : "equations", listed(names)),
               algebraic < declared_.unknowns.size() ? "add equations of the form 0 = ..."
                                                     : "drop equations, or declare more unknowns");
}

/// While some equation holds one derivative that is still open, that equation gives it.
void Equations::solve_one_by_one(ModeAtWork& work) {
  std::unordered_map<std::uint32_t, std::vector<std::size_t>> users;  // equations that hold others beside this one
  std::vector<std::size_t> ready;
  ready.reserve(work.equations.size());
  for (std::size_t e = 0; e < work.equations.size(); ++e) {
    EquationAtWork& equation = work.equations[e];
    equation.open = equation.holds;
    if (equation.open > 1) {
      for (const std::uint32_t base : work.held_by(equation)) users[base].push_back(e);
    }
    if (equation.open == 1) ready.push_back(e);
  }
  for (std::size_t next = 0; next < ready.size(); ++next) {
    EquationAtWork& equation = work.equations[ready[next]];
    if (equation.used) continue;
    const auto held = work.held_by(equation);
    const auto open = std::ranges::find_if(held, [&](std::uint32_t b) { return work.by[b] == npos; });
    if (open == held.end()) continue;  // another equation was quicker: one too many, reported below
    equation.used = true;
    work.by[*open] = ready[next];
    solve_for(work, equation, *open);
    const auto found = users.find(*open);
    if (found == users.end()) continue;
    for (const std::size_t user : found->second) {
      if (--work.equations[user].open == 1) ready.push_back(user);
    }
  }
}

NodeId Equations::with_solved(const ModeAtWork& work, NodeId node) const {
  return substitute(graph_, node, [&](std::uint32_t variable) -> std::optional<NodeId> {
    if (variable < highest_begin || !work.solved[variable - highest_begin].valid()) return std::nullopt;
    return work.solved[variable - highest_begin];
  });
}

void Equations::solve_for(ModeAtWork& work, const EquationAtWork& equation, std::uint32_t base) {
  if (equation.bad) return;
  if (equation.solution.valid()) {
    work.solved[base] = equation.solution;
    return;
  }
  Graph& g = graph_;
  const NodeId residual = equation.holds > 1 ? with_solved(work, equation.residual) : equation.residual;
  const auto linear = linear_in(g, residual, highest_begin + base);
  const std::string name = with_primes(declared_.bases[base].name, declared_.bases[base].order);
  if (!linear) {
    report_.fail("E232", equation.span, fmt::format("`{}` cannot be solved for", name),
                 "it stands here in a nonlinear way", fmt::format("solve for it by hand and write {} = ...", name));
  } else if (g.is(linear->coefficient, 0)) {
    report_.fail("E233", equation.span, "this equation determines nothing", fmt::format("`{}` cancels", name));
  } else {
    work.solved[base] = g.divide(g.negate(linear->remainder), linear->coefficient);
    if (!g.value(linear->coefficient))
      made_.masses.push_back({{linear->coefficient}, {name}, work.mode, equation.span});
  }
}

/// What is too small for a pivot, at the start, beside the largest of the rows: rounding may be all of it. Before the
/// start is known nothing is.
Vanishes Equations::vanishing_beside(const LinearRows& rows) {
  const bool known = std::ranges::all_of(model_.states, [](const State& state) { return state.initial.valid(); });
  if (report_.errors() > 0 || !known || model_.needs_boundary_solver()) return {};
  if (start_values_.empty()) start_values_ = start_values(model_);
  std::vector<NodeId> entries;
  for (const auto& row : rows) entries.insert(entries.end(), row.begin(), row.end() - 1);
  double largest = 0;
  for (const double entry : evaluate(model_, entries, start_values_)) largest = std::max(largest, std::abs(entry));
  constexpr double smallest = 1e-10;
  return [this, largest](NodeId node) { return std::abs(evaluate(model_, node, start_values_)) <= smallest * largest; };
}

/// What is left hangs together: groups of equations that share open derivatives.
void Equations::solve_coupled(ModeAtWork& work) {
  std::vector<std::size_t> group(work.equations.size(), npos);
  for (std::size_t first = 0; first < work.equations.size(); ++first) {
    if (work.equations[first].used || group[first] != npos) continue;
    std::vector<std::size_t> members{first};
    std::vector<std::uint32_t> open;
    group[first] = first;
    for (std::size_t at = 0; at < members.size(); ++at) {
      for (const std::uint32_t base : work.held_by(work.equations[members[at]])) {
        if (work.by[base] != npos || std::ranges::find(open, base) != open.end()) continue;
        open.push_back(base);
        for (std::size_t e = 0; e < work.equations.size(); ++e) {
          const EquationAtWork& other = work.equations[e];
          if (other.used || group[e] != npos || !std::ranges::binary_search(work.held_by(other), base)) continue;
          group[e] = first;
          members.push_back(e);
        }
      }
    }
    std::ranges::sort(members);
    solve_group(work, members, open);
  }
}

void Equations::solve_group(ModeAtWork& work, const std::vector<std::size_t>& members,
                            std::vector<std::uint32_t> open) {
  if (members.size() > open.size()) {
    counts_.report_surplus(work, members, open);
    return;
  }
  if (members.size() < open.size()) {
    work.undetermined.push_back({members, open});
    for (const std::uint32_t base : open) work.by[base] = members.front();
    return;
  }
  for (const std::uint32_t base : open) work.by[base] = members.front();
  std::ranges::sort(open);
  solve_rows(work, members, open);
}

void Equations::solve_rows(ModeAtWork& work, const std::vector<std::size_t>& members,
                           const std::vector<std::uint32_t>& open) {
  std::vector<NodeId> residuals;
  std::vector<std::uint32_t> unknowns;
  const std::vector<std::string> names = counts_.highest_names(open);
  for (const std::size_t e : members) {
    if (work.equations[e].bad) return;
    residuals.push_back(with_solved(work, work.equations[e].residual));
  }
  unknowns.reserve(open.size());
  for (const std::uint32_t base : open) unknowns.push_back(highest_begin + base);
  const Span span = work.equations[members.front()].span;
  if (open.size() > most_coupled) {
    report_.fail("E232", span, fmt::format("{} equations hang together", open.size()),
                 fmt::format("their highest derivatives are {}", listed(names)), "solve some of them by hand");
    return;
  }
  const auto rows = linear_rows(graph_, residuals, unknowns);
  const auto solution = rows ? solve_linear(graph_, *rows, vanishing_beside(*rows)) : std::nullopt;
  if (!solution) {
    auto* said =
        rows ? report_.fail("E237", span, fmt::format("{} are not determined", listed(names)),
                            "the matrix before them is singular",
                            "one of these equations repeats the others, or one of the variables is an `unknown`")
             : report_.fail("E232", span, fmt::format("{} cannot be solved for", listed(names)),
                            "these equations are not linear in them",
                            "solve for the highest derivatives by hand, one equation each");
    for (std::size_t i = 1; said && i < members.size(); ++i) {
      said->related.push_back({work.equations[members[i]].span, "together with this"});
    }
    return;
  }
  for (std::size_t i = 0; i < open.size(); ++i) work.solved[open[i]] = (*solution)[i];
  MassMatrix mass{{}, names, work.mode, span};
  for (const auto& row : *rows) mass.coefficients.insert(mass.coefficients.end(), row.begin(), row.end() - 1);
  made_.masses.push_back(std::move(mass));
}

}  // namespace continuo::model::detail
