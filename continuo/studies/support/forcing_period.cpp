// Derives the period of a model's explicit dependence on time from its text.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <continuo/studies/support/forcing_period.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::studies {

namespace {

using model::NodeId;
using model::Op;

/// How an expression depends on t while the states are held: slope t + something with all these periods.
struct Course {
  bool known = true;
  double slope = 0;
  std::vector<double> periods{};
};

void join(std::vector<double>& into, const std::vector<double>& more) {
  for (const double period : more)
    if (std::ranges::find(into, period) == into.end()) into.push_back(period);
}

class Courses {
 public:
  Courses(const model::Model& model, std::vector<double> variables) : model_(model), variables_(std::move(variables)) {}

  Course of(NodeId root) const {
    const std::vector<NodeId> order = model::reachable(model_.graph, std::span(&root, 1));
    std::vector<std::pair<NodeId, Course>> done;
    for (const NodeId node : order) {
      std::vector<Course> parts;
      for (const NodeId a : model::arguments(model_.graph[node]))
        parts.push_back(std::ranges::lower_bound(done, a, {}, [](const auto& entry) { return entry.first; })->second);
      done.emplace_back(node, combined(node, parts));
    }
    return std::ranges::lower_bound(done, root, {}, [](const auto& entry) { return entry.first; })->second;
  }

 private:
  std::optional<double> constant(NodeId node) const {
    for (const std::uint32_t v : model::variables_of(model_.graph, node))
      if (v < model_.layout.parameters || v >= model_.layout.inputs) return std::nullopt;
    return model::evaluate(model_, node, variables_);
  }

  Course combined(NodeId id, const std::vector<Course>& parts) const {
    const model::Node& node = model_.graph[id];
    if (node.op == Op::variable) return variable(node.number);
    Course result;
    bool any_slope = false;
    for (const Course& part : parts) {
      result.known = result.known && part.known;
      any_slope = any_slope || part.slope != 0;
      join(result.periods, part.periods);
    }
    if (!result.known || !any_slope) return result;
    const double a = parts[0].slope, b = parts.size() > 1 ? parts[1].slope : 0;
    const auto keeps = [&](double slope) {
      result.slope = slope;
      return result;
    };
    const auto repeats = [&](double period) {
      join(result.periods, {std::abs(period)});
      return result;
    };
    switch (node.op) {
      case Op::add:
        return keeps(a + b);
      case Op::subtract:
        return keeps(a - b);
      case Op::negate:
        return keeps(-a);
      case Op::multiply:
        if (const auto factor = constant(a != 0 ? node.b : node.a); factor && (a == 0 || b == 0))
          return keeps((a + b) * *factor);
        break;
      case Op::divide:
        if (const auto divisor = constant(node.b); divisor && b == 0) return keeps(a / *divisor);
        break;
      case Op::sine:
      case Op::cosine:
        return repeats(2 * std::numbers::pi / a);
      case Op::tangent:
        return repeats(std::numbers::pi / a);
      case Op::floor:
      case Op::ceiling:
        result.slope = a;
        return repeats(1 / a);
      case Op::modulo:
        if (const auto divisor = constant(node.b); divisor && b == 0) return repeats(*divisor / a);
        break;
      default:
        break;
    }
    result.known = false;
    return result;
  }

  Course variable(std::uint32_t number) const {
    if (number == model::Layout::time) return {.slope = 1};
    const bool moved = std::ranges::any_of(
        model_.inputs, [&](const model::Input& input) { return input.variable == number && input.points.has_value(); });
    return {.known = !moved};
  }

  const model::Model& model_;
  std::vector<double> variables_;
};

/// Every expression that moves the model or decides what happens, and where it stands.
struct Mover {
  NodeId node;
  model::Span span;
};

void add_movers(const model::Block& block, const model::Span& span, std::vector<Mover>& movers) {
  for (const model::Action& action : block) {
    if (const auto* assign = std::get_if<model::Assign>(&action.what)) movers.push_back({assign->value, span});
    const auto* branch = std::get_if<model::If>(&action.what);
    if (branch == nullptr) continue;
    movers.push_back({branch->condition, span});
    add_movers(branch->then, span, movers);
    add_movers(branch->otherwise, span, movers);
  }
}

std::vector<Mover> movers_of(const model::Model& model) {
  std::vector<Mover> movers;
  for (const model::Mode& mode : model.modes)
    for (std::size_t i = 0; i < mode.derivatives.size(); ++i)
      movers.push_back({mode.derivatives[i], model.states[i].span});
  for (const model::When& when : model.events) {
    if (!changes_something(when.actions) && !changes_something(when.limit_actions)) continue;
    movers.push_back({when.guard, when.span});
    add_movers(when.actions, when.span, movers);
    add_movers(when.limit_actions, when.span, movers);
  }
  for (const model::Scheduled& event : model.schedule)
    if (event.kind == model::Scheduled::Kind::every && changes_something(event.actions))
      add_movers(event.actions, event.span, movers);
  return movers;
}

}  // namespace

