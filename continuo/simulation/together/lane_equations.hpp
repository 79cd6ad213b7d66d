// dx/dt of a model for eight runs at once, each with parameters and inputs of its own, and for one: as `ensemble` calls
// it. Both give the same bits.
//
//   LaneEquations equations(*program, nullptr);
//   ensemble(equations, starts, {0, 10}, Dop853{});  // of RunStart{x, LaneEquations::parameters(run + 1, variables)}
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <continuo/ensembles/lanes/steps_by_system.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/step_formula.hpp>
#include <continuo/simulation/together/lane_derivatives.hpp>
#include <continuo/simulation/together/lane_tape.hpp>
#include <continuo/symbolic/native/c_step.hpp>

namespace continuo::model {

class LaneEquations {
 public:
  static constexpr std::size_t lanes = LaneTape::lanes;
  using Wide = LaneTape::Wide;

  /// Those of a mode of a model whose equations do not jump. `code`: their machine code, with the steps of the method
  /// that is used, or null.
  /// `derivatives`: for methods that ask for them.
  LaneEquations(const ModelProgram& program, std::shared_ptr<NativeFunction> code, std::size_t mode = 0,
                std::optional<LaneDerivatives> derivatives = {});

  /// The parameters of a run with these variables. `number` is not that of any other run, and at least 1.
  [[nodiscard]] static std::vector<double> parameters(std::size_t number, std::span<const double> variables);

  void operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt, const std::vector<double>& p);
  void operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt, const std::vector<Wide>& p);
  /// df/dx row by row, and df/dt, as ModelSystem has them.
  void jacobian(double t, const std::vector<double>& x, std::span<double> rows, const std::vector<double>& p);
  void jacobian(const Wide& t, const std::vector<Wide>& x, std::span<Wide> rows, const std::vector<Wide>& p);
  void time_derivative(double t, const std::vector<double>& x, std::vector<double>& dfdt, const std::vector<double>& p);
  void time_derivative(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dfdt, const std::vector<Wide>& p);
  /// A whole step of the method M by machine code, as M::step and M::error_square compute it. `square`: of the error,
  /// or null. `keeps_stages`: all are written to `work`, else only those that the next step needs. False where there is
  /// no such code: nothing is done then.
  template <class M>
  [[nodiscard]] bool take_step(const Wide& t, const std::vector<Wide>& x, const Wide& h, const std::vector<Wide>& p,
                               typename M::template Workspace<std::vector<Wide>>& work, std::vector<Wide>& x_new,
                               const Tolerance<Wide>& tolerance, Wide* square, bool keeps_stages);

  /// Many steps of two groups of runs by machine code, see ensembles/lanes/steps_by_system.hpp.
  static constexpr std::size_t motions_at_once = 2;
  template <class M>
  [[nodiscard]] bool can_take_steps() const {
    constexpr LaneSteps none{};
    const NativeLaneEvaluation native = rates_.code();
    return native != nullptr && native(nullptr, nullptr, nullptr, nullptr, &none) != 0;
  }
  template <class M, class Motion>
  static void take_steps(std::array<Motion, motions_at_once>& motions,
                         const continuo::detail::StepSizeRules<Wide>& rules);

  /// What `ensemble` asks of a system.
  bool autonomous;

 private:
  template <class Number>
  [[nodiscard]] static auto* numbers(Number* wide) {
    return reinterpret_cast<typename Number::Scalar*>(const_cast<std::remove_const_t<Number>*>(wide));
  }
  // What the derivatives do not give, of one run.
  void replace_not_finite(double t, const std::vector<double>& x, std::span<double> rows, const std::vector<double>& p);
  // Calls `act(lane, t)` for each lane in which some of these are not finite, with its state in x_ and p_.
  template <class Act>
  void for_each_not_finite(std::span<const Wide> numbers, const Wide& t, const std::vector<Wide>& x,
                           const std::vector<Wide>& p, const Act& act);

  LaneTape rates_;
  std::optional<LaneDerivatives> derivatives_;
  bool follows_tables_;                  // an input does, over time
  std::vector<double> x_, p_, entries_;  // of one lane
  std::vector<double> now_;
  std::vector<Wide> wide_now_;
};

template <class M>
bool LaneEquations::take_step(const Wide& t, const std::vector<Wide>& x, const Wide& h, const std::vector<Wide>& p,
                              typename M::template Workspace<std::vector<Wide>>& work, std::vector<Wide>& x_new,
                              const Tolerance<Wide>& tolerance, Wide* square, bool keeps_stages) {
  const NativeLaneEvaluation native = rates_.code();
  if (native == nullptr) return false;
  constexpr std::size_t stages = M::tableau.stages;
  std::array<double*, stages> k;
  for (std::size_t j = 0; j < stages; ++j) k[j] = numbers(work.k[j].data());
  const LaneStep step{.t = numbers(&t),
                      .x = numbers(x.data()),
                      .h = numbers(&h),
                      .evaluates_start = work.start_fresh ? 0 : 1,
                      .keeps_stages = keeps_stages ? 1 : 0,
                      .stages = k.data(),
                      .x_new = numbers(x_new.data()),
                      .square = square ? numbers(square) : nullptr,
                      .rtol = numbers(tolerance.rtol_each ? tolerance.rtol_each : &tolerance.rtol),
                      .atol = numbers(tolerance.atol_each ? tolerance.atol_each : &tolerance.atol),
                      .rtol_each = tolerance.rtol_each ? 1 : 0,
                      .atol_each = tolerance.atol_each ? 1 : 0};
  native(rates_.registers(p), nullptr, nullptr, &step, nullptr);
  work.start_fresh = true;
  work.end_fresh = M::tableau.first_same_as_last();
  return true;
}

template <class M, class Motion>
void LaneEquations::take_steps(std::array<Motion, motions_at_once>& motions,
                               const continuo::detail::StepSizeRules<Wide>& rules) {
  std::array<LaneMotion, motions_at_once> all{};
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Motion& one = motions[i];
    all[i] = {.registers = one.system->rates_.registers(*one.p),
              .t = numbers(&one.sizes.t),
              .next = numbers(&one.sizes.next),
              .carried = numbers(&one.sizes.carried),
              .steps = numbers(&one.sizes.steps),
              .x = numbers(one.x->data()),
              .last = numbers(&one.sizes.last),
              .before_last = numbers(&one.sizes.before_last),
              .rejects = numbers(&one.sizes.rejects),
              .limit = numbers(&one.sizes.limit),
              .longest = numbers(&one.sizes.longest),
              .until = numbers(&one.sizes.limit),
              .active = numbers(&one.sizes.active),
              .x_new = numbers(one.x_new->data()),
              .square = numbers(one.square),
              .first_stage = numbers(one.first_stage->data()),
              .last_stage = numbers(one.last_stage->data()),
              .evaluates_start = one.evaluates_start ? 1 : 0,
              .waits = 0};
  }
  LaneSteps steps = steps_by(rules.controller, rules.error_order, rules.tolerance);
  steps.motions = all.data();
  steps.count = static_cast<long long>(motions.size());
  steps.most = static_cast<long long>(rules.most);
  steps.forward = rules.forward;
  motions.front().system->rates_.code()(nullptr, nullptr, nullptr, nullptr, &steps);
  for (std::size_t i = 0; i < motions.size(); ++i) motions[i].waits = all[i].waits != 0;
}

}  // namespace continuo::model
