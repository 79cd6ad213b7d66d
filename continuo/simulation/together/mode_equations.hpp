// dx/dt of a model with events for eight runs at once, each in a mode of its own, and the runs themselves: as
// `ensemble` takes them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/simulation/together/lane_equations.hpp>
#include <continuo/simulation/together/seen_run.hpp>

namespace continuo::model {

template <class M>
class RunOfModel;

class ModeEquations {
 public:
  static constexpr std::size_t lanes = LaneEquations::lanes;
  using Wide = LaneEquations::Wide;
  /// What `ensemble` takes for a run.
  template <class M>
  using Run = RunOfModel<M>;

  /// Of a model whose equations do not jump: those of each mode.
  ModeEquations(const std::shared_ptr<const ModelProgram>& program, std::vector<LaneEquations> modes, SeenRuns& runs);

  /// The parameters of a run with these variables, at its beginning. `number` is not that of any other run, and at
  /// least 1.
  [[nodiscard]] std::vector<double> parameters(std::size_t number, std::span<const double> variables) const;
  /// The mode is among them.
  void set_mode(std::vector<double>& p, std::size_t mode) const { p[mode_place_] = static_cast<double>(mode); }

  void operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt, const std::vector<double>& p);
  void operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt, const std::vector<Wide>& p);
  /// df/dx row by row, and df/dt, as LaneEquations has them.
  void jacobian(double t, const std::vector<double>& x, std::span<double> rows, const std::vector<double>& p);
  void jacobian(const Wide& t, const std::vector<Wide>& x, std::span<Wide> rows, const std::vector<Wide>& p);
  void time_derivative(double t, const std::vector<double>& x, std::vector<double>& dfdt, const std::vector<double>& p);
  void time_derivative(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dfdt, const std::vector<Wide>& p);
  /// A whole step by machine code, where all lanes are in one mode that has some: see LaneEquations.
  template <class M>
  [[nodiscard]] bool take_step(const Wide& t, const std::vector<Wide>& x, const Wide& h, const std::vector<Wide>& p,
                               typename M::template Workspace<std::vector<Wide>>& work, std::vector<Wide>& x_new,
                               const Tolerance<Wide>& tolerance, Wide* square, bool keeps_stages) {
    return is_in_one_mode(p) &&
           modes_[mode_of(p, 0)].template take_step<M>(t, x, h, p, work, x_new, tolerance, square, keeps_stages);
  }

  [[nodiscard]] const ModelProgram& program() const { return *program_; }
  /// Who the runs are made for.
  [[nodiscard]] SeenRuns& runs() const { return *runs_; }
  /// Whether a run watches any guard.
  [[nodiscard]] bool any_guard() const { return !program_->model.events.empty(); }

  /// What `ensemble` asks of a system.
  bool autonomous;

 private:
  [[nodiscard]] static bool is_in_one_mode(const Wide& mode);
  [[nodiscard]] bool is_in_one_mode(const std::vector<Wide>& p) const { return is_in_one_mode(p[mode_place_]); }
  [[nodiscard]] LaneEquations& mode_of(const std::vector<double>& p) {
    return modes_[static_cast<std::size_t>(p[mode_place_])];
  }
  // Lets the mode of each lane write to its lane: `write(mode, numbers)`.
  template <class Numbers, class Write>
  void write_by_mode(const std::vector<Wide>& p, Numbers& numbers, const Write& write);
  [[nodiscard]] std::size_t mode_of(const std::vector<Wide>& p, std::size_t lane) const {
    return static_cast<std::size_t>(p[mode_place_][lane]);
  }

  std::shared_ptr<const ModelProgram> program_;
  std::vector<LaneEquations> modes_;
  SeenRuns* runs_;
  std::uint32_t mode_place_;   // that of a state, which is no parameter
  std::vector<Wide> of_mode_;  // what one mode gives
};

}  // namespace continuo::model
