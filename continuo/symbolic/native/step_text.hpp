// The stages, the end and the error of a step of an explicit Runge-Kutta method as statements of C, for who writes
// functions of them. Internal to c_step.cpp and c_steps.cpp.
//
// Runs that are computed at once are a unit, and the names of their quantities end with the name of the unit, for which
// `@` stands in the statements: two units may stand in one function, statement beside statement.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_step.hpp>

namespace continuo::model {

class StepText {
 public:
  /// `runs`: how many make the step together, those of TapeLanes or one.
  StepText(const Tape& tape, const CStepFormula& formula, std::size_t runs, Fusing fusing)
      : tape_(tape),
        formula_(formula),
        runs_(runs),
        fusing_(fusing),
        states_(tape.states_end() - tape.states_begin()) {}

  [[nodiscard]] const Tape& tape() const { return tape_; }
  [[nodiscard]] const CStepFormula& formula() const { return formula_; }
  [[nodiscard]] std::size_t runs() const { return runs_; }
  [[nodiscard]] std::size_t states() const { return states_; }
  [[nodiscard]] Fusing fusing() const { return fusing_; }
  [[nodiscard]] bool is_single() const { return runs_ == 1; }
  [[nodiscard]] std::size_t stages() const { return formula_.b.size(); }
  /// Which of them is f at the end; where none is, one that there is not.
  [[nodiscard]] std::size_t inner_stages() const { return stages() - (formula_.ends_with_f ? 1 : 0); }
  [[nodiscard]] std::string text() const;

  void set_unit(std::string_view unit) { unit_ = unit; }
  /// What `write` writes for each of these units, a statement of each in turn.
  template <class Write>
  void side_by_side(std::span<const std::string_view> units, const Write& write) {
    const std::size_t begin = lines_.size();
    for (const std::string_view unit : units) {
      set_unit(unit);
      write();
    }
    take_turns(begin, units.size());
  }
  void line(std::string_view what);
  /// A statement for each component: i in it is the number of the component.
  template <class Statement>
  void each(std::size_t count, std::size_t most, const Statement& statement) {
    if (count > most) {
      return line(fmt::format("\n#pragma GCC ivdep\n  for (int i = 0; i < {}; ++i) {{ {} }}", count, statement("i")));
    }
    for (std::size_t i = 0; i < count; ++i) line(statement(fmt::format("{}", i)));
  }
  template <class Statement>
  void each_state(const Statement& statement) {
    each(states_, most_states_unrolled, statement);
  }
  /// Number `i` of all runs in this array of doubles, for those of the unit.
  [[nodiscard]] std::string element(std::string_view array, std::string_view i) const {
    return fmt::format("{} + {} * {} + part@", array, runs_, i);
  }

  /// `r`, with the registers in this array.
  void registers(std::string_view array);
  /// `x`, `slope`, `end`, `k0`, `k1`, ..., `square`.
  void declare();
  /// k0.
  void start();
  /// All after k0, from x at t by h, and the end.
  void step();
  /// `square`, where the method has an estimate.
  void error();
  void load_state(std::string_view array);
  void store(std::string_view name, std::string_view array);

  static constexpr std::size_t most_states_unrolled = 8;

 private:
  void take_turns(std::size_t begin, std::size_t units);
  void stage(std::size_t j);
  [[nodiscard]] std::string sum(std::span<const double> weights, std::size_t end, std::string_view i) const;
  [[nodiscard]] std::string ratios(std::string_view i) const;
  [[nodiscard]] std::string rest_of_second(std::string_view i) const;
  /// `sum` + a*b, as one operation where steps are fused.
  [[nodiscard]] std::string plus_product(std::string_view sum, std::string_view a, std::string_view b) const;

  const Tape& tape_;
  const CStepFormula& formula_;
  std::size_t runs_;
  Fusing fusing_;
  std::size_t states_;
  std::string_view unit_{};
  std::vector<std::string> lines_;
};

}  // namespace continuo::model
