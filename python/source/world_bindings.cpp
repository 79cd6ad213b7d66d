// The classes World2 and World3 of the module: bodies in the plane and in space.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bound_world.hpp"
#include "gil.hpp"
#include "moving_world.hpp"
#include "parts.hpp"

namespace py = pybind11;
using namespace continuo;
using continuo::python::Array;
using continuo::python::BoundWorld;
using continuo::python::FormerArrays;
using continuo::python::handle_of;
using continuo::python::MotionSettings;
using continuo::python::MovingWorld;
using continuo::python::number_of;
using continuo::python::raise_unless;
using continuo::python::WithoutGil;

namespace {

/// While Python waits for a move, Ctrl-C sets the interrupt of the world that is moved; Python's own handler is called
/// as well, and raises KeyboardInterrupt when the move has ended.
class InterruptOfSignal {
 public:
  explicit InterruptOfSignal(std::atomic<bool>& interrupt) {
    std::atomic<bool>* none = nullptr;
    is_first_ = is_main_thread() && interrupt_.compare_exchange_strong(none, &interrupt);
    if (!is_first_) return;
    struct sigaction action{};
    action.sa_handler = &InterruptOfSignal::handle;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &former_);
  }
  ~InterruptOfSignal() {
    if (!is_first_) return;
    sigaction(SIGINT, &former_, nullptr);
    interrupt_ = nullptr;
  }
  InterruptOfSignal(const InterruptOfSignal&) = delete;
  InterruptOfSignal& operator=(const InterruptOfSignal&) = delete;

 private:
  static bool is_main_thread() {
    const py::module_ threading = py::module_::import("threading");
    return threading.attr("current_thread")().is(threading.attr("main_thread")());
  }
  static void handle(int signal) {
    if (std::atomic<bool>* interrupt = interrupt_) *interrupt = true;
    if (former_.sa_handler != SIG_DFL && former_.sa_handler != SIG_IGN) former_.sa_handler(signal);
  }

  static std::atomic<std::atomic<bool>*> interrupt_;
  static struct sigaction former_;
  bool is_first_ = false;
};
std::atomic<std::atomic<bool>*> InterruptOfSignal::interrupt_{nullptr};
struct sigaction InterruptOfSignal::former_{};

template <int Dim>
class Bound : public BoundWorld<Dim> {
 public:
  using typename BoundWorld<Dim>::M;
  using typename BoundWorld<Dim>::W;
  using typename BoundWorld<Dim>::V;
  using typename BoundWorld<Dim>::Pointer;
  using BoundWorld<Dim>::idle, BoundWorld<Dim>::vector, BoundWorld<Dim>::array, BoundWorld<Dim>::known;

  // ---- bodies ----

