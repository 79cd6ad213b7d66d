// tests/hybrid/shrink.cpp
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <tests/hybrid/shrink.hpp>

namespace continuo::hybrid {
namespace {

using Candidates = std::vector<HybridModel>;

/// Calls `visit` with every index of a state or unknown that is read or written, of the given kind.
template <class Visit>
void each_index(Expression& e, Expression::Kind kind, const Visit& visit) {
  if (e.kind == kind) visit(e.index);
  for (Expression& part : e.parts) each_index(part, kind, visit);
}

template <class Visit>
void each_index(std::vector<Action>& actions, Expression::Kind kind, const Visit& visit) {
  for (Action& action : actions) {
    if (action.kind == Action::Kind::assign) {
      if (kind == Expression::Kind::state) visit(action.target);
      each_index(action.value, kind, visit);
    }
    each_index(action.chosen, kind, visit);
    each_index(action.otherwise, kind, visit);
  }
}

/// All indices but those of the block or unknown to be removed.
template <class Visit>
void each_index(HybridModel& model, Expression::Kind kind, const Visit& visit) {
  for (Block& block : model.blocks) {
    each_index(block.surface, kind, visit);
    each_index(block.also, kind, visit);
    if (kind == Expression::Kind::state && block.flag != none) visit(block.flag);
    if (kind == Expression::Kind::state && block.drive != none) visit(block.drive);
    if (kind == Expression::Kind::unknown && block.through != none) visit(block.through);
  }
  for (Unknown& u : model.unknowns) each_index(u.source, kind, visit);
  for (Comparison& c : model.comparisons) {
    each_index(c.left, kind, visit);
    each_index(c.right, kind, visit);
  }
  for (Event& e : model.events) each_index(e.actions, kind, visit);
}

template <class Visit>
void each_comparison(Condition& c, const Visit& visit) {
  if (c.comparison != none) visit(c.comparison);
  for (Condition& part : c.parts) each_comparison(part, visit);
}

template <class Visit>
void each_comparison(std::vector<Action>& actions, const Visit& visit) {
  for (Action& action : actions) {
    each_comparison(action.condition, visit);
    each_comparison(action.chosen, visit);
    each_comparison(action.otherwise, visit);
  }
}

template <class Visit>
void each_comparison(HybridModel& model, const Visit& visit) {
  for (Event& e : model.events) {
    if (e.comparison != none) visit(e.comparison);
    each_comparison(e.condition, visit);
    each_comparison(e.actions, visit);
  }
}

/// Comparisons that are no longer read would keep states in the model.
void drop_unread_comparisons(HybridModel& model) {
  std::vector<int> place(model.comparisons.size(), none);
  std::vector<Comparison> kept;
  each_comparison(model, [&](int& c) {
    int& at = place[static_cast<std::size_t>(c)];
    if (at == none) {
      at = static_cast<int>(kept.size());
      kept.push_back(model.comparisons[static_cast<std::size_t>(c)]);
    }
    c = at;
  });
  model.comparisons = std::move(kept);
}

void without_block(const HybridModel& model, std::size_t i, Candidates& found) {
  HybridModel smaller = model;
  const int first = model.blocks[i].state, states = model.blocks[i].states();
  smaller.blocks.erase(smaller.blocks.begin() + static_cast<std::ptrdiff_t>(i));
  bool read = false;
  each_index(smaller, Expression::Kind::state, [&](int& s) { read = read || (s >= first && s < first + states); });
  if (read || smaller.blocks.empty()) return;
  each_index(smaller, Expression::Kind::state, [&](int& s) { s -= s > first ? states : 0; });
  for (Block& block : smaller.blocks) block.state -= block.state > first ? states : 0;
  smaller.names.erase(smaller.names.begin() + first, smaller.names.begin() + first + states);
  smaller.initial.erase(smaller.initial.begin() + first, smaller.initial.begin() + first + states);
  found.push_back(std::move(smaller));
}

void without_unknown(const HybridModel& model, std::size_t i, Candidates& found) {
  HybridModel smaller = model;
  smaller.unknowns.erase(smaller.unknowns.begin() + static_cast<std::ptrdiff_t>(i));
  bool read = false;
  const int gone = static_cast<int>(i);
  each_index(smaller, Expression::Kind::unknown, [&](int& u) { read = read || u == gone; });
  if (read) return;
  each_index(smaller, Expression::Kind::unknown, [&](int& u) { u -= u > gone ? 1 : 0; });
  found.push_back(std::move(smaller));
}

/// The list without one of its actions, or with a choice replaced by one of its branches.
std::vector<std::vector<Action>> smaller_lists(const std::vector<Action>& actions) {
  std::vector<std::vector<Action>> found;
  for (std::size_t a = 0; a < actions.size(); ++a) {
    auto list = actions;
    const auto at = list.erase(list.begin() + static_cast<std::ptrdiff_t>(a));
    found.push_back(list);
    if (actions[a].kind != Action::Kind::choose) continue;
    list.insert(at, actions[a].chosen.begin(), actions[a].chosen.end());
    found.push_back(std::move(list));
  }
  return found;
}

std::vector<Condition> smaller_conditions(const Condition& c) {
  std::vector<Condition> found = c.parts;
  for (std::size_t p = 0; p < c.parts.size(); ++p) {
    for (Condition& part : smaller_conditions(c.parts[p])) {
      Condition smaller = c;
      smaller.parts[p] = std::move(part);
      found.push_back(std::move(smaller));
    }
    if (c.parts.size() > 2) {
      Condition smaller = c;
      smaller.parts.erase(smaller.parts.begin() + static_cast<std::ptrdiff_t>(p));
      found.push_back(std::move(smaller));
    }
  }
  return found;
}

void with_smaller_event(const HybridModel& model, std::size_t e, Candidates& found) {
  for (auto& list : smaller_lists(model.events[e].actions)) {
    found.push_back(model);
    found.back().events[e].actions = std::move(list);
  }
  for (Condition& condition : smaller_conditions(model.events[e].condition)) {
    found.push_back(model);
    found.back().events[e].condition = std::move(condition);
  }
  if (model.events[e].in_mode != none) {
    found.push_back(model);
    found.back().events[e].in_mode = none;
  }
}

bool goes(const std::vector<Action>& actions) {
  return std::ranges::any_of(
      actions, [](const Action& a) { return a.kind == Action::Kind::go || goes(a.chosen) || goes(a.otherwise); });
}

void with_fewer_modes(const HybridModel& model, Candidates& found) {
  if (model.modes == 1) return;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (model.blocks[b].in_mode.size() == 1) continue;
    found.push_back(model);
    found.back().blocks[b].in_mode.resize(1);
  }
  for (std::size_t u = 0; u < model.unknowns.size(); ++u) {
    if (model.unknowns[u].offset.size() == 1) continue;
    found.push_back(model);
    found.back().unknowns[u].offset.resize(1);
  }
  const bool read =
      std::ranges::any_of(model.blocks, [](const Block& b) { return b.in_mode.size() > 1; }) ||
      std::ranges::any_of(model.unknowns, [](const Unknown& u) { return u.offset.size() > 1; }) ||
      std::ranges::any_of(model.events, [](const Event& e) { return e.in_mode != none || goes(e.actions); });
  if (read) return;
  found.push_back(model);
  found.back().modes = 1;
}

Candidates smaller_models(const HybridModel& model) {
  Candidates found;
  for (const double part : {0.3, 0.5, 0.8, 0.9}) {
    found.push_back(model);
    found.back().end = static_cast<long>(static_cast<double>(model.end) / 100 * part) * 100;
    if (found.back().end == 0) found.pop_back();
  }
  for (std::size_t e = 0; e < model.events.size(); ++e) {
    found.push_back(model);
    found.back().events.erase(found.back().events.begin() + static_cast<std::ptrdiff_t>(e));
  }
  for (std::size_t e = 0; e < model.events.size(); ++e) {
    if (!model.events[e].is_step) with_smaller_event(model, e, found);
  }
  for (std::size_t u = 0; u < model.unknowns.size(); ++u) without_unknown(model, u, found);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) without_block(model, b, found);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (model.blocks[b].flag == none) continue;
    found.push_back(model);
    found.back().blocks[b].flag = none;
  }
  with_fewer_modes(model, found);
  for (HybridModel& smaller : found) drop_unread_comparisons(smaller);
  return found;
}

}  // namespace

HybridModel shrink(HybridModel model, const std::function<bool(const HybridModel&)>& fails) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    for (HybridModel& candidate : smaller_models(model)) {
      if (!fails(candidate)) continue;
      model = std::move(candidate);
      smaller = true;
      break;
    }
  }
  return model;
}

}  // namespace continuo::hybrid
