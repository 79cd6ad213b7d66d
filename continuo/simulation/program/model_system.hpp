// continuo/simulation/program/model_system.hpp
// A model as a System for states of run-time size: what `solve` integrates. It knows its mode and the present values
// of parameters and inputs; a copy is a checkpoint.
//
//   ModelSystem system(program, start_values(model));
//   system(t, x, dxdt);
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_derivatives.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/solution_series.hpp>
#include <continuo/simulation/program/step_formula.hpp>
#include <continuo/simulation/program/switched_motion.hpp>
#include <continuo/solve/steps/own_steps.hpp>
#include <continuo/system/system.hpp>

namespace continuo::model {

class ModelSystem {
 public:
  using X = std::vector<double>;

  /// `variables` is a whole register file as `start_values` gives it; the run begins in the model's start mode.
  ModelSystem(std::shared_ptr<const ModelProgram> program, std::span<const double> variables);
  // Compiled once, not with every method: there is much to copy.
  ModelSystem(const ModelSystem&);
  ModelSystem(ModelSystem&&) noexcept;
  ModelSystem& operator=(const ModelSystem&);
  ModelSystem& operator=(ModelSystem&&) noexcept;
  ~ModelSystem();

  void operator()(double t, const X& x, X& dxdt) {
    if (switched_ && switched_->any(mode_)) {
      switched_->rates(mode_, t, x, dxdt);
    } else {
      derivatives_[mode_](t, x, dxdt);
    }
    for (const std::size_t i : held_) dxdt[i] = 0;
  }
  /// A step of the explicit Runge-Kutta method M by machine code, as detail::TakesSteps says. False where there is none
  /// (yet), where the jumps of the equations are located, and where states are held.
  template <class M>
  [[nodiscard]] bool take_step(double t, const X& x, double h, typename M::template Workspace<X>& work, X& x_new);

  /// Many steps by machine code, as detail::OwnSteps says; 0 where there is none.
  template <class M>
  [[nodiscard]] std::size_t take_steps(const continuo::detail::OwnSteps<X>& own);

  [[nodiscard]] std::size_t mode() const { return mode_; }
  void go(std::size_t mode) { mode_ = mode; }
  /// A parameter or an input.
  void set(std::uint32_t variable, double value);
  [[nodiscard]] double value(std::uint32_t variable) const { return variables_[variable]; }
  /// Parameters and inputs as in this register file.
  void set_all(std::span<const double> variables);
  /// These states stand still from now on, whatever the equations say: somebody holds them.
  void hold(std::vector<std::size_t> states) { held_ = std::move(states); }
  [[nodiscard]] std::span<const std::size_t> held() const { return held_; }

  /// The guards that are active in the present mode; values[i] for Model::events[i], the others are left alone. That of
  /// a condition is never zero: its sign says whether the condition holds.
  void guards(double t, const X& x, std::span<double> values);
  /// The expressions of the block of Model::events[i] or Model::schedule[i].
  [[nodiscard]] std::vector<double> event_expressions(std::size_t i, double t, const X& x) {
    return event_blocks_[i](t, x);
  }
  [[nodiscard]] std::vector<double> limit_expressions(std::size_t i, double t, const X& x) {
    return limit_blocks_[i](t, x);
  }
  [[nodiscard]] std::vector<double> schedule_expressions(std::size_t i, double t, const X& x) {
    return schedule_blocks_[i](t, x);
  }

  /// From now on the jumps of the equations are located: their switches are held until `pass` or `settle` says
  /// otherwise (SwitchedMotion). Before, every evaluation decides them anew.
  void hold_switches(double t, const X& x);
  void settle_switches(double t, const X& x, const X* before);
  [[nodiscard]] Passage pass_switch(std::size_t k, double t, const X& x);
  void switch_guards(double t, const X& x, std::span<double> values) { switched_->guards(mode_, t, x, values); }
  [[nodiscard]] bool has_switches() const { return switched_ && switched_->any(mode_); }
  [[nodiscard]] bool slides() const { return switched_ && switched_->slides(); }
  [[nodiscard]] bool slides_along(std::size_t k) const { return switched_ && switched_->slides_along(k); }
  [[nodiscard]] std::span<const SwitchedMotion::Sliding> sliding() const {
    return has_switches() ? switched_->sliding() : std::span<const SwitchedMotion::Sliding>();
  }
  [[nodiscard]] std::span<const double> switch_values() const {
    return has_switches() ? switched_->values() : std::span<const double>();
  }
  /// The right-hand sides and residuals of the present mode, with its switches held where these are.
  [[nodiscard]] std::span<const NodeId> equations() const {
    return has_switches() ? program_->switches[mode_].derivatives : model().modes[mode_].derivatives;
  }
  /// For checkpoints. A system that locates the jumps of its equations is read into one that does.
  template <class Archive>
  void transfer(Archive& archive) {
    std::size_t mode = mode_;
    archive.index(mode, model().modes.size() - 1);
    std::vector<double> variables = variables_;
    archive(variables);
    if constexpr (Archive::reads) {
      go(mode);
      set_all(variables);
    }
    if (switched_) switched_->transfer(archive, mode);
    if constexpr (Archive::reads) place_switches();
  }
  [[nodiscard]] const std::vector<double>& variables() const { return variables_; }

  [[nodiscard]] const ModelProgram& program() const { return *program_; }
  [[nodiscard]] const Model& model() const { return program_->model; }

