// Collects the dimensions, variables and attributes of a netCDF file from a run.
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/world.hpp>
#include <continuo/results/families.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/results/netcdf_file.hpp>

namespace continuo::results {

namespace {

/// A variable over time, bodies and the parts of a vector or quaternion, and which state of each body it is made of.
struct OfBodies {
  std::string name, unit, long_name;
  std::vector<std::size_t> states;  // one per part
};

std::vector<OfBodies> variables_of(const model::Model& model) {
  const model::WorldDescription& world = *model.world;
  const std::string of_velocity = model.states.size() > 1 ? model.states[1].unit : "";
  if (world.dimension == 2) {
    return {{.name = "position", .unit = world.length_unit, .long_name = "position of the centre", .states = {0, 2}},
            {.name = "velocity", .unit = of_velocity, .long_name = "velocity of the centre", .states = {1, 3}},
            {.name = "angle", .unit = "rad", .long_name = "angle of rotation", .states = {4}},
            {.name = "spin", .unit = model.states[5].unit, .long_name = "angular velocity", .states = {5}}};
  }
  return {{.name = "position", .unit = world.length_unit, .long_name = "position of the centre", .states = {0, 2, 4}},
          {.name = "velocity", .unit = of_velocity, .long_name = "velocity of the centre", .states = {1, 3, 5}},
          {.name = "orientation", .unit = "", .long_name = "orientation, a unit quaternion", .states = {6, 7, 8, 9}},
          {.name = "spin", .unit = model.states[10].unit, .long_name = "angular velocity", .states = {10, 11, 12}}};
}

/// A run as such a file, whose values refer to the model and the run.
class Contents {
 public:
  Contents(const model::Model& model, const model::Run& run) : model_(model), run_(run) {}

  NetcdfFile file(std::string_view hash) {
    file_.attributes = {{"Conventions", "CF-1.8"},
                        {"title", model_.name},
                        {"source", "Continuo, method " + run_.plan.method},
                        {"comment", model_.heading},
                        {"manifest", std::string(hash)}};
    time_ = file_.dimension("time", run_.motion.rows());
    file_.variable({.name = "time",
                    .dimensions = {time_},
                    .attributes = {{"units", model_.time_unit}, {"standard_name", "time"}, {"axis", "T"}},
                    .values = columns({0})});
    if (model_.has_world()) add_bodies();
    add_columns();
    return std::move(file_);
  }

 private:
  NetcdfVariable::Numbers columns(std::vector<std::size_t> places) const {
    return [&run = run_, places = std::move(places)] {
      std::vector<double> values;
      for (std::size_t row = 0; row < run.motion.rows(); ++row)
        for (const std::size_t place : places) values.push_back(run.motion.row(row)[place]);
      return values;
    };
  }

  void add_bodies() {
    const model::WorldDescription& world = *model_.world;
    const bool in_space = world.dimension == 3;
    const std::size_t body = file_.dimension("body", world.bodies.size());
    const std::size_t component = file_.dimension("component", in_space ? 3 : 2);
    const std::size_t part = in_space ? file_.dimension("part", 4) : 0;
    NetcdfVariable::Texts names, components{"x", "y"};
    for (const model::BodyDescription& one : world.bodies) names.push_back(one.name);
    if (in_space) components.emplace_back("z");
    file_.variable(
        {.name = "body", .dimensions = {body}, .attributes = {{"cf_role", "trajectory_id"}}, .values = names});
    file_.variable({.name = "component", .dimensions = {component}, .values = components});
    if (in_space)
      file_.variable({.name = "part",
                      .dimensions = {part},
                      .attributes = {{"long_name", "part of a quaternion"}},
                      .values = NetcdfVariable::Texts{"w", "x", "y", "z"}});
    for (const OfBodies& variable : variables_of(model_)) {
      std::vector<std::size_t> dimensions{time_, body};
      if (variable.states.size() > 1) dimensions.push_back(variable.states.size() == 4 ? part : component);
      file_.variable({.name = variable.name,
                      .dimensions = dimensions,
                      .attributes = {{"units", variable.unit}, {"long_name", variable.long_name}},
                      .values = states(variable.states)});
    }
    add_property("radius", body, world.length_unit, &model::BodyDescription::radius);
    add_property("mass", body, world.mass_unit, &model::BodyDescription::mass);
  }

