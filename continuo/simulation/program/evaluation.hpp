// continuo/simulation/program/evaluation.hpp
// A tape with registers of its own, for the flat variables of a model.
//
//   Evaluation rates(tape, start_values(model));
//   rates(t, x, dxdt);
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

class Evaluation {
 public:
  Evaluation() = default;
  Evaluation(std::shared_ptr<const Tape> tape, std::span<const double> variables)
      : tape_(std::move(tape)), registers_(tape_->register_count()), until_count_(evaluations_between_counts()) {
    std::ranges::copy(variables, registers_.begin());
    tape_->prepare<double>(registers_);
  }

  [[nodiscard]] std::size_t output_count() const { return tape_ ? tape_->output_count() : 0; }

  void operator()(double t, std::span<const double> x, std::span<double> outputs) {
    registers_[Layout::time] = t;
    tape_->evaluate<double>(registers_, x, outputs);
    if (--until_count_ == 0) count_use();
  }
  /// The same with the outputs elsewhere: see Tape::outputs_at.
  void operator()(double t, std::span<const double> x, std::span<double> outputs, const tape::Copies& copies) {
    registers_[Layout::time] = t;
    tape_->evaluate<double>(registers_, x, outputs, copies);
    if (--until_count_ == 0) count_use();
  }
  /// Whether the two without copies run machine code.
  [[nodiscard]] bool is_native() const { return tape_->is_native(); }
  [[nodiscard]] tape::Copies outputs_at(std::span<const std::uint32_t> places) const {
    return tape_->outputs_at(places);
  }
  std::vector<double> operator()(double t, std::span<const double> x) {
    std::vector<double> outputs(output_count());
    if (!outputs.empty()) (*this)(t, x, outputs);
    return outputs;
  }

  /// Operations of an evaluation.
  [[nodiscard]] std::size_t operations() const {
    const Tape::Size size = tape_->size();
    return std::max<std::size_t>(size.single + size.batched, 1);
  }
  /// Of the tape, for machine code that does more than to evaluate it.
  [[nodiscard]] double* registers() { return registers_.data(); }

  /// Sets a variable that is no parameter: nothing was prepared with it.
  void place(std::uint32_t variable, double value) { registers_[variable] = value; }
  /// Sets a parameter, an input or a sample.
  void set(std::uint32_t variable, double value) {
    if (!tape_) return;
    registers_[variable] = value;
    tape_->prepare<double>(registers_);
  }

 private:
  /// Some twenty microseconds of work lie between two counts, so that counting costs nothing.
  static constexpr std::size_t operations_between_counts = 20'000;
  [[nodiscard]] std::size_t evaluations_between_counts() const {
    return std::max<std::size_t>(operations_between_counts / operations(), 1);
  }
  void count_use() {
    const std::size_t evaluations = evaluations_between_counts();
    const bool is_of_interest = tape_->count_use(evaluations * operations());
    until_count_ = is_of_interest ? evaluations : std::numeric_limits<std::size_t>::max();
  }

  std::shared_ptr<const Tape> tape_;
  std::vector<double> registers_;
  std::size_t until_count_ = std::numeric_limits<std::size_t>::max();  // evaluations
};

}  // namespace continuo::model
