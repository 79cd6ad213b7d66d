// The registers of a tape for one kind of number, prepared when they are first asked for.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

template <class Number>
class TapeRegisters {
 public:
  /// With the model's variables in front. Those that the tape reads and that move are to be set after this.
  void prepare(const Tape& tape, std::span<const double> variables) {
    if (is_prepared_) return;
    numbers_.resize(tape.register_count());
    outputs_.resize(tape.output_count());
    std::ranges::transform(variables, numbers_.begin(), [](double value) { return Number(value); });
    tape.prepare<Number>(numbers_);
    is_prepared_ = true;
  }
  /// A variable has changed.
  void forget() { is_prepared_ = false; }

  Number& operator[](std::size_t variable) { return numbers_[variable]; }
  [[nodiscard]] std::span<const Number> evaluate(const Tape& tape) {
    tape.evaluate<Number>(numbers_, outputs_);
    return outputs_;
  }

 private:
  std::vector<Number> numbers_, outputs_;
  bool is_prepared_ = false;
};

}  // namespace continuo::model
