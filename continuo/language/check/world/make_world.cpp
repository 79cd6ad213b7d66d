// continuo/language/check/world/make_world.cpp
// Settings first, then bodies, then what stands between them.
#include <type_traits>
#include <variant>

#include <continuo/language/check/world/bodies.hpp>
#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/check/world/joints.hpp>
#include <continuo/language/check/world/make_world.hpp>
#include <continuo/language/check/world/meshes.hpp>
#include <continuo/language/check/world/springs.hpp>
#include <continuo/language/check/world/walls.hpp>
#include <continuo/language/check/world/world_settings.hpp>

namespace continuo::model::detail {

namespace {

/// Walls, meshes, springs, fixed bodies and joints: what is named after the bodies are there.
void make_items(Expressions& expressions, WorldAtWork& work, const std::vector<State>& states) {
  Walls walls(expressions, work);
  Meshes meshes(expressions, work);
  Springs springs(expressions, work, states);
  for (const auto& item : expressions.workspace.declared.world.items) {
    Scope scope = item.scope;
    std::visit(
        [&](const auto& node) {
          using T = std::decay_t<decltype(node)>;
          if constexpr (std::is_same_v<T, ast::WorldWall> || std::is_same_v<T, ast::WorldContainer>) {
            walls.add(node, scope, item.span);
          } else if constexpr (std::is_same_v<T, ast::WorldMesh>) {
            meshes.add(node, scope, item.span);
          } else if constexpr (std::is_same_v<T, ast::WorldSpring> || std::is_same_v<T, ast::WorldSprings>) {
            springs.add(node, scope, item.span);
          } else if constexpr (std::is_same_v<T, ast::WorldFix>) {
            for (const ast::Name& name : node.bodies) {
              const auto body = body_named(name, scope, expressions);
              if (body && work.made.bodies[*body].character)
                expressions.report.fail("E225", name.span, "a character cannot be fixed", "it walks",
                                        "without `walk` and `jump` it stands and falls only");
              if (body) work.made.bodies[*body].fixed = true;
            }
          }
        },
        item.text->node);
  }
  Joints(expressions, work, states).make();
}

}  // namespace

void make_world(Expressions& expressions, WorldAtWork& work, Model& model) {
  std::vector<State>& states = model.states;
  const Workspace& workspace = expressions.workspace;
  const WorldText& text = workspace.declared.world;
  if (!text.text) return;
  WorldDescription& made = work.made;
  made.dimension = text.dimension;
  made.span = text.span;
  made.length_unit = unit_or_nothing(work.length);
  made.mass_unit = unit_or_nothing(work.mass);
  const Symbol* measures = workspace.declared.symbols.find_of_world("world.kinetic");
  made.first_measure = workspace.declared.bases[measures->index].first;
  WorldSettings(expressions, work).make();
  Bodies(expressions, work, states).make();
  work.stage = Stage::bodies_made;
  make_items(expressions, work, states);
  WorldSettings(expressions, work).settle_mode();
  const NodeId zero = workspace.graph.constant(0);
  for (std::size_t i = made.first_measure; i < states.size(); ++i) states[i].initial = zero;
  for (State& state : states) {  // of bodies that could not be read
    if (state.in_world && !state.initial.valid()) state.initial = zero;
  }
  WorldNumbers(expressions, work).judge(model);
  work.stage = Stage::made;
}

}  // namespace continuo::model::detail
