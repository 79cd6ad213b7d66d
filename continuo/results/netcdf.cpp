// Collects the dimensions, variables and attributes of a netCDF file from a run.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/world.hpp>
#include <continuo/results/families.hpp>
#include <continuo/results/netcdf.hpp>

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

/// The layout of the runs of a model.
class ModelLayout {
 public:
  ModelLayout(const model::Model& model, const model::Plan& plan, std::span<const model::Column> columns)
      : model_(model), plan_(plan), columns_(columns) {}

  NetcdfLayout layout(std::string_view hash) {
    file_.attributes = {{"Conventions", "CF-1.8"},
                        {"title", model_.name},
                        {"source", "Continuo, method " + plan_.method},
                        {"comment", model_.heading},
                        {"manifest", std::string(hash)}};
    time_ = file_.dimension("time");
    file_.variable({.name = "time",
                    .dimensions = {time_},
                    .attributes = {{"units", model_.time_unit}, {"standard_name", "time"}, {"axis", "T"}},
                    .values = NetcdfVariable::Columns{0}});
    if (model_.has_world()) add_bodies();
    add_columns();
    return std::move(file_);
  }

 private:
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

  NetcdfVariable::Columns states(const std::vector<std::size_t>& of_each) const {
    NetcdfVariable::Columns places;
    for (const model::BodyDescription& body : model_.world->bodies)
      for (const std::size_t k : of_each) places.push_back(1 + body.first_state + k);
    return places;
  }

  void add_property(const char* name, std::size_t body, const std::string& unit,
                    model::NodeId model::BodyDescription::* property) {
    std::vector<model::NodeId> nodes;
    for (const model::BodyDescription& one : model_.world->bodies) nodes.push_back(one.*property);
    file_.variable({.name = name,
                    .dimensions = {body},
                    .attributes = {{"units", unit}},
                    .values = evaluate(model_, nodes, plan_.variables)});
  }

  /// All that is not of bodies: states of equations, measures of the world, outputs, energies; families as arrays.
  void add_columns() {
    const std::size_t first = 1 + (model_.has_world() ? model_.world->body_states() : 0);
    for (ColumnFamily& family : families_of(columns_.subspan(first))) {
      std::vector<std::size_t> dimensions{time_};
      for (const ColumnFamily::Axis& axis : family.axes) dimensions.push_back(dimension_of(axis, dimensions));
      for (std::size_t& place : family.places) place += first;
      file_.variable({.name = free_name(family.name),
                      .dimensions = dimensions,
                      .attributes = {{"units", family.unit}},
                      .values = std::move(family.places)});
    }
    if (!model_.total_energy.valid()) return;
    file_.variable({.name = free_name("energy"),
                    .dimensions = {time_},
                    .attributes = {{"units", model_.total_energy_unit}, {"long_name", "sum of all energies"}},
                    .values = NetcdfVariable::Columns{columns_.size()}});
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
    NetcdfVariable::Integers indices(axis.count);
    std::iota(indices.begin(), indices.end(), static_cast<std::int32_t>(axis.first));
    file_.variable({.name = name, .dimensions = {place}, .values = std::move(indices)});
    return place;
  }
  /// An output may be called like one of ours.
  std::string free_name(std::string name) {
    while (std::ranges::find(taken_, name) != taken_.end()) name += "_";
    taken_.push_back(name);
    return name;
  }

  const model::Model& model_;
  const model::Plan& plan_;
  std::span<const model::Column> columns_;
  NetcdfLayout file_;
  std::size_t time_ = 0;
  std::vector<std::pair<ColumnFamily::Axis, std::size_t>> axes_;
  std::vector<std::string> taken_{"time",  "body",        "component", "part",   "position", "velocity",
                                  "angle", "orientation", "spin",      "radius", "mass"};
};

}  // namespace

NetcdfLayout netcdf_layout(const model::Model& model, const model::Plan& plan, std::span<const model::Column> columns,
                           std::string_view manifest_hash) {
  return ModelLayout(model, plan, columns).layout(manifest_hash);
}

Status write_netcdf(const model::Model& model, const model::Run& run, const std::string& path,
                    std::string_view manifest_hash) {
  NetcdfFile file(path, netcdf_layout(model, run.plan, run.motion.columns, manifest_hash));
  std::vector<double> values;
  for (std::size_t row = 0; row < run.motion.rows() && file.status(); ++row) {
    values.assign(run.motion.row(row).begin(), run.motion.row(row).end());
    values.push_back(run.total_energy.empty() ? std::nan("") : run.total_energy[row]);
    file.row(values);
  }
  return file.close();
}

}  // namespace continuo::results
