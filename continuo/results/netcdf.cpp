#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <netcdf.h>

#include <continuo/model/world.hpp>
#include <continuo/results/families.hpp>
#include <continuo/results/netcdf.hpp>

namespace continuo::results {

namespace {

/// A file being written; after the first failure nothing more is tried.
class File {
 public:
  explicit File(const std::string& path) { note(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &file_)); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { close(); }

  bool good() const { return status_ == NC_NOERR; }
  int status() const { return status_; }
  void close() {
    if (file_ >= 0) note(nc_close(file_));
    file_ = -1;
  }

  int dimension(const char* name, std::size_t size) {
    int id = -1;
    if (good()) note(nc_def_dim(file_, name, size, &id));
    return id;
  }
  int variable(const std::string& name, int type, const std::vector<int>& dimensions, const std::string& unit = {}) {
    int id = -1;
    if (good())
      note(nc_def_var(file_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
    if (!unit.empty()) attribute(id, "units", unit);
    return id;
  }
  void attribute(int variable, const char* name, std::string_view text) {
    if (good() && !text.empty()) note(nc_put_att_text(file_, variable, name, text.size(), text.data()));
  }
  void end_definitions() {
    if (good()) note(nc_enddef(file_));
  }
  void put(int variable, const std::vector<double>& values) {
    if (good() && !values.empty()) note(nc_put_var_double(file_, variable, values.data()));
  }
  void put(int variable, const std::vector<std::string>& texts) {
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    if (good() && !pointers.empty()) note(nc_put_var_string(file_, variable, pointers.data()));
  }

 private:
  void note(int status) {
    if (status != NC_NOERR && status_ == NC_NOERR) status_ = status;
  }

  int file_ = -1, status_ = NC_NOERR;
};

/// A variable over time, bodies and the parts of a vector or quaternion, and which state of each body it is made of.
struct OfBodies {
  std::string name, unit, long_name;
  std::vector<std::size_t> states;  // one per part
  int id = -1;
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

class Writer {
 public:
  Writer(const model::Model& model, const model::Run& run, const std::string& path)
      : model_(model), run_(run), file_(path) {}

  int write(std::string_view hash) {
    file_.attribute(NC_GLOBAL, "Conventions", "CF-1.8");
    file_.attribute(NC_GLOBAL, "title", model_.name);
    file_.attribute(NC_GLOBAL, "source", "Continuo, method " + run_.plan.method);
    file_.attribute(NC_GLOBAL, "comment", model_.heading);
    file_.attribute(NC_GLOBAL, "manifest", hash);
    time_ = file_.dimension("time", run_.motion.rows());
    const int time = file_.variable("time", NC_DOUBLE, {time_}, model_.time_unit);
    file_.attribute(time, "standard_name", "time");
    file_.attribute(time, "axis", "T");
    if (model_.has_world()) define_bodies();
    define_columns();
    file_.end_definitions();
    file_.put(time, columns({0}));
    if (model_.has_world()) put_bodies();
    for (std::size_t k = 0; k < axes_.size(); ++k) put_axis(k);
    for (const auto& [id, places] : columns_) file_.put(id, columns(places));
    if (energy_ >= 0) file_.put(energy_, run_.total_energy);
    file_.close();
    return file_.status();
  }

 private:
  std::vector<double> columns(const std::vector<std::size_t>& places) const {
    std::vector<double> values;
    for (std::size_t row = 0; row < run_.motion.rows(); ++row)
      for (const std::size_t place : places) values.push_back(run_.motion.row(row)[place]);
    return values;
  }

  void define_bodies() {
    const model::WorldDescription& world = *model_.world;
    const int body = file_.dimension("body", world.bodies.size());
    const int component = file_.dimension("component", static_cast<std::size_t>(world.dimension));
    names_ = file_.variable("body", NC_STRING, {body});
    file_.attribute(names_, "cf_role", "trajectory_id");
    components_ = file_.variable("component", NC_STRING, {component});
    int part = -1;
    if (world.dimension == 3) {
      part = file_.dimension("part", 4);
      parts_ = file_.variable("part", NC_STRING, {part});
      file_.attribute(parts_, "long_name", "part of a quaternion");
    }
    of_bodies_ = variables_of(model_);
    for (OfBodies& variable : of_bodies_) {
      std::vector<int> dimensions{time_, body};
      if (variable.states.size() > 1) dimensions.push_back(variable.states.size() == 4 ? part : component);
      variable.id = file_.variable(variable.name, NC_DOUBLE, dimensions, variable.unit);
      file_.attribute(variable.id, "long_name", variable.long_name);
    }
    radius_ = file_.variable("radius", NC_DOUBLE, {body}, world.length_unit);
    mass_ = file_.variable("mass", NC_DOUBLE, {body}, world.mass_unit);
  }

  void put_bodies() {
    const model::WorldDescription& world = *model_.world;
    std::vector<std::string> names;
    std::vector<model::NodeId> radii, masses;
    for (const model::BodyDescription& body : world.bodies) {
      names.push_back(body.name);
      radii.push_back(body.radius);
      masses.push_back(body.mass);
    }
    file_.put(names_, names);
    file_.put(components_,
              world.dimension == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"});
    if (parts_ >= 0) file_.put(parts_, std::vector<std::string>{"w", "x", "y", "z"});
    file_.put(radius_, evaluate(model_, radii, run_.plan.variables));
    file_.put(mass_, evaluate(model_, masses, run_.plan.variables));
    std::vector<double> values;
    for (const OfBodies& variable : of_bodies_) {
      values.clear();
      for (std::size_t row = 0; row < run_.motion.rows(); ++row) {
        const auto state = run_.motion.state(row);
        for (const model::BodyDescription& body : world.bodies)
          for (const std::size_t k : variable.states) values.push_back(state[body.first_state + k]);
      }
      file_.put(variable.id, values);
    }
  }

  /// All that is not of bodies: states of equations, measures of the world, outputs, energies; families as arrays.
  void define_columns() {
    const std::size_t first = 1 + (model_.has_world() ? model_.world->body_states() : 0);
    for (ColumnFamily& family : families_of(std::span(run_.motion.columns).subspan(first))) {
      std::vector<int> dimensions{time_};
      for (const ColumnFamily::Axis& axis : family.axes) dimensions.push_back(dimension_of(axis, dimensions));
      for (std::size_t& place : family.places) place += first;
      columns_.emplace_back(file_.variable(free_name(family.name), NC_DOUBLE, dimensions, family.unit),
                            std::move(family.places));
    }
    if (run_.total_energy.empty()) return;
    energy_ = file_.variable(free_name("energy"), NC_DOUBLE, {time_}, run_.energy ? run_.energy->unit : "");
    file_.attribute(energy_, "long_name", "sum of all energies");
  }
  /// Families of the same indices share their dimensions, `i`, `j`, ..., so that they can be added to each other.
  int dimension_of(const ColumnFamily::Axis& axis, const std::vector<int>& taken) {
    for (const auto& [known, id, variable] : axes_)
      if (known == axis && std::ranges::find(taken, id) == taken.end()) return id;
    std::string letter = "i";
    if (axes_.size() < 12) {
      letter[0] = static_cast<char>('i' + axes_.size());
    } else {
      letter += std::to_string(axes_.size());
    }
    const std::string name = free_name(letter);
    const int id = file_.dimension(name.c_str(), axis.count);
    axes_.push_back({axis, id, file_.variable(name, NC_INT, {id})});
    return id;
  }
  void put_axis(std::size_t k) {
    std::vector<double> indices(axes_[k].axis.count);
    std::iota(indices.begin(), indices.end(), static_cast<double>(axes_[k].axis.first));
    file_.put(axes_[k].variable, indices);
  }
  /// An output may be called like one of ours.
  std::string free_name(std::string name) {
    while (std::ranges::find(taken_, name) != taken_.end()) name += "_";
    taken_.push_back(name);
    return name;
  }

  const model::Model& model_;
  const model::Run& run_;
  File file_;
  int time_ = -1, names_ = -1, components_ = -1, parts_ = -1, radius_ = -1, mass_ = -1, energy_ = -1;
  std::vector<OfBodies> of_bodies_;
  struct AxisOfFamilies {
    ColumnFamily::Axis axis;
    int id, variable;
  };
  std::vector<AxisOfFamilies> axes_;
  std::vector<std::pair<int, std::vector<std::size_t>>> columns_;
  std::vector<std::string> taken_{"time",  "body",        "component", "part",   "position", "velocity",
                                  "angle", "orientation", "spin",      "radius", "mass"};
};

}  // namespace

bool is_netcdf(std::string_view path) {
  return path.ends_with(".nc");
}

std::optional<std::string> write_netcdf(const model::Model& model, const model::Run& run, const std::string& path,
                                        std::string_view manifest_hash) {
  const int status = Writer(model, run, path).write(manifest_hash);
  if (status == NC_NOERR) return std::nullopt;
  return "cannot write " + path + ": " + nc_strerror(status);
}

}  // namespace continuo::results
