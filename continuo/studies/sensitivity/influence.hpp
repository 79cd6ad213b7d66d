// The variable of a sensitivity, or the unknown of a fit: a parameter of a model, or the initial value of a state.
#pragma once
#include <cstddef>
#include <string>

#include <continuo/language/model.hpp>

namespace continuo::studies {

struct Influence {
  enum class Kind { parameter, initial };
  Kind kind = Kind::parameter;
  std::size_t index = 0;  // into Model::parameters or Model::states
};

/// "k", or "x(0)" for an initial value.
[[nodiscard]] inline std::string name_of(const model::Model& model, const Influence& influence) {
  if (influence.kind == Influence::Kind::parameter) return model.parameters[influence.index].name;
  return model.states[influence.index].column + "(0)";
}
[[nodiscard]] inline const std::string& unit_of(const model::Model& model, const Influence& influence) {
  if (influence.kind == Influence::Kind::parameter) return model.parameters[influence.index].unit;
  return model.states[influence.index].unit;
}

}  // namespace continuo::studies
