// dx/dt of a model for eight runs at once, each with parameters and inputs of its own, and for one: as `ensemble` calls
// it. Both give the same bits.
//
//   LaneEquations equations(*program, nullptr);
//   ensemble(equations, starts, {0, 10}, Dop853{});  // of RunStart{x, LaneEquations::parameters(run + 1, variables)}
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/numerics/lanes.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/native_function.hpp>
#include <continuo/symbolic/tape/tape_lanes.hpp>

namespace continuo::model {

class LaneEquations {
 public:
  using Wide = Lanes<double, TapeLanes::width>;

  /// Of a model with one mode, whose equations do not jump. `code`: their machine code, or null.
  LaneEquations(const ModelProgram& program, std::shared_ptr<NativeFunction> code);

  /// The parameters of a run with these variables. `number` is not that of any other run, and at least 1.
  [[nodiscard]] static std::vector<double> parameters(std::size_t number, std::span<const double> variables);

  void operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt, const std::vector<double>& p);
  void operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt, const std::vector<Wide>& p);

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

}  // namespace continuo::model
