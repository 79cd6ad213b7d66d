// Proves that no guard of a run comes to zero in a step, from where the components of its state lie in it. What is
// proved here needs no search: one would find nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/tape/tape_enclosure.hpp>
#include <continuo/symbolic/tape/tape_registers.hpp>

namespace continuo::model {

class QuietGuards {
 public:
  /// The model has no algebraic equations.
  explicit QuietGuards(const ModelProgram& program);

  /// A run with these parameters begins.
  void begin(std::span<const double> variables);

  /// The components of the state that guards read in any mode.
  [[nodiscard]] std::span<const std::uint32_t> components() const { return components_; }
  /// In the step a component, or the time, is between these bounds. What the guards of the mode do not read is ignored.
  void set_component(std::size_t mode, std::uint32_t component, double lo, double hi);
  void set_time(std::size_t mode, const Enclosure<double>& over);
  /// Whether each guard of the mode has one sign in the step.
  [[nodiscard]] bool stay(std::size_t mode);

 private:
  struct OfMode {
    std::shared_ptr<const Tape> tape;
    std::vector<char> reads;  // by component
    bool reads_time = false;
    TapeRegisters<Enclosure<double>> registers{};
  };
  [[nodiscard]] TapeRegisters<Enclosure<double>>& registers(std::size_t mode);

  std::uint32_t states_begin_;
  std::vector<OfMode> modes_;
  std::vector<std::uint32_t> components_;
  std::vector<double> variables_;
};

}  // namespace continuo::model
