// Chooses the guards that can be enclosed in each mode, and encloses them over a step.
#include <algorithm>
#include <utility>

#include <continuo/simulation/program/guard_enclosures.hpp>

namespace continuo::model {

GuardEnclosures::GuardEnclosures(const ModelProgram& program, std::vector<std::vector<Guard>> guards, std::size_t count)
    : program_(&program), place_(count, none) {
  for (std::vector<Guard>& of_mode : guards)
    modes_.push_back({.guards = std::move(of_mode), .blocks = {}, .switches = {}, .all = {}, .alone = {}});
}

void GuardEnclosures::take(const ModelSystem& system, const Step& step) {
  step_ = step;
  OfMode& mine = modes_[system.mode()];
  all_ = nullptr;
  if (!mine.guards.empty() && !mine.all) make(mine, system);
  if (mine.guards.empty()) {
    if (std::exchange(mode_, system.mode()) != system.mode()) std::ranges::fill(place_, none);
    return;
  }
  all_ = &*mine.all;
  if (mode_ == system.mode() && !system.has_switches()) return;
  mode_ = system.mode();
  std::ranges::fill(place_, none);
  for (std::size_t k = 0; k < mine.guards.size(); ++k)
    if (is_enclosed(mine, k, system)) place_[mine.guards[k].number] = k;
  const std::span<const double> values = system.switch_values();
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::uint32_t variable = program_->switches[mode_].switches[k].variable;
    if (variables_[variable] != values[k]) set(variable, values[k]);
  }
}

namespace {

/// Those that are not part of another.
std::vector<UnknownBlock> greatest(std::span<const UnknownBlock> blocks) {
  std::vector<UnknownBlock> found;
  for (const UnknownBlock& block : blocks) {
    const auto holds = [](const UnknownBlock& a, const UnknownBlock& b) {
      return std::ranges::includes(a.components, b.components);
    };
    if (std::ranges::any_of(found, [&](const UnknownBlock& other) { return holds(other, block); })) continue;
    std::erase_if(found, [&](const UnknownBlock& other) { return holds(block, other); });
    if (!block.empty()) found.push_back(block);
  }
  return found;
}

}  // namespace

void GuardEnclosures::make(OfMode& mine, const ModelSystem& system) {
  if (variables_.empty()) {
    variables_ = system.variables();
    variables_.resize(program_->tape_variables().variables);
  }
  std::vector<Guard> guards;
  std::optional<UnknownCoupling> coupling;
  for (const Guard& guard : mine.guards) {
    if (guard.reads_unknowns && !coupling) coupling.emplace(*program_, system.equations());
    std::optional<UnknownBlock> block = guard.reads_unknowns ? coupling->block(guard.node) : UnknownBlock{};
    if (!block) continue;
    guards.push_back(guard);
    mine.switches.push_back(switches_of(*block, system.mode()));
    mine.blocks.push_back(std::move(*block));
  }
  mine.guards = std::move(guards);
  if (mine.guards.empty()) return;
  std::vector<NodeId> nodes;
  for (const Guard& guard : mine.guards) nodes.push_back(guard.node);
  mine.all.emplace(*program_, nodes, variables_, greatest(mine.blocks));
  mine.alone.resize(mine.guards.size());
}

std::vector<std::size_t> GuardEnclosures::switches_of(const UnknownBlock& block, std::size_t mode) const {
  std::vector<std::size_t> found;
  const std::vector<std::uint32_t> read = variables_of(program_->model.graph, block.residuals);
  const std::vector<Switch>& switches = program_->switches[mode].switches;
  for (std::size_t k = 0; k < switches.size(); ++k)
    if (std::ranges::find(read, switches[k].variable) != read.end()) found.push_back(k);
  return found;
}

bool GuardEnclosures::is_enclosed(const OfMode& mine, std::size_t k, const ModelSystem& system) {
  const Guard& guard = mine.guards[k];
  if (guard.surface) return !system.slides_along(*guard.surface);
  if (!guard.reads_unknowns) return true;
  const std::vector<std::uint32_t>& unknowns = mine.blocks[k].components;
  // Where the motion slides, the equations that read the switch are mixed.
  return std::ranges::none_of(mine.switches[k], [&](std::size_t j) { return system.slides_along(j); }) &&
         std::ranges::none_of(system.held(), [&](std::size_t i) { return std::ranges::binary_search(unknowns, i); });
}

StepEnclosure& GuardEnclosures::alone(std::size_t number) {
  OfMode& mine = modes_[mode_];
  std::optional<StepEnclosure>& one = mine.alone[place_[number]];
  if (!one) {
    one.emplace(*program_, std::span(&mine.guards[place_[number]].node, 1), variables_,
                std::span(&mine.blocks[place_[number]], mine.blocks[place_[number]].empty() ? 0 : 1));
  }
  return *one;
}

EnclosureWithSlope<double> GuardEnclosures::over(std::size_t number, double from, double to) {
  return alone(number).over(step_, from, to).front();
}

Enclosure<double> GuardEnclosures::value(std::size_t number, double at) {
  return alone(number).values_over(step_, at, at).front();
}

void GuardEnclosures::set(std::uint32_t variable, double value) {
  if (variable < variables_.size()) variables_[variable] = value;
  for (OfMode& mine : modes_) {
    if (mine.all) mine.all->set(variable, value);
    for (std::optional<StepEnclosure>& one : mine.alone)
      if (one) one->set(variable, value);
  }
}

}  // namespace continuo::model
