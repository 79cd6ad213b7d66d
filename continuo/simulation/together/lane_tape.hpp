// A tape for eight runs at once, each with parameters of its own, and for one: both to the same bits.
//
//   LaneTape rates(tape, nullptr);
//   rates(t, x, dxdt, p);   // all of them numbers, or all of them lanes
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/numerics/lanes.hpp>
#include <continuo/symbolic/native/c_step.hpp>
#include <continuo/symbolic/native/native_function.hpp>
#include <continuo/symbolic/tape/tape_lanes.hpp>

namespace continuo::model {

class LaneTape {
 public:
  static constexpr std::size_t lanes = TapeLanes::width;  // at once, and no others
  using Wide = Lanes<double, lanes>;

  /// `code`: its machine code (NativeCompiler::lane_code), or null.
  LaneTape(std::shared_ptr<const Tape> tape, std::shared_ptr<NativeFunction> code);

  [[nodiscard]] std::size_t output_count() const { return tape_->output_count(); }

  /// The outputs at the state x. p: all variables, with a number of the run in place of the time.
  void operator()(double t, std::span<const double> x, std::span<double> outputs, std::span<const double> p);
  void operator()(const Wide& t, std::span<const Wide> x, std::span<Wide> outputs, std::span<const Wide> p);

  /// The machine code, for who does more with it than to evaluate; null as long as there is none.
  [[nodiscard]] NativeLaneEvaluation code() const {
    return code_ ? reinterpret_cast<NativeLaneEvaluation>(code_->code()) : nullptr;
  }
  /// The registers for it, with these parameters.
  [[nodiscard]] double* registers(std::span<const Wide> p);

 private:
  template <class Register>
  struct Registers {
    std::vector<Register> all, outputs;
  };
  [[nodiscard]] bool is_state(std::size_t variable) const {
    return variable >= states_begin_ && variable < states_end_;
  }
  template <class Use>
  void with_registers(const Use& use);
  template <class Register>
  void set_parameters(Registers<Register>& registers, std::span<const Wide> p);
  template <class Register>
  void evaluate_tape(Registers<Register>& registers, std::span<const Wide> x, std::span<Wide> outputs);
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