  // What solve and the methods ask of a System.
  bool autonomous;
  [[nodiscard]] std::string_view component_name(std::size_t i) const { return model().states[i].column; }
  [[nodiscard]] std::size_t pair_count(std::size_t) const { return model().pairs.size(); }
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t) const { return model().pairs[i]; }
  /// df/dx, n*n row by row, and where it may differ from zero in any mode. The first call differentiates and compiles.
  void jacobian(double t, const X& x, std::span<double> rows);
  [[nodiscard]] const SparsePattern& jacobian_pattern() { return derivatives_of_f().pattern(); }
  void jacobian_values(double t, const X& x, std::span<double> values);
  void jacobian_band(double t, const X& x, std::span<double> band);
  void time_derivative(double t, const X& x, X& dfdt);
  /// The series of the solution, x(t + scale s), from c[0] on; see HasTaylorCoefficients. The first call compiles.
  [[nodiscard]] std::string_view taylor_coefficients(double t, double scale, std::span<double> c);
  /// Many steps of the series by machine code, as SeriesSteps says; 0 where there is none (yet), and where states are
  /// held or the jumps of the equations are located.
  [[nodiscard]] std::size_t take_series_steps(SeriesSteps<double>& steps);
  /// Whether such steps watch the guards of all events of the present mode.
  [[nodiscard]] bool watches_guards() const {
    return series_ && series_mode_ == mode_ && !has_switches() && series_->watches_guards();
  }
  /// Whether a series may not show what comes within a step: the equations depend on time, or they have jumps or
  /// corners that are not switches.
  [[nodiscard]] bool has_corners() const { return !autonomous || (series_ && series_->has_corners()); }
  [[nodiscard]] bool has_mass() const { return model().needs_dae_solver(); }
  [[nodiscard]] double mass(std::size_t i) const { return model().states[i].algebraic ? 0 : 1; }
  [[nodiscard]] bool ignores_velocity(const X&) const { return !model().accelerations_depend_on_velocities; }

 private:
  template <class Visit>
  void for_each(Visit&& visit);
  void place_switches();
  [[nodiscard]] NativeLaneEvaluation step_code(StepFormula formula);
  template <class Place>
  void take_differences(double t, const X& x, std::span<double> values, Place place);
  [[nodiscard]] ModelDerivatives& derivatives_of_f();

  std::shared_ptr<const ModelProgram> program_;
  std::size_t mode_;
  std::vector<double> variables_;  // parameters and inputs as they are now
  std::optional<ModelDerivatives> derivatives_of_f_;
  std::optional<SwitchedMotion> switched_;
  std::optional<SolutionSeries> series_;  // of the mode `series_mode_`
  std::size_t series_mode_ = 0;
  std::vector<Evaluation> derivatives_, guards_, truths_, event_blocks_, limit_blocks_, schedule_blocks_;
  std::vector<double> guard_values_;
  std::vector<std::size_t> held_;
  /// Of one method; null where there is no compiler.
  struct StepCode {
    StepFormula formula = nullptr;
    std::shared_ptr<NativeFunction> code;
    std::uint64_t operations = 0;  // of a step
  };
  std::vector<StepCode> step_codes_;  // by mode
};

template <class M>
bool ModelSystem::take_step(double t, const X& x, double h, typename M::template Workspace<X>& work, X& x_new) {
  const NativeLaneEvaluation code = step_code(step_formula_of<M>);
  if (code == nullptr) return false;
  std::array<double*, M::tableau.stages> stages;
  for (std::size_t j = 0; j < stages.size(); ++j) stages[j] = work.k[j].data();
  auto& own = work.own;
  const Tolerance<double>& tolerance = own.tolerance;
  own.has_square = M::error_order > 0;
  const LaneStep step{.t = &t,
                      .x = x.data(),
                      .h = &h,
                      .evaluates_start = work.start_fresh ? 0 : 1,
                      .keeps_stages = 1,
                      .stages = stages.data(),
                      .x_new = x_new.data(),
                      .square = own.has_square ? &own.square : nullptr,
                      .rtol = tolerance.rtol_each ? tolerance.rtol_each : &tolerance.rtol,
                      .atol = tolerance.atol_each ? tolerance.atol_each : &tolerance.atol,
                      .rtol_each = tolerance.rtol_each ? 1 : 0,
                      .atol_each = tolerance.atol_each ? 1 : 0};
  code(derivatives_[mode_].registers(), nullptr, nullptr, &step, nullptr);
  work.start_fresh = true;
  work.end_fresh = M::tableau.first_same_as_last();
  return true;
}

template <class M>
std::size_t ModelSystem::take_steps(const continuo::detail::OwnSteps<X>& own) {
  const NativeLaneEvaluation code = step_code(step_formula_of<M>);
  if (code == nullptr || own.most == 0) return 0;
  constexpr double active = 1;
  double made = 0;
  float rejects = 0;
  LaneMotion motion{.registers = derivatives_[mode_].registers(),
                    .t = &own.t,
                    .next = &own.next,
                    .carried = &own.carried,
                    .steps = &made,
                    .x = own.x.data(),
                    .last = &own.errors.last,
                    .before_last = &own.errors.before_last,
                    .rejects = &rejects,
                    .limit = &own.limit,
                    .longest = &own.longest,
                    .until = &own.until,
                    .active = &active,
                    .x_new = nullptr,
                    .square = nullptr,
                    .first_stage = own.slope.data(),
                    .last_stage = nullptr,
                    .evaluates_start = 0,
                    .waits = 0};
  LaneSteps steps = steps_by(own.controller, M::error_order, own.tolerance);
  steps.motions = &motion;
  steps.count = 1;
  steps.most = static_cast<long long>(own.most);
  steps.forward = own.forward;
  static_cast<void>(code(nullptr, nullptr, nullptr, nullptr, &steps));
  return static_cast<std::size_t>(made);
}

}  // namespace continuo::model