  NetcdfVariable::Numbers states(std::vector<std::size_t> of_each) const {
    return [&run = run_, &bodies = model_.world->bodies, of_each = std::move(of_each)] {
      std::vector<double> values;
      for (std::size_t row = 0; row < run.motion.rows(); ++row) {
        const auto state = run.motion.state(row);
        for (const model::BodyDescription& body : bodies)
          for (const std::size_t k : of_each) values.push_back(state[body.first_state + k]);
      }
      return values;
    };
  }

  void add_property(const char* name, std::size_t body, const std::string& unit,
                    model::NodeId model::BodyDescription::* property) {
    file_.variable({.name = name,
                    .dimensions = {body},
                    .attributes = {{"units", unit}},
                    .values = NetcdfVariable::Numbers([&model = model_, &run = run_, property] {
                      std::vector<model::NodeId> nodes;
                      for (const model::BodyDescription& one : model.world->bodies) nodes.push_back(one.*property);
                      return evaluate(model, nodes, run.plan.variables);
                    })});
  }

  /// All that is not of bodies: states of equations, measures of the world, outputs, energies; families as arrays.
  void add_columns() {
    const std::size_t first = 1 + (model_.has_world() ? model_.world->body_states() : 0);
    for (ColumnFamily& family : families_of(std::span(run_.motion.columns).subspan(first))) {
      std::vector<std::size_t> dimensions{time_};
      for (const ColumnFamily::Axis& axis : family.axes) dimensions.push_back(dimension_of(axis, dimensions));
      for (std::size_t& place : family.places) place += first;
      file_.variable({.name = free_name(family.name),
                      .dimensions = dimensions,
                      .attributes = {{"units", family.unit}},
                      .values = columns(std::move(family.places))});
    }
    if (run_.total_energy.empty()) return;
    file_.variable(
        {.name = free_name("energy"),
         .dimensions = {time_},
         .attributes = {{"units", run_.energy ? run_.energy->unit : ""}, {"long_name", "sum of all energies"}},
         .values = NetcdfVariable::Numbers([&run = run_] { return run.total_energy; })});
  }
  /// Families of the same indices share their dimensions, `i`, `j`, ..., so that they can be added to each other.
  std::size_t dimension_of(const ColumnFamily::Axis& axis, const std::vector<std::size_t>& taken) {
    for (const auto& [known, place] : axes_)
      if (known == axis && std::ranges::find(taken, place) == taken.end()) return place;
    std::string letter = "i";
    if (axes_.size() < 12) {
      letter[0] = static_cast<char>('i' + axes_.size());
    } else {
      letter += std::to_string(axes_.size());
    }
    const std::string name = free_name(letter);
    const std::size_t place = file_.dimension(name, axis.count);
    axes_.emplace_back(axis, place);
    file_.variable({.name = name,
                    .dimensions = {place},
                    .values = NetcdfVariable::Numbers([axis] {
                      std::vector<double> indices(axis.count);
                      std::iota(indices.begin(), indices.end(), static_cast<double>(axis.first));
                      return indices;
                    }),
                    .integers = true});
    return place;
  }
  /// An output may be called like one of ours.
  std::string free_name(std::string name) {
    while (std::ranges::find(taken_, name) != taken_.end()) name += "_";
    taken_.push_back(name);
    return name;
  }

  const model::Model& model_;
  const model::Run& run_;
  NetcdfFile file_;
  std::size_t time_ = 0;
  std::vector<std::pair<ColumnFamily::Axis, std::size_t>> axes_;
  std::vector<std::string> taken_{"time",  "body",        "component", "part",   "position", "velocity",
                                  "angle", "orientation", "spin",      "radius", "mass"};
};

}  // namespace

bool is_netcdf(std::string_view path) {
  return path.ends_with(".nc");
}

Status write_netcdf(const model::Model& model, const model::Run& run, const std::string& path,
                    std::string_view manifest_hash) {
  return write_netcdf_file(Contents(model, run).file(manifest_hash), path);
}

}  // namespace continuo::results
