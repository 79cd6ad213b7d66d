// continuo/worlds/world_run.hpp
// The world of a model in motion, which can be advanced, read, changed and saved. One type serves both dimensions and
// all modes.
//
//   auto started = start_world(program, {.method = "exact"}, start_values(program->model));
//   if (!started) std::cerr << describe(started.status());
//   WorldRun& run = *started.run;
//   if (const Status status = run.advance_to(1.5); !status) ...
//   for (std::size_t i = 0; i < run.bodies().size(); ++i) draw(run.position(i), run.bodies()[i].radius);
//
// Equations beside the bodies are integrated with them. In the exact mode all is one system, integrated by one method.
// In the fast mode the steps alternate: half a step of the equations with the bodies fixed, a step of the bodies with
// the states of the equations fixed, half a step of the equations (G. Strang, "On the construction and comparison of
// difference schemes", SIAM J. Num. Anal. 5 (1968)). That is of order 2 where the bodies are moved by the central
// difference, of order 1 by the Euler methods.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/language/world.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/status/result.hpp>

namespace continuo::worlds {

/// z is 0 in the plane.
using Point = std::array<double, 3>;

/// The scalar product.
[[nodiscard]] inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The surface of bodies that are not balls, in the frame of a body: polygons of the plane, or the faces of a
/// polyhedron. What is round has many corners.
struct BodyForm {
  std::vector<Point> corners;                     // each once
  std::vector<std::vector<std::uint32_t>> faces;  // by their corners, counter-clockwise seen from outside
};
/// The form of a ball, which has none.
inline constexpr std::size_t no_form = static_cast<std::size_t>(-1);
/// The constant data of a body.
struct BodyShape {
  std::string name;
  double radius, mass;  // radius: the greatest distance of a point from the centre
  bool fixed;
  std::size_t form = no_form;  // the number of its form
};
/// normal . x >= offset is free; the normal has the length 1.
struct WallShape {
  std::string name;
  Point normal;
  double offset;
  bool thin = false;  // free on both sides
};
/// A surface that never moves. Its facets are triangles, counter-clockwise seen from the free side; in the plane
/// segments of two corners, whose last number repeats the second one, with what is free on their right.
struct StaticMeshShape {
  std::string name;
  std::vector<Point> corners;                        // places in the world
  std::vector<std::array<std::uint32_t, 3>> facets;  // by their corners
  bool thin = false;                                 // free on both sides
};
/// The ends of a spring.
struct SpringShape {
  std::size_t a, b;  // bodies; b is model::no_body where it ends at the point
  Point point;
};

/// A joint and where it holds its bodies, in their frames; of the world, in the world.
struct JointShape {
  std::string name;    // empty where it has none
  std::string kind;    // "hinge"
  std::size_t first;   // a body
  std::size_t second;  // a body, or model::no_body: the world
  Point on_first;      // where it holds the first
  Point on_second;     // where it holds the second
  Point axis;          // of sliders and wheels, in the frame of the second; else 0
  double apart;        // the greatest distance of the two places, beyond which it is broken; infinite where it has none
};

/// An impact, or the beginning or end of a lasting contact.
struct Contact {
  ContactChange change;
  std::size_t a, b;  // bodies; b is model::no_body where it was a wall or a mesh
  std::size_t wall;  // the number of the wall; model::no_body where it was none
  std::size_t mesh;  // the number of the mesh; model::no_body where it was none
  Point point;
  double impulse;  // along the normal; of a lasting contact the whole impulse, at its end
  double time;
};

/// How a world is moved.
struct WorldOptions {
  std::string method = "exact";                  // one of model::world_methods(), in language/world_methods.hpp
  double step = 0;                               // of methods with steps
  double tolerance = 1e-10;                      // of paths under forces, exact
  const std::atomic<bool>* interrupt = nullptr;  // once it is true, an advance ends as `interrupted`
  std::size_t most_contacts = 0;                 // at most so many of one advance are kept
};
/// The options that a plan asks for.
[[nodiscard]] WorldOptions options_of(const model::Plan& plan);

/// A world at an instant, with all data that a run needs to continue to the same bits.
struct Snapshot {
  Bytes bodies;
  std::vector<double> equations, variables, characters;
  double time = 0, start = 0;  // start: of the steps
  std::uint64_t steps = 0;
  std::size_t collisions = 0;
  std::size_t mode = 0;
  std::string method;
  double step = 0;
};

/// A world of a model in motion. One object serves one thread at a time.
class WorldRun {
 public:
  WorldRun() = default;
  WorldRun(const WorldRun&) = delete;
  WorldRun& operator=(const WorldRun&) = delete;
  virtual ~WorldRun() = default;

