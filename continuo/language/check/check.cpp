// continuo/language/check/check.cpp
// The passes one after the other; each needs what those before it found. A pass that finds a mistake reports it and
// goes on, so that a text gets all its messages at once.
#include <algorithm>

#include <continuo/language/check/check.hpp>
#include <continuo/language/check/declarations/statements.hpp>
#include <continuo/language/check/equations/algebraic.hpp>
#include <continuo/language/check/products.hpp>
#include <continuo/language/check/run/run_settings.hpp>
#include <continuo/language/check/states/layout.hpp>
#include <continuo/language/check/views/checks.hpp>
#include <continuo/language/check/views/drawing.hpp>
#include <continuo/language/check/views/plots.hpp>
#include <continuo/language/check/views/sweep.hpp>
#include <continuo/language/check/world/characters.hpp>
#include <continuo/language/check/world/forces.hpp>
#include <continuo/language/check/world/joints.hpp>
#include <continuo/language/check/world/make_world.hpp>
#include <continuo/language/check/world/start/finish_world.hpp>
#include <continuo/language/check/world/world_declarations.hpp>
#include <continuo/language/check/world/world_names.hpp>
#include <continuo/language/check/world/world_units.hpp>

namespace continuo::model {

namespace detail {

namespace {

/// From the text to lists of what it declares, and the place of every variable.
void declare(const ast::Model& tree, Declarations& declared, Expressions& expressions, Model& model) {
  Statements statements(tree, declared, expressions);
  WorldDeclarations world(declared, expressions);
  statements.declare_modes();
  statements.declare_top_level();  // parameters and lets outside families
  world.declare(tree);             // bodies, whose states are the first
  statements.walk();               // all other statements, families written out; orders of variables
  world.declare_measures();        // the last states
  store(declared, model);
  model.layout = lay_out(declared);
  make_room(expressions.workspace);
}

/// From the lists to the model: all expressions as nodes, with their units.
void translate(const Declarations& declared, Expressions& expressions, WorldAtWork& world, Model& model) {
  Workspace& workspace = expressions.workspace;
  // Room that nobody writes to costs nothing where memory is given by the page; in a browser it does.
  constexpr std::size_t nodes_of_member = sizeof(void*) < 8 ? 6 : 12;
  workspace.graph.reserve(nodes_of_member * workspace.written_out);
  store(make_parameters(expressions), model);  // and their values, to the registers of the workspace
  check_overrides(model.parameters, expressions);
  model.inputs = make_inputs(expressions);
  workspace.conditions.find_all();  // the values of x(0) = ..., which state the units of states
  measure_world(expressions, world);
  model.states = name_states(expressions);  // without their starts
  make_world(expressions, world, model);    // bodies, walls, springs, and the starts of bodies
  model.unknowns = make_unknowns(expressions);
  look_at_definitions(expressions);
  model.run = RunReader(expressions).read();
  store(InitialValues(expressions, model.states).make(), model);   // starts of states, or a boundary problem
  store(Equations(expressions, model).solve(), model, workspace);  // derivatives in each mode
  store(pair_up(model), model);                                    // positions with their velocities
  Joints(expressions, world, model.states).make_drives();          // of the world
  Characters(expressions, world).make_wishes();                    //
  Forces(expressions, world).make(model);                          //
  store(make_quantities(expressions), model);                      // lets, outputs, energies
  store(Events(expressions, model).make(), model);                 // with their actions
  if (declared.start) model.start_mode = mode_named(declared, declared.start->mode, expressions.report).value_or(0);
  model.plots = make_plots(expressions);
  model.drawing = Drawing(expressions, model.states).make();
  model.checks = Checks(expressions, model).make();
  model.sweep = SweepReader(expressions, model).read();
  if (expressions.report.errors() == 0) append_unknowns(model, expressions.report);  // to the states
  check_method_fits(model, expressions);
  mark_structural(model.parameters, workspace);
  model.world = finish_world(declared.world, std::move(world), model, expressions.report);
}

void nothing_to_simulate(const ast::Model& tree, Report& report) {
  const auto size = static_cast<std::uint32_t>(report.source().text().size());
  const bool blank = tree.statements.empty();
  report.fail("E280", {0, std::min(size, 1u)}, blank ? "the model is empty" : "the model has nothing that moves", {},
              "write an equation and a start, as in x' = -x and x(0) = 1");
}

}  // namespace

}  // namespace detail

Checked check(const ast::Model& tree, const Source& source, const CheckOptions& options, FileReach files) {
  using namespace detail;
  Report report(source, files);
  Model model = empty_model(tree, source);
  const TimeUnit time = find_time_unit(tree, report);
  store(time, model);
  Declarations declared;
  Workspace workspace(declared, time, options.overrides, model, report);
  WorldAtWork world;
  const WorldNames world_names(declared, world);
  workspace.world = &world_names;
  Expressions expressions(workspace);
  declare(tree, declared, expressions, model);
  if (declared.bases.empty()) {
    if (report.errors() == 0) nothing_to_simulate(tree, report);
  } else if (workspace.written_out <= most_written_out) {  // else it is too large to go on
    translate(declared, expressions, world, model);
  }
  Checked result;
  if (report.errors() == 0) result.model = std::move(model);
  result.diagnostics = report.take();
  return result;
}

}  // namespace continuo::model
