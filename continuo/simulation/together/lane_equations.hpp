// dx/dt of a model for eight runs at once, each with parameters and inputs of its own, and for one: as `ensemble` calls
// it. Both give the same bits.
//
//   LaneEquations equations(*program, nullptr);
//   ensemble(equations, starts, {0, 10}, Dop853{});  // of RunStart{x, LaneEquations::parameters(run + 1, variables)}
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/numerics/lanes.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/c_step.hpp>
#include <continuo/symbolic/native/native_function.hpp>
#include <continuo/symbolic/tape/tape_lanes.hpp>

namespace continuo::model {

class LaneEquations {
 public:
  static constexpr std::size_t lanes = TapeLanes::width;  // at once, and no others
  using Wide = Lanes<double, lanes>;

  /// Those of a mode of a model whose equations do not jump. `code`: their machine code, with the steps of the method
  /// that is used, or null.
  LaneEquations(const ModelProgram& program, std::shared_ptr<NativeFunction> code, std::size_t mode = 0);

  /// The parameters of a run with these variables. `number` is not that of any other run, and at least 1.
  [[nodiscard]] static std::vector<double> parameters(std::size_t number, std::span<const double> variables);

  void operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt, const std::vector<double>& p);
  void operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt, const std::vector<Wide>& p);
  /// A whole step of the method M by machine code, as M::step and M::error_square compute it. `square`: of the error,
  /// or null. `keeps_stages`: all are written to `work`, else only those that the next step needs. False where there is
  /// no such code: nothing is done then.
  template <class M>
  [[nodiscard]] bool take_step(const Wide& t, const std::vector<Wide>& x, const Wide& h, const std::vector<Wide>& p,
                               typename M::template Workspace<std::vector<Wide>>& work, std::vector<Wide>& x_new,
                               const Tolerance<Wide>& tolerance, Wide* square, bool keeps_stages);

  /// What `ensemble` asks of a system.
  bool autonomous;

 private:
  template <class Register>
  struct Registers {
    std::vector<Register> all, rates;
  };
  template <class Register>
  void evaluate(Registers<Register>& registers, const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt,
                const std::vector<Wide>& p);
  [[nodiscard]] bool is_state(std::size_t variable) const {
    return variable >= states_begin_ && variable < states_end_;
  }

  void set_parameters(const std::vector<Wide>& p);
  template <class Register>
  void set_parameters(Registers<Register>& registers, const std::vector<Wide>& p);
  [[nodiscard]] double* all_registers() {
    return wide_lanes_.all.empty() ? lanes_.all.front().numbers.data() : wide_lanes_.all.front().numbers.data();
  }
  template <class Register>
  void evaluate_tape(Registers<Register>& registers, const std::vector<Wide>& x, std::vector<Wide>& dxdt);
  void count_use();

  std::shared_ptr<const Tape> tape_;
  std::shared_ptr<NativeFunction> code_;
  std::uint64_t operations_;     // of an evaluation
  std::uint64_t uncounted_ = 0;  // operations
  std::size_t states_begin_, states_end_;
  std::vector<double> registers_;  // of one run
  Registers<TapeLanes> lanes_;     // one of the two is used
  Registers<WideTapeLanes> wide_lanes_;
  double run_ = 0;  // whose parameters are in the registers
  Wide runs_{};     // and of each lane
};

template <class M>
bool LaneEquations::take_step(const Wide& t, const std::vector<Wide>& x, const Wide& h, const std::vector<Wide>& p,
                              typename M::template Workspace<std::vector<Wide>>& work, std::vector<Wide>& x_new,
                              const Tolerance<Wide>& tolerance, Wide* square, bool keeps_stages) {
  void* const native = code_ ? code_->code() : nullptr;
  if (native == nullptr) return false;
  constexpr std::size_t stages = M::tableau.stages;
  if (any(runs_ != p[Layout::time])) [[unlikely]]
    set_parameters(p);
  const auto numbers = [](auto* wide) { return reinterpret_cast<double*>(const_cast<Wide*>(wide)); };
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
  reinterpret_cast<NativeLaneEvaluation>(native)(all_registers(), nullptr, nullptr, &step);
  work.start_fresh = true;
  work.end_fresh = M::tableau.first_same_as_last();
  return true;
}

}  // namespace continuo::model
