// continuo/model/evaluation.hpp
// A tape with registers of its own, for the flat variables of a model.
//
//   Evaluation rates(tape, layout, start_values(model));
//   rates(t, x, dxdt);
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <continuo/model/model.hpp>
#include <continuo/model/tape.hpp>

namespace continuo::model {

class Evaluation {
 public:
  Evaluation() = default;
  Evaluation(std::shared_ptr<const Tape> tape, const Layout& layout, std::span<const double> variables)
      : tape_(std::move(tape)), states_(layout.states), registers_(tape_->register_count()) {
    std::ranges::copy(variables, registers_.begin());
    tape_->prepare<double>(registers_);
  }

  std::size_t output_count() const { return tape_ ? tape_->output_count() : 0; }

  void operator()(double t, std::span<const double> x, std::span<double> outputs) {
    registers_[Layout::time] = t;
    std::copy(x.begin(), x.end(), registers_.begin() + states_);
    tape_->evaluate<double>(registers_, outputs);
  }
  std::vector<double> operator()(double t, std::span<const double> x) {
    std::vector<double> outputs(output_count());
    if (!outputs.empty()) (*this)(t, x, outputs);
    return outputs;
  }

  /// Sets a parameter, an input or a sample.
  void set(std::uint32_t variable, double value) {
    if (!tape_) return;
    registers_[variable] = value;
    tape_->prepare<double>(registers_);
  }

 private:
  std::shared_ptr<const Tape> tape_;
  std::uint32_t states_ = 1;
  std::vector<double> registers_;
};

}  // namespace continuo::model
