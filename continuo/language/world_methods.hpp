// continuo/language/world_methods.hpp
// The methods that move the world of a model, and what of a world the exact motion refuses.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>

namespace continuo::model {

/// What can stand behind `integrator` in `mode fast`.
[[nodiscard]] std::vector<std::string> world_integrators();

/// What can stand in place of the mode of a world: `exact`, and its paths by `dop853` or `rk4` with a step; `fast` with
/// the integrator that the world names, or by the name of one.
[[nodiscard]] std::vector<std::string> world_methods();
/// Those of them that move this world; the model is that of the world.
[[nodiscard]] std::vector<std::string> world_methods(const WorldDescription& world, const Model& model);

/// Whether an expression changes in a run, with the time, a state or an input; and whether it reads a state.
/// @{
[[nodiscard]] bool changes(const Model& model, NodeId node);
[[nodiscard]] bool reads_states(const Model& model, NodeId node);
/// @}

/// Something that the exact motion does not move, and where it stands.
struct ExactRefusal {
  std::string message;  // "the exact motion knows no springs of joints"
  Span span;
};
/// What the exact motion refuses of a world that is rigid, in the words of bodies/exact_rigid; nothing of other worlds.
/// Not what values of parameters decide.
[[nodiscard]] std::vector<ExactRefusal> exact_refusals(const WorldDescription& world, const Model& model);

}  // namespace continuo::model
