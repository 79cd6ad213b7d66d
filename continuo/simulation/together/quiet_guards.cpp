// Encloses the guards of a mode.
#include <algorithm>

#include <continuo/simulation/together/quiet_guards.hpp>

namespace continuo::model {

QuietGuards::QuietGuards(const ModelProgram& program) : states_begin_(program.model.layout.states) {
  const std::size_t states = program.model.states.size();
  std::vector<char> is_read(states);
  for (const ProgramGuards& guards : program.guards) {
    std::vector<NodeId> nodes;
    for (const std::size_t event : guards.events) nodes.push_back(program.enclosed[event]);
    OfMode& mine = modes_.emplace_back();
    mine.tape = program.shared_tape_of(nodes);
    mine.reads.resize(states);
    mine.reads_time = !program.linear_inputs.empty();  // whose tables are read by time
    for (const std::uint32_t variable : variables_of(program.model.graph, nodes)) {
      mine.reads_time = mine.reads_time || variable == Layout::time;
      const std::uint32_t component = variable - states_begin_;
      if (variable >= states_begin_ && component < states) mine.reads[component] = is_read[component] = 1;
    }
  }
  for (std::uint32_t i = 0; i < states; ++i)
    if (is_read[i] != 0) components_.push_back(i);
}

void QuietGuards::begin(std::span<const double> variables) {
  variables_.assign(variables.begin(), variables.end());
  for (OfMode& mine : modes_) mine.registers.forget();
}

TapeRegisters<Enclosure<double>>& QuietGuards::registers(std::size_t mode) {
  OfMode& mine = modes_[mode];
  mine.registers.prepare(*mine.tape, variables_);
  return mine.registers;
}

void QuietGuards::set_component(std::size_t mode, std::uint32_t component, double lo, double hi) {
  if (modes_[mode].reads[component] == 0) return;
  const bool is_known = hi - lo < Enclosure<double>::infinity;  // not where one is not a number
  registers(mode)[states_begin_ + component] = is_known ? Enclosure<double>(lo, hi) : Enclosure<double>::entire();
}

void QuietGuards::set_time(std::size_t mode, const Enclosure<double>& over) {
  if (modes_[mode].reads_time) registers(mode)[Layout::time] = over;
}

bool QuietGuards::stay(std::size_t mode) {
  return std::ranges::all_of(registers(mode).evaluate(*modes_[mode].tape),
                             [](const Enclosure<double>& g) { return g.lo > 0 || g.hi < 0; });
}

}  // namespace continuo::model