  /// Rows of numbers, one for each body; the columns are those of `add` in world.py. `shape` is one for all bodies, as
  /// shape_from reads it, or None for balls. A kind is 1 of a fixed body, 2 of a driven one, 4 of a sensor, and what is
  /// locked from the eighth bit on.
  static std::vector<std::uint64_t> add(const Pointer& moving, const Array& rows, const py::object& shape,
                                        bool has_mass, const std::vector<std::uint32_t>& kinds,
                                        const std::vector<std::uint32_t>& groups, std::uint64_t category,
                                        std::uint64_t mask) {
    M& m = idle(moving);
    constexpr py::ssize_t spins = Dim == 2 ? 1 : 3, turns = Dim == 2 ? 1 : 4, columns = 2 * Dim + spins + turns + 9;
    if (rows.ndim() != 2 || rows.shape(1) != columns) throw py::value_error("rows of another form");
    const auto count = static_cast<std::size_t>(rows.shape(0));
    std::vector<BodyDefinition<double, Dim>> definitions(count);
    std::optional<Shape<double, Dim>> of_all;
    if (!shape.is_none()) of_all = python::shape_from<Dim>(shape.cast<py::tuple>());
    for (std::size_t i = 0; i < count; ++i) {
      const double* row = rows.data(static_cast<py::ssize_t>(i), 0);
      BodyDefinition<double, Dim>& d = definitions[i];
      for (std::size_t k = 0; k < Dim; ++k) d.position[k] = *row++;
      for (std::size_t k = 0; k < Dim; ++k) d.velocity[k] = *row++;
      for (std::size_t k = 0; k < spins; ++k) d.spin[k] = *row++;
      for (std::size_t k = 0; k < turns; ++k) d.orientation[k] = *row++;
      d.shape = of_all ? *of_all : Shape<double, Dim>(Sphere<double>{*row});
      ++row;
      if (has_mass) d.mass = *row;
      ++row;
      d.density = *row++;
      d.material = {row[0], row[1], row[2]};
      d.fixed = (kinds[i] & 1u) != 0;
      d.group = groups[i];
      d.traits = {.is_driven = (kinds[i] & 2u) != 0,
                  .is_sensor = (kinds[i] & 4u) != 0,
                  .locked = static_cast<Locked>(kinds[i] >> 8u),
                  .gravity_scale = row[3],
                  .damping = row[4],
                  .spin_damping = row[5],
                  .category = category,
                  .mask = mask};
    }
    W& world = m.bodies();
    std::vector<std::uint64_t> handles;
    for (std::size_t i = 0; i < count; ++i) {
      const Result<BodyHandle> handle = world.add(definitions[i]);
      if (!handle) {  // all of them or none
        for (std::size_t k = handles.size(); k-- > 0;) world.remove(handle_of(handles[k]));
        throw py::value_error(count > 1 ? fmt::format("body {}: {}", i, describe(handle.status()))
                                        : describe(handle.status()));
      }
      handles.push_back(number_of(*handle));
    }
    return handles;
  }

  /// A view of an array of the world, or a copy where it must not be written.
  template <class Element>
  static py::array view(const Pointer& moving, std::vector<Element> FormerArrays<Dim>::*, std::vector<Element>& array,
                        bool is_writable) {
    const std::shared_ptr<FormerArrays<Dim>> memory = moving->memory();
    auto* keeper = new std::pair<Pointer, std::shared_ptr<FormerArrays<Dim>>>(moving, memory);
    const py::capsule owner(
        keeper, [](void* kept) { delete static_cast<std::pair<Pointer, std::shared_ptr<FormerArrays<Dim>>>*>(kept); });
    const auto n = static_cast<py::ssize_t>(array.size());
    py::array result;
    if constexpr (std::is_same_v<Element, double>) {
      result = py::array_t<double>({n}, {py::ssize_t{sizeof(double)}}, array.data(), owner);
    } else {
      constexpr auto width = static_cast<py::ssize_t>(Element::size());
      auto* first = reinterpret_cast<double*>(array.data());
      if (width == 1) {
        result = py::array_t<double>({n}, {py::ssize_t{sizeof(double)}}, first, owner);
      } else {
        result = py::array_t<double>({n, width}, {width * py::ssize_t{sizeof(double)}, py::ssize_t{sizeof(double)}},
                                     first, owner);
      }
    }
    if (!is_writable) result.attr("flags").attr("writeable") = false;
    return result;
  }

  // ---- moves ----

