// Brings states and parameters to the registers of a tape, and the rates back.
#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include <continuo/simulation/together/lane_equations.hpp>
#include <continuo/symbolic/tape/wide_vectors.hpp>

namespace continuo::model {

namespace {

/// In nanoseconds: about as long as four on one number.
constexpr std::uint64_t cost_of_operation = 4;
constexpr std::uint64_t between_counts = 20'000;

}  // namespace

LaneEquations::LaneEquations(const ModelProgram& program, std::shared_ptr<NativeFunction> code, std::size_t mode)
    : autonomous(program.autonomous),
      tape_(program.derivatives[mode]),
      code_(std::move(code)),
      operations_(cost_of_operation * (tape_->size().single + tape_->size().batched)),
      states_begin_(tape_->states_begin()),
      states_end_(tape_->states_end()),
      registers_(tape_->register_count()) {
  const auto make = [&](auto& registers) {
    registers.all.resize(tape_->register_count());
    registers.rates.resize(tape_->output_count());
  };
  if (has_wide_vectors()) {
    make(wide_lanes_);
  } else {
    make(lanes_);
  }
}

std::vector<double> LaneEquations::parameters(std::size_t number, std::span<const double> variables) {
  std::vector<double> p(variables.begin(), variables.end());
  p[Layout::time] = static_cast<double>(number);  // the time itself is no parameter
  return p;
}

void LaneEquations::operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt,
                               const std::vector<double>& p) {
  if (run_ != p[Layout::time]) {
    run_ = p[Layout::time];
    std::ranges::copy(p, registers_.begin());
    tape_->prepare<double>(registers_);
  }
  registers_[Layout::time] = t;
  tape_->evaluate<double>(registers_, x, dxdt);
}

void LaneEquations::operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt,
                               const std::vector<Wide>& p) {
  if (wide_lanes_.all.empty()) {
    evaluate(lanes_, t, x, dxdt, p);
  } else {
    evaluate(wide_lanes_, t, x, dxdt, p);
  }
}

void LaneEquations::set_parameters(const std::vector<Wide>& p) {
  if (wide_lanes_.all.empty()) {
    set_parameters(lanes_, p);
  } else {
    set_parameters(wide_lanes_, p);
  }
}

template <class Register>
void LaneEquations::set_parameters(Registers<Register>& registers, const std::vector<Wide>& p) {
  runs_ = p[Layout::time];
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!is_state(i)) registers.all[i].numbers = p[i].values();
  tape_->prepare<Register>(registers.all);
}

template <class Register>
void LaneEquations::evaluate(Registers<Register>& registers, const Wide& t, const std::vector<Wide>& x,
                             std::vector<Wide>& dxdt, const std::vector<Wide>& p) {
  if (any(runs_ != p[Layout::time])) [[unlikely]]
    set_parameters(registers, p);
  std::memcpy(static_cast<void*>(&registers.all[Layout::time]), &t, sizeof t);
  if (void* const native = code_ ? code_->code() : nullptr) {
    reinterpret_cast<NativeLaneEvaluation>(native)(registers.all.front().numbers.data(),
                                                   reinterpret_cast<const double*>(x.data()),
                                                   reinterpret_cast<double*>(dxdt.data()), nullptr);
  } else {
    evaluate_tape(registers, x, dxdt);
  }
}

template <class Register>
void LaneEquations::evaluate_tape(Registers<Register>& registers, const std::vector<Wide>& x, std::vector<Wide>& dxdt) {
  // Both have the numbers of all lanes one after the other.
  static_assert(sizeof(Register) == sizeof(Wide) && std::is_trivially_copyable_v<Register> &&
                std::is_trivially_copyable_v<Wide>);
  std::memcpy(static_cast<void*>(&registers.all[states_begin_]), x.data(), x.size() * sizeof(Wide));
  tape_->evaluate<Register>(registers.all, registers.rates);
  std::memcpy(static_cast<void*>(dxdt.data()), registers.rates.data(), x.size() * sizeof(Wide));
  if (code_) count_use();
}

void LaneEquations::count_use() {
  uncounted_ += operations_;
  if (uncounted_ < between_counts) return;
  code_->count(std::exchange(uncounted_, 0));
}

}  // namespace continuo::model
