// Evaluates the modes that the lanes are in, one after the other.
#include <utility>

#include <continuo/simulation/together/mode_equations.hpp>

namespace continuo::model {

ModeEquations::ModeEquations(const std::shared_ptr<const ModelProgram>& program, std::vector<LaneEquations> modes,
                             SeenRuns& runs)
    : autonomous(program->autonomous),
      program_(program),
      modes_(std::move(modes)),
      runs_(&runs),
      mode_place_(program->model.layout.states) {}

std::vector<double> ModeEquations::parameters(std::size_t number, std::span<const double> variables) const {
  std::vector<double> p = LaneEquations::parameters(number, variables);
  set_mode(p, program_->model.start_mode);
  return p;
}

bool ModeEquations::is_in_one_mode(const Wide& mode) {
  return all(mode == Wide(mode[0]));
}

template <class Numbers, class Write>
void ModeEquations::write_by_mode(const std::vector<Wide>& p, Numbers& numbers, const Write& write) {
  if (modes_.size() == 1 || is_in_one_mode(p)) return write(modes_[mode_of(p, 0)], numbers);
  of_mode_.resize(numbers.size());
  const Wide& mode = p[mode_place_];
  for (std::size_t one = 0; one < modes_.size(); ++one) {
    const auto mine = mode == Wide(static_cast<double>(one));
    if (none(mine)) continue;
    write(modes_[one], of_mode_);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = select(mine, of_mode_[i], numbers[i]);
  }
}

void ModeEquations::operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt,
                               const std::vector<double>& p) {
  mode_of(p)(t, x, dxdt, p);
}

void ModeEquations::operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt,
                               const std::vector<Wide>& p) {
  write_by_mode(p, dxdt, [&](LaneEquations& mode, std::vector<Wide>& rates) { mode(t, x, rates, p); });
}

void ModeEquations::jacobian(double t, const std::vector<double>& x, std::span<double> rows,
                             const std::vector<double>& p) {
  mode_of(p).jacobian(t, x, rows, p);
}

void ModeEquations::jacobian(const Wide& t, const std::vector<Wide>& x, std::span<Wide> rows,
                             const std::vector<Wide>& p) {
  write_by_mode(p, rows, [&](LaneEquations& mode, std::span<Wide> entries) { mode.jacobian(t, x, entries, p); });
}

void ModeEquations::time_derivative(double t, const std::vector<double>& x, std::vector<double>& dfdt,
                                    const std::vector<double>& p) {
  mode_of(p).time_derivative(t, x, dfdt, p);
}

void ModeEquations::time_derivative(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dfdt,
                                    const std::vector<Wide>& p) {
  write_by_mode(p, dfdt,
                [&](LaneEquations& mode, std::vector<Wide>& slopes) { mode.time_derivative(t, x, slopes, p); });
}

}  // namespace continuo::model
