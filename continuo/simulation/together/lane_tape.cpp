// Brings states and parameters to the registers of a tape, and the outputs back.
#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include <continuo/language/model.hpp>
#include <continuo/simulation/together/lane_tape.hpp>
#include <continuo/symbolic/tape/wide_vectors.hpp>

namespace continuo::model {

namespace {

/// In nanoseconds: about as long as four on one number.
constexpr std::uint64_t cost_of_operation = 4;
constexpr std::uint64_t between_counts = 20'000;

}  // namespace

LaneTape::LaneTape(std::shared_ptr<const Tape> tape, std::shared_ptr<NativeFunction> code)
    : tape_(std::move(tape)),
      code_(std::move(code)),
      operations_(cost_of_operation * (tape_->size().single + tape_->size().batched)),
      states_begin_(tape_->states_begin()),
      states_end_(tape_->states_end()),
      registers_(tape_->register_count()) {
  const auto make = [&](auto& registers) {
    registers.all.resize(tape_->register_count());
    registers.outputs.resize(tape_->output_count());
  };
  if (has_wide_vectors()) {
    make(wide_lanes_);
  } else {
    make(lanes_);
  }
}

template <class Use>
void LaneTape::with_registers(const Use& use) {
  if (wide_lanes_.all.empty()) {
    use(lanes_);
  } else {
    use(wide_lanes_);
  }
}

void LaneTape::operator()(double t, std::span<const double> x, std::span<double> outputs, std::span<const double> p) {
  if (run_ != p[Layout::time]) {
    run_ = p[Layout::time];
    std::ranges::copy(p, registers_.begin());
    tape_->prepare<double>(registers_);
  }
  registers_[Layout::time] = t;
  tape_->evaluate<double>(registers_, x, outputs);
}

void LaneTape::operator()(const Wide& t, std::span<const Wide> x, std::span<Wide> outputs, std::span<const Wide> p) {
  double* const all = registers(p);
  std::memcpy(all + Layout::time * lanes, &t, sizeof t);
  if (const NativeLaneEvaluation native = code()) {
    native(all, reinterpret_cast<const double*>(x.data()), reinterpret_cast<double*>(outputs.data()), nullptr, nullptr);
  } else {
    with_registers([&](auto& registers) { evaluate_tape(registers, x, outputs); });
  }
}

double* LaneTape::registers(std::span<const Wide> p) {
  double* first = nullptr;
  with_registers([&](auto& registers) {
    if (any(runs_ != p[Layout::time])) [[unlikely]]
      set_parameters(registers, p);
    first = registers.all.front().numbers.data();
  });
  return first;
}

template <class Register>
void LaneTape::set_parameters(Registers<Register>& registers, std::span<const Wide> p) {
  runs_ = p[Layout::time];
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!is_state(i)) registers.all[i].numbers = p[i].values();
  tape_->prepare<Register>(registers.all);
}

template <class Register>
void LaneTape::evaluate_tape(Registers<Register>& registers, std::span<const Wide> x, std::span<Wide> outputs) {
  // Both have the numbers of all lanes one after the other.
  static_assert(sizeof(Register) == sizeof(Wide) && std::is_trivially_copyable_v<Register> &&
                std::is_trivially_copyable_v<Wide>);
  std::memcpy(static_cast<void*>(&registers.all[states_begin_]), x.data(), x.size_bytes());
  tape_->evaluate<Register>(registers.all, registers.outputs);
  std::memcpy(static_cast<void*>(outputs.data()), registers.outputs.data(), output_count() * sizeof(Wide));
  if (code_) count_use();
}

void LaneTape::count_use() {
  uncounted_ += operations_;
  if (uncounted_ < between_counts) return;
  code_->count(std::exchange(uncounted_, 0));
}

}  // namespace continuo::model
