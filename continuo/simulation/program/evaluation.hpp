// continuo/simulation/program/evaluation.hpp
// A tape with registers of its own, for the flat variables of a model.
//
//   Evaluation rates(tape, start_values(model));
//   rates(t, x, dxdt);
#pragma once
#include <algorithm>
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
      : tape_(std::move(tape)), registers_(tape_->register_count()) {
    std::ranges::copy(variables, registers_.begin());
    tape_->prepare<double>(registers_);
  }

  [[nodiscard]] std::size_t output_count() const { return tape_ ? tape_->output_count() : 0; }

  void operator()(double t, std::span<const double> x, std::span<double> outputs) {
    registers_[Layout::time] = t;
    tape_->evaluate<double>(registers_, x, outputs);
  }
  /// The same with the outputs elsewhere: see Tape::outputs_at.
  void operator()(double t, std::span<const double> x, std::span<double> outputs, const tape::Copies& copies) {
    registers_[Layout::time] = t;
    tape_->evaluate<double>(registers_, x, outputs, copies);
  }
  [[nodiscard]] tape::Copies outputs_at(std::span<const std::uint32_t> places) const {
    return tape_->outputs_at(places);
  }
  std::vector<double> operator()(double t, std::span<const double> x) {
    std::vector<double> outputs(output_count());
    if (!outputs.empty()) (*this)(t, x, outputs);
    return outputs;
  }

  /// Sets a variable that is no parameter: nothing was prepared with it.
  void place(std::uint32_t variable, double value) { registers_[variable] = value; }
  /// Sets a parameter, an input or a sample.
  void set(std::uint32_t variable, double value) {
    if (!tape_) return;
    registers_[variable] = value;
    tape_->prepare<double>(registers_);
  }

 private:
  std::shared_ptr<const Tape> tape_;
  std::vector<double> registers_;
};

}  // namespace continuo::model
