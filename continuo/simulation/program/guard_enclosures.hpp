// The guards of a model enclosed over a step, for the proof that no root is missed. Unknowns of algebraic equations
// that a guard reads are solved for there, by enclosures: where the equations are coupled so far that they would be too
// many, while the motion slides, and where somebody holds an unknown, the guard is not enclosed. Nor is that of a
// surface while the motion slides along it.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/program/step_enclosure.hpp>

namespace continuo::model {

class GuardEnclosures {
 public:
  /// A guard by the number that its source of events has for it.
  struct Guard {
    std::size_t number;
    NodeId node;
    std::optional<std::size_t> surface{};  // of which switch of the mode
    bool reads_unknowns = false;
  };

  GuardEnclosures() = default;
  /// `guards[mode]`: those that are watched there; `count` numbers in all.
  GuardEnclosures(const ModelProgram& program, std::vector<std::vector<Guard>> guards, std::size_t count);

  /// The step that the questions below are about.
  void take(const ModelSystem& system, const Step& step);
  [[nodiscard]] bool has(std::size_t number) const { return place_[number] != none; }
  /// All guards over a part of the step: then `whole(i)`.
  void enclose_all(double from, double to) { whole_ = all_ ? all_->values_over(step_, from, to) : whole_.first(0); }
  [[nodiscard]] const Enclosure<double>& whole(std::size_t number) const { return whole_[place_[number]]; }
  [[nodiscard]] EnclosureWithSlope<double> over(std::size_t number, double from, double to);
  [[nodiscard]] Enclosure<double> value(std::size_t number, double at);

  /// An input.
  void set(std::uint32_t variable, double value);

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct OfMode {
    std::vector<Guard> guards;
    std::vector<UnknownBlock> blocks;                // that each guard depends on
    std::vector<std::vector<std::size_t>> switches;  // that the equations of each block read
    std::optional<StepEnclosure> all;
    std::vector<std::optional<StepEnclosure>> alone;
  };
  void make(OfMode& mine, const ModelSystem& system);
  [[nodiscard]] std::vector<std::size_t> switches_of(const UnknownBlock& block, std::size_t mode) const;
  [[nodiscard]] static bool is_enclosed(const OfMode& mine, std::size_t k, const ModelSystem& system);
  [[nodiscard]] StepEnclosure& alone(std::size_t number);

  const ModelProgram* program_ = nullptr;
  std::vector<OfMode> modes_;
  std::vector<std::size_t> place_;  // of a number among the guards of the present mode
  std::vector<double> variables_;
  std::size_t mode_ = none;
  Step step_{};
  StepEnclosure* all_ = nullptr;
  std::span<const Enclosure<double>> whole_;
};

/// The guards of the model's events and of the switches of its equations, by mode; `number_of_event` and
/// `number_of_jump(mode, switch)` give the numbers.
template <class NumberOfEvent, class NumberOfJump>
[[nodiscard]] std::vector<std::vector<GuardEnclosures::Guard>> enclosed_guards(const ModelProgram& program,
                                                                               NumberOfEvent&& number_of_event,
                                                                               NumberOfJump&& number_of_jump) {
  std::vector<std::vector<GuardEnclosures::Guard>> guards(program.guards.size());
  for (std::size_t mode = 0; mode < guards.size(); ++mode) {
    for (const std::size_t event : program.guards[mode].events) {
      const bool reads_unknowns = program.reads_unknowns(program.enclosed[event]);
      guards[mode].push_back({number_of_event(event), program.enclosed[event], {}, reads_unknowns});
    }
    const SwitchedEquations& equations = program.switches[mode];
    for (std::size_t k = 0; k < equations.switches.size(); ++k)
      guards[mode].push_back({number_of_jump(mode, k), equations.guards[k], k});
  }
  return guards;
}

}  // namespace continuo::model
