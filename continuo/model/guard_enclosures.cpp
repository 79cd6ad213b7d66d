#include <algorithm>
#include <utility>

#include <continuo/model/guard_enclosures.hpp>

namespace continuo::model {

GuardEnclosures::GuardEnclosures(const ModelProgram& program, std::vector<std::vector<Guard>> guards, std::size_t count)
    : program_(&program), place_(count, none) {
  for (std::vector<Guard>& of_mode : guards) modes_.push_back({.guards = std::move(of_mode), .all = {}, .alone = {}});
}

void GuardEnclosures::take(const ModelSystem& system, const Step& step) {
  step_ = step;
  OfMode& mine = modes_[system.mode()];
  all_ = nullptr;
  if (mine.guards.empty()) {
    if (std::exchange(mode_, system.mode()) != system.mode()) std::ranges::fill(place_, none);
    return;
  }
  if (!mine.all) {
    variables_ = system.variables();
    variables_.resize(program_->tape_variables().variables);
    std::vector<NodeId> nodes;
    for (const Guard& guard : mine.guards) nodes.push_back(guard.node);
    mine.all.emplace(*program_, nodes, variables_);
    mine.alone.resize(mine.guards.size());
  }
  all_ = &*mine.all;
  if (mode_ == system.mode() && !system.has_switches()) return;
  mode_ = system.mode();
  std::ranges::fill(place_, none);
  for (std::size_t k = 0; k < mine.guards.size(); ++k)
    if (!mine.guards[k].surface || !system.slides_along(*mine.guards[k].surface)) place_[mine.guards[k].number] = k;
  const std::span<const double> values = system.switch_values();
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::uint32_t variable = program_->switches[mode_].switches[k].variable;
    if (variables_[variable] != values[k]) set(variable, values[k]);
  }
}

StepEnclosure& GuardEnclosures::alone(std::size_t number) {
  OfMode& mine = modes_[mode_];
  std::optional<StepEnclosure>& one = mine.alone[place_[number]];
  if (!one) one.emplace(*program_, std::span(&mine.guards[place_[number]].node, 1), variables_);
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
