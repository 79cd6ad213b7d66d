// continuo/worlds/characters.hpp
// The characters of a model's world: what they wish in this state of the model, and how they walk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <continuo/bodies/character.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::worlds {

/// Moves bodies of a world after each of its steps, in the order of the model. Nothing where there are no characters.
template <int Dim>
class Characters {
 public:
  /// `variables` is a register file as `start_values` gives it.
  Characters(const model::ModelProgram& program, std::span<const double> variables);

  /// Whether there are none.
  [[nodiscard]] bool is_empty() const { return all_.empty(); }
  /// Sets a parameter or an input, by its place in the register file.
  void set(std::uint32_t variable, double value);
  /// Takes sizes from parameters, and the rest from the world. Fails, and changes nothing, where a size makes no sense.
  [[nodiscard]] Status measure(const model::Model& model, std::span<const double> variables,
                               const World<double, Dim>& world);

  /// Before a step of the world: what they wish at this time and in this state of the model. Characters that have been
  /// moved since their last step begin where they are now.
  void prepare(double t, std::span<const double> state, const World<double, Dim>& world);
  /// After that step, which took so long: they walk. Fails where a wish is no number.
  [[nodiscard]] Status walk(World<double, Dim>& world, double duration);
  /// Writes what they tell of themselves into the states of the model.
  void write(std::span<double> state) const;

  /// All that they know, for a snapshot.
  [[nodiscard]] std::vector<double> saved() const;
  /// Whether these numbers are of so many characters, and may stand in a snapshot.
  [[nodiscard]] bool fits(std::span<const double> saved) const;
  /// Goes on from numbers that fit.
  void restore(std::span<const double> saved);

 private:
  using V = Vector<double, Dim>;
  static constexpr std::size_t wishes_of_one = Dim;  // the horizontal velocity, and the jump
  static constexpr std::size_t numbers_of_one = 4 + 6 * std::size_t{Dim};

  struct One {
    std::size_t body = 0, measure = 0;
    std::string name{};
    CharacterOptions<double> options{};
    Character<double, Dim> character{};
    V placed = filled_with_nothing();    // where it was put at the end of its last step ...
    V velocity = filled_with_nothing();  // ... with this velocity
  };
  [[nodiscard]] static V filled_with_nothing() {
    V v;
    v.components.fill(std::numeric_limits<double>::quiet_NaN());
    return v;
  }
  template <class Self, class Act>
  static void for_each_number(Self& one, Act&& act);

  std::vector<One> all_;
  model::Evaluation wishes_;
  std::vector<double> values_;
};

extern template class Characters<2>;
extern template class Characters<3>;

}  // namespace continuo::worlds
