// Evaluates the modes that the lanes are in, one after the other.
#include <continuo/simulation/together/mode_equations.hpp>

namespace continuo::model {

ModeEquations::ModeEquations(const std::shared_ptr<const ModelProgram>& program,
                             std::span<const std::shared_ptr<NativeFunction>> codes, SeenRuns& runs)
    : autonomous(program->autonomous),
      program_(program),
      runs_(&runs),
      mode_place_(program->model.layout.states),
      rates_(program->model.states.size()) {
  for (std::size_t mode = 0; mode < codes.size(); ++mode) modes_.emplace_back(*program, codes[mode], mode);
}

std::vector<double> ModeEquations::parameters(std::size_t number, std::span<const double> variables) const {
  std::vector<double> p = LaneEquations::parameters(number, variables);
  set_mode(p, program_->model.start_mode);
  return p;
}

bool ModeEquations::is_in_one_mode(const Wide& mode) {
  return all(mode == Wide(mode[0]));
}

void ModeEquations::operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt,
                               const std::vector<double>& p) {
  modes_[static_cast<std::size_t>(p[mode_place_])](t, x, dxdt, p);
}

void ModeEquations::operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt,
                               const std::vector<Wide>& p) {
  if (modes_.size() == 1 || is_in_one_mode(p)) return modes_[mode_of(p, 0)](t, x, dxdt, p);
  const Wide& mode = p[mode_place_];
  for (std::size_t one = 0; one < modes_.size(); ++one) {
    const auto mine = mode == Wide(static_cast<double>(one));
    if (none(mine)) continue;
    modes_[one](t, x, rates_, p);
    for (std::size_t i = 0; i < dxdt.size(); ++i) dxdt[i] = select(mine, rates_[i], dxdt[i]);
  }
}

}  // namespace continuo::model