  template <class Move>
  static void move(const Pointer& moving, Move&& by) {
    bool is_free = false;
    if (!moving->busy.compare_exchange_strong(is_free, true))
      throw std::runtime_error("the world is being moved by another thread");
    Status status;
    {
      const InterruptOfSignal interrupt(moving->interrupt);
      const WithoutGil release;
      try {
        status = by(*moving);
      } catch (...) {
        moving->busy = false;
        throw;
      }
      moving->busy = false;
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    raise_unless(status);
  }

  static py::dict events(const Pointer& moving) {
    const M& m = idle(moving);
    const auto n = static_cast<py::ssize_t>(m.events().size());
    py::array_t<double> time(n), impulse(n), point({n, py::ssize_t{Dim}}), normal({n, py::ssize_t{Dim}});
    py::array_t<std::int64_t> a(n), b(n), wall(n);
    py::array_t<std::int8_t> change(n);
    for (py::ssize_t i = 0; i < n; ++i) {
      const auto& event = m.events()[static_cast<std::size_t>(i)];
      time.mutable_at(i) = event.time, impulse.mutable_at(i) = event.impulse;
      a.mutable_at(i) = static_cast<std::int64_t>(number_of(event.a));
      b.mutable_at(i) = event.with_wall() ? -1 : static_cast<std::int64_t>(number_of(event.b));
      wall.mutable_at(i) = event.with_wall() ? static_cast<std::int64_t>(event.wall) : -1;
      change.mutable_at(i) = static_cast<std::int8_t>(event.change);
      for (py::ssize_t k = 0; k < Dim; ++k) {
        point.mutable_at(i, k) = event.point[static_cast<std::size_t>(k)];
        normal.mutable_at(i, k) = event.normal[static_cast<std::size_t>(k)];
      }
    }
    py::dict fields;
    fields["time"] = time, fields["change"] = change, fields["a"] = a, fields["b"] = b, fields["wall"] = wall;
    fields["point"] = point, fields["normal"] = normal, fields["impulse"] = impulse;
    return fields;
  }

  // ---- walls and forces ----

  static void add_spring(const Pointer& moving, std::uint64_t a, std::optional<std::uint64_t> b,
                         const std::optional<Array>& point, double rest_length, double stiffness, double damping) {
    M& m = idle(moving);
    for (const auto& [value, name] :
         {std::pair{rest_length, "rest_length"}, std::pair{stiffness, "stiffness"}, std::pair{damping, "damping"}}) {
      if (!(value >= 0 && value < std::numeric_limits<double>::infinity()))
        throw py::value_error(fmt::format("{} is {}; it must be 0 or more, and finite", name, value));
    }
    Spring<double, Dim> spring{
        .a = known(m, a), .rest_length = rest_length, .stiffness = stiffness, .damping = damping};
    if (b) {
      spring.b = known(m, *b);
    } else {
      spring.b = vector(*point, "b");
      if (!is_finite(std::get<V>(spring.b))) throw py::value_error("the point is not finite");
    }
    m.forces().springs.push_back(spring);
  }

  static void remove(const Pointer& moving, std::uint64_t number) {
    M& m = idle(moving);
    const BodyHandle handle = known(m, number);
    W& world = m.bodies();
    std::erase_if(world.springs, [&](const Spring<double, Dim>& spring) {
      return spring.a == handle ||
             (std::holds_alternative<BodyHandle>(spring.b) && std::get<BodyHandle>(spring.b) == handle);
    });
    world.remove(handle);
  }
};

template <int Dim>
void bind(py::module_& module, const char* name) {
  using B = Bound<Dim>;
  using M = typename B::M;
  using W = typename B::W;
  using P = std::shared_ptr<M>;
  using F = FormerArrays<Dim>;
  const auto view = [](auto former, auto array, bool is_writable) {
    return [=](const P& m) { return B::view(m, former, const_cast<W&>(B::idle(m).world()).*array, is_writable); };
  };
  python::WorldClass<Dim> world(module, name);
  python::bind_shapes<Dim>(world);
  python::bind_joints<Dim>(world);
  python::bind_queries<Dim>(world);
  python::bind_vehicles<Dim>(world);
  world.def(py::init<MotionSettings>(), py::arg("settings"))
      .def("set", [](const P& m, const MotionSettings& settings) { B::idle(m).set(settings); })
      .def("__len__", [](const P& m) { return m->world().size(); })
      .def("add", &B::add)
      .def("remove", &B::remove)
      .def("contains", [](const P& m, std::uint64_t body) { return m->world().contains(handle_of(body)); })
      .def("index", [](const P& m, std::uint64_t body) { return m->world().index(B::known(*m, body)); })
      .def("handles",
           [](const P& m) {
             std::vector<std::uint64_t> handles;
             for (std::size_t i = 0; i < m->world().size(); ++i) handles.push_back(number_of(m->world().handle(i)));
             return handles;
           })
      .def("positions", view(&F::position, &W::position, true))
      .def("velocities", view(&F::velocity, &W::velocity, true))
      .def("orientations", view(&F::orientation, &W::orientation, true))
      .def("spins", view(&F::spin, &W::spin, true))
      .def("radii", view(&F::radius, &W::radius, false))
      .def("masses", view(&F::mass, &W::mass, false))
      .def("fixed",
           [](const P& m) {
             std::vector<bool> fixed;
             for (std::size_t i = 0; i < m->world().size(); ++i) fixed.push_back(m->world().is_fixed(i));
             return fixed;
           })
      .def("time", [](const P& m) { return m->world().time; })
      .def("gravity", [](const P& m) { return B::array(m->world().gravity); })
      .def("set_gravity",
           [](const P& m, const Array& gravity) {
             const auto g = B::vector(gravity, "gravity");
             if (!is_finite(g)) throw py::value_error("gravity is not finite");
             B::idle(m).forces().gravity = g;
           })
      .def("add_wall",
           [](const P& m, const Array& normal, double offset, bool thin, std::array<double, 3> material) {
             raise_unless(B::idle(m).forces().add_wall({.normal = B::vector(normal, "normal"),
                                                        .offset = offset,
                                                        .material = {material[0], material[1], material[2]},
                                                        .thin = thin}));
             return m->world().walls().size() - 1;
           })
      .def("add_container",
           [](const P& m, const Array& lower, const Array& upper, std::array<double, 3> material) {
             raise_unless(B::idle(m).forces().add_container(B::vector(lower, "lower"), B::vector(upper, "upper"),
                                                            {material[0], material[1], material[2]}));
           })
      .def("walls",
           [](const P& m) {
             py::list walls;
             for (const auto& wall : m->world().walls())
               walls.append(py::make_tuple(B::array(wall.normal), wall.offset, wall.thin));
             return walls;
           })
      .def("add_spring", &B::add_spring)
      .def("set_drag",
           [](const P& m, double linear, double quadratic) { B::idle(m).forces().drag = {linear, quadratic}; })
      .def("set_attraction", [](const P& m, double constant, double softening,
                                double opening) { B::idle(m).forces().attraction = {constant, softening, opening}; })
      .def("ignore",
           [](const P& m, std::uint32_t a, std::uint32_t b) { raise_unless(B::idle(m).forces().ignore(a, b)); })
      .def("advance_to", [](const P& m, double t) { B::move(m, [t](M& moving) { return moving.advance_to(t); }); })
      .def("advance",
           [](const P& m, std::size_t steps) { B::move(m, [steps](M& moving) { return moving.advance(steps); }); })
      .def("events", &B::events)
      .def("asleep", [](const P& m) { return B::idle(m).asleep(); })
      .def("lost_events", [](const P& m) { return m->lost_events(); })
      .def("kinetic_energy", [](const P& m) { return kinetic_energy(B::idle(m).world()); })
      .def("potential_energy", [](const P& m) { return potential_energy(B::idle(m).world()); })
      .def("momentum", [](const P& m) { return B::array(momentum(B::idle(m).world())); })
      .def("angular_momentum",
           [](const P& m) {
             const auto l = angular_momentum(B::idle(m).world());
             return Array(static_cast<py::ssize_t>(l.size()), l.components.data());
           })
      .def("state_hash", [](const P& m) { return state_hash(B::idle(m).world()); })
      .def("save",
           [](const P& m) {
             const std::vector<std::byte> bytes = B::idle(m).save();
             return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
           })
      .def("restore", [](const P& m, const std::string& bytes) {
        raise_unless(B::idle(m).restore(std::as_bytes(std::span(bytes))));
      });
}

}  // namespace

void add_world(py::module_& module) {
  py::class_<MotionSettings>(module, "MotionSettings")
      .def(py::init<>())
      .def_readwrite("exact", &MotionSettings::exact)
      .def_readwrite("step", &MotionSettings::step)
      .def_readwrite("substeps", &MotionSettings::substeps)
      .def_readwrite("threads", &MotionSettings::threads)
      .def_readwrite("sleep_after", &MotionSettings::sleep_after)
      .def_readwrite("tolerance", &MotionSettings::tolerance)
      .def_readwrite("contact_time", &MotionSettings::contact_time)
      .def_readwrite("contact_events", &MotionSettings::contact_events);
  bind<2>(module, "World2");
  bind<3>(module, "World3");
}