  /// 2 or 3.
  [[nodiscard]] virtual int dimension() const = 0;
  /// The time of the world, in the model's unit of time.
  [[nodiscard]] virtual double time() const = 0;
  /// Advances to t; with steps, to the first end of a step that is not before t. On failure the world stays at the time
  /// that it has reached.
  virtual Status advance_to(double t) = 0;
  /// 0 without steps.
  [[nodiscard]] virtual double step() const = 0;

  /// The bodies, in the order of the model.
  [[nodiscard]] virtual const std::vector<BodyShape>& bodies() const = 0;
  /// The walls, in the order of the model.
  [[nodiscard]] virtual const std::vector<WallShape>& walls() const = 0;
  /// The surfaces that never move, in the order of the model.
  [[nodiscard]] virtual const std::vector<StaticMeshShape>& meshes() const = 0;
  /// The springs, in the order of the model.
  [[nodiscard]] virtual const std::vector<SpringShape>& springs() const = 0;
  /// The forms of bodies that are not balls, each once.
  [[nodiscard]] virtual const std::vector<BodyForm>& forms() const = 0;
  /// The joints, in the order of the model.
  [[nodiscard]] virtual const std::vector<JointShape>& joints() const = 0;

  /// The centre of a body, in the model's unit of length.
  [[nodiscard]] virtual Point position(std::size_t body) const = 0;
  /// The velocity of a body.
  [[nodiscard]] virtual Point velocity(std::size_t body) const = 0;
  /// The spin about the axes; in the plane it is the third component.
  [[nodiscard]] virtual Point spin(std::size_t body) const = 0;
  /// A unit quaternion (w, x, y, z).
  [[nodiscard]] virtual std::array<double, 4> orientation(std::size_t body) const = 0;
  /// The kinetic energy of all bodies that move.
  [[nodiscard]] virtual double kinetic_energy() const = 0;
  /// The potential energy of gravity, constant forces, springs and attraction.
  [[nodiscard]] virtual double potential_energy() const = 0;
  /// The contacts of the last advance, the first `most_contacts` of them.
  [[nodiscard]] virtual const std::vector<Contact>& contacts() const = 0;
  /// "ball meets floor", "ball leaves floor".
  [[nodiscard]] std::string name_of(const Contact& contact) const;

  /// The model's states: of bodies, of equations, measures of the world.
  virtual const std::vector<double>& state() = 0;
  /// Sets the states of bodies and equations; measures are ignored.
  virtual void set_state(std::span<const double> state) = 0;
  /// Begins again from another instant, of any run of this model. The motion finds the rest of its internal state, such
  /// as contacts, again.
  virtual void place(double t, std::span<const double> state) = 0;
  /// Draws a body's centre to a point by a force, as a hand does, from now on until it is let go; nothing: lets it go.
  /// Only where `is_rigid`.
  virtual void pull(std::optional<std::pair<std::size_t, Point>> body_and_target) = 0;
  /// Whether there are joints, meshes, or bodies that are not balls: then a hand does not set bodies, it pulls.
  [[nodiscard]] virtual bool is_rigid() const = 0;
  /// Moves one body elsewhere, for example where a user drags it.
  virtual void set_body(std::size_t body, const Point& position, const Point& velocity) = 0;
  /// Sets a parameter or an input, by its place in the flat space (`Parameter::variable`), with all values that depend
  /// on it. Fails where the world would be invalid, and then leaves it unchanged.
  virtual Status set(std::uint32_t variable, double value) = 0;
  /// The register file: t, states, parameters, inputs.
  virtual std::span<const double> variables() = 0;
  /// The mode of the equations.
  [[nodiscard]] virtual std::size_t mode() const = 0;
  /// Changes the mode of the equations.
  virtual void go(std::size_t mode) = 0;

  /// The present state, from which this or another run of the same model can continue to the same bits.
  [[nodiscard]] virtual Snapshot snapshot() const = 0;
  /// Whether this run can continue from a snapshot that was read from a file, which may contain anything.
  virtual Status check(const Snapshot& snapshot) const = 0;
  /// Continues from a snapshot of a run with the same method and step.
  virtual Status restore(const Snapshot& snapshot) = 0;
};

/// `variables` is a register file as `start_values` gives it. The program must have a world. Fails where the world
/// cannot begin with these values.
Result<std::unique_ptr<WorldRun>> start_world(std::shared_ptr<const model::ModelProgram> program,
                                              const WorldOptions& options, std::span<const double> variables);

}  // namespace continuo::worlds