std::optional<double> common_period(std::span<const double> periods) {
  constexpr double exact = 1e-11, largest = 10000;
  double common = 0;
  for (const double period : periods) {
    if (!(period > 0) || !std::isfinite(period)) return std::nullopt;
    if (common == 0) {
      common = period;
      continue;
    }
    // The convergents m/n of the continued fraction of their ratio: the first that is exact.
    const double ratio = period / common;
    double m = 1, m_before = 0, n = 0, n_before = 1, rest = ratio;
    while (true) {
      const double part = std::floor(rest);
      m_before = std::exchange(m, part * m + m_before);
      n_before = std::exchange(n, part * n + n_before);
      if (m > largest || n > largest) return std::nullopt;
      if (m > 0 && std::abs(m / n - ratio) <= exact * ratio) break;
      if (!(rest - part > 0)) return std::nullopt;
      rest = 1 / (rest - part);
    }
    common *= m;
  }
  return common > 0 ? std::optional(common) : std::nullopt;
}

Forcing forcing_of(const model::ModelProgram& program, const model::Overrides& parameters) {
  const model::Model& model = program.model;
  const std::vector<double> variables = model::start_values(model, parameters);
  const Courses courses(model, variables);
  Forcing forcing;
  std::vector<double> periods;
  for (const Mover& mover : movers_of(model)) {
    const Course course = courses.of(mover.node);
    if (course.known && course.slope == 0) {
      join(periods, course.periods);
      continue;
    }
    forcing.status = {.ending = Ending::cannot_continue,
                      .message = "the period of this time-dependent term does not follow from the text"};
    forcing.span = mover.span;
    return forcing;
  }
  for (const model::Scheduled& event : model.schedule)
    if (event.kind == model::Scheduled::Kind::every && changes_something(event.actions))
      join(periods, {model::evaluate(model, event.time->node, variables)});
  if (periods.empty()) return forcing;
  forcing.period = common_period(periods);
  if (forcing.period) return forcing;
  std::string all;
  for (const double period : periods) all += fmt::format("{}{:.10g}", all.empty() ? "" : ", ", period);
  forcing.status = {
      .ending = Ending::cannot_continue,
      .message = fmt::format("the time-dependent terms have periods of {}, which have no common multiple", all)};
  forcing.span = model.run.span;
  return forcing;
}

bool repeats_after(const model::ModelProgram& program, double period, std::span<const double> low,
                   std::span<const double> high, const model::Overrides& parameters) {
  const model::Model& model = program.model;
  constexpr int samples = 200;
  constexpr double alike = 1e-7;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> variables = model::start_values(model, parameters);
  std::vector<NodeId> nodes;
  for (const Mover& mover : movers_of(model)) nodes.push_back(mover.node);
  for (const model::Input& input : model.inputs)  // whose files end
    if (input.points &&
        std::ranges::any_of(nodes, [&](NodeId node) { return model::depends_on(model.graph, node, input.variable); }))
      return false;
  const double begin = model.run.from ? model.run.from->value : 0;
  std::vector<double> every;
  for (const model::Scheduled& event : model.schedule)
    if (event.kind == model::Scheduled::Kind::every && changes_something(event.actions))
      every.push_back(model::evaluate(model, event.time->node, variables));
  for (const double each : every)
    if (std::abs(period / each - std::round(period / each)) > 1e-9 * (period / each)) return false;
  for (int sample = 0; sample < samples; ++sample) {
    for (std::size_t i = 0; i < model.states.size(); ++i)
      variables[model.states[i].variable] = low[i] + (high[i] - low[i]) * unit(random);
    const double t = begin + 3 * period * unit(random);
    variables[model::Layout::time] = t;
    const std::vector<double> now = model::evaluate(model, nodes, variables);
    variables[model::Layout::time] = t + period;
    const std::vector<double> later = model::evaluate(model, nodes, variables);
    for (std::size_t i = 0; i < now.size(); ++i)
      if (std::abs(now[i] - later[i]) > alike * (1 + std::abs(now[i]))) return false;
  }
  return true;
}

}  // namespace continuo::studies
