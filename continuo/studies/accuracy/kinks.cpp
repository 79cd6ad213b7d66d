// Finds the instants at which a run passes a jump or a bend of its equations.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/jumps.hpp>
#include <continuo/simulation/program/switches.hpp>
#include <continuo/studies/accuracy/kinks.hpp>

namespace continuo::studies {

namespace {

using model::Op;

/// On which side of its place, or in which of its pieces, an operation is with these arguments; NaN on the place
/// itself.
double piece_of(Op op, double a, double b) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  switch (op) {
    case Op::absolute:
    case Op::sign:
      return a > 0 ? 1 : a < 0 ? -1 : none;
    case Op::floor:
    case Op::ceiling:
      return std::floor(a);
    case Op::modulo:
      return std::floor(a / b);
    default:
      return a > b ? 1 : a < b ? -1 : none;
  }
}

bool bends(Op op) {
  return op == Op::absolute || op == Op::minimum || op == Op::maximum;
}

std::vector<model::Jump> places_of(const model::Model& model) {
  std::vector<model::Jump> places;
  for (const model::Mode& mode : model.modes) {
    for (std::size_t i = 0; i < mode.derivatives.size(); ++i) {
      for (const model::NodeId id : model::reachable(model.graph, std::span(&mode.derivatives[i], 1))) {
        const model::Node& node = model.graph[id];
        if (!bends(node.op) && !model::is_jump(node.op)) continue;
        if (std::ranges::find(places, id, &model::Jump::node) != places.end()) continue;
        places.push_back({i, id, node.a, model::arity(node.op) == 2 ? node.b : node.a});
      }
    }
  }
  return places;
}

}  // namespace

std::vector<Kink> kinks_along(const model::ModelProgram& program, const model::Run& run) {
  const model::Model& model = program.model;
  const std::vector<model::Jump> places = places_of(model);
  std::vector<model::NodeId> arguments;
  for (const model::Jump& place : places) {
    arguments.push_back(place.first);
    arguments.push_back(place.second);
  }
  model::Evaluation evaluation(program.tape_of(arguments), run.plan.variables);
  std::vector<Kink> kinks;
  for (const model::Jump& place : places)
    kinks.push_back({place.state, model::text_of(model, place), !bends(model.graph[place.node].op), 0, 0});
  std::vector<double> values(arguments.size()), pieces(places.size(), std::nan(""));
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const double t = run.motion.time(row);
    for (const model::TableInput& input : program.step_inputs) evaluation.set(input.variable, input.table.value(t));
    evaluation(t, run.motion.state(row), values);
    for (std::size_t p = 0; p < places.size(); ++p) {
      const double piece = piece_of(model.graph[places[p].node].op, values[2 * p], values[2 * p + 1]);
      if (std::isnan(piece)) continue;
      if (!std::isnan(pieces[p]) && piece != pieces[p] && kinks[p].times++ == 0) kinks[p].first = t;
      pieces[p] = piece;
    }
  }
  std::erase_if(kinks, [](const Kink& kink) { return kink.times == 0; });
  std::ranges::sort(kinks, {}, &Kink::first);
  return kinks;
}

}  // namespace continuo::studies
