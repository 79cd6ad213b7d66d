// solve_bvp: functions of Python that take many points at once, for the solver of two-point problems.
#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>

#include "gil.hpp"
#include "native_at_points.hpp"
#include "parts.hpp"
#include <continuo/boundary/two_point.hpp>

namespace py = pybind11;

namespace {

using continuo::ComplexNumber;
using continuo::boundary::solve_two_point;
using continuo::boundary::TwoPointOptions;
using continuo::boundary::TwoPointProblem;
using continuo::boundary::TwoPointProgress;
using continuo::boundary::TwoPointSolution;
using continuo::python::NativeAtPoints;

/// The type that NumPy knows a number by; in memory they are the same.
template <class Number>
using NumberOfPython = std::conditional_t<std::is_same_v<Number, double>, double, std::complex<double>>;
static_assert(sizeof(std::complex<double>) == sizeof(ComplexNumber<double>));

template <class Number>
using Array = py::array_t<NumberOfPython<Number>, py::array::c_style | py::array::forcecast>;
using Shape = std::span<const py::ssize_t>;

template <class Number>
const Number* numbers_of(const Array<Number>& array) {
  return reinterpret_cast<const Number*>(array.data());
}

/// A new array of these numbers: what NumPy does itself, since functions are called with a million of them.
template <class Number>
Array<Number> array_of(Shape shape, const Number* numbers) {
  static const py::handle dtype = py::dtype::of<NumberOfPython<Number>>().release();
  auto& numpy = py::detail::npy_api::get();
  PyObject* const array =
      numpy.PyArray_NewFromDescr_(numpy.PyArray_Type_, dtype.inc_ref().ptr(), static_cast<int>(shape.size()),
                                  shape.data(), nullptr, nullptr, 0, nullptr);
  if (array == nullptr) throw py::error_already_set();
  auto result = py::reinterpret_steal<Array<Number>>(array);
  std::copy_n(numbers, result.size(), reinterpret_cast<Number*>(result.mutable_data()));
  return result;
}
template <class Number>
Array<Number> array_of(std::span<const Number> numbers) {
  return array_of(std::array{static_cast<py::ssize_t>(numbers.size())}, numbers.data());
}

std::string text_of(Shape shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i > 0 ? " " : "") + std::to_string(shape[i]) + (i + 1 < shape.size() || i == 0 ? "," : "");
  return text + ")";
}

/// None would become a NaN.
bool holds_no_none(const py::array& objects) {
  const py::list elements = objects.attr("ravel")().attr("tolist")();
  return std::none_of(elements.begin(), elements.end(), [](py::handle element) { return element.is_none(); });
}

/// What a function of the user's has returned, as an array of numbers of this shape. The message is SciPy's.
template <class Number>
Array<Number> checked(const py::object& returned, Shape shape, const char* name) {
  auto array = py::reinterpret_steal<Array<Number>>(nullptr);
  if (py::isinstance<Array<Number>>(returned)) {
    array = py::reinterpret_borrow<Array<Number>>(returned);
  } else {
    const py::array any = py::array::ensure(returned);
    const char kind = any ? any.dtype().kind() : '?';
    if (kind == 'c' && std::is_same_v<Number, double>)
      throw py::type_error(std::string("`") + name +
                           "` returned complex numbers for a real `y`; pass `y` with a complex data type.");
    if (any && (std::string_view("biufc").find(kind) != std::string_view::npos || (kind == 'O' && holds_no_none(any))))
      array = Array<Number>::ensure(any);
    if (!array) {
      PyErr_Clear();
      throw py::type_error(std::string("`") + name + "` must return an array of numbers with shape " + text_of(shape) +
                           ", but returned " + std::string(py::str(py::type::of(returned))) +
                           " that is none (rows of different lengths, None, or text).");
    }
  }
  if (!std::equal(shape.begin(), shape.end(), array.shape(), array.shape() + array.ndim()))
    throw py::value_error(std::string("`") + name + "` return is expected to have shape " + text_of(shape) +
                          ", but actually has " +
                          text_of(Shape(array.shape(), static_cast<std::size_t>(array.ndim()))) + ".");
  return array;
}

template <class Number>
void copy_checked(const py::object& returned, Shape shape, const char* name, std::span<Number> to) {
  const auto array = checked<Number>(returned, shape, name);
  std::copy_n(numbers_of<Number>(array), to.size(), to.data());
}

/// The parts that a function has returned, at least so many.
std::vector<py::object> parts_of(const py::object& returned, std::size_t count, const char* name) {
  std::vector<py::object> parts;
  if (py::isinstance<py::sequence>(returned))
    for (const auto& part : returned) parts.push_back(py::reinterpret_borrow<py::object>(part));
  if (parts.size() != count)
    throw py::value_error(std::string("`") + name + "` must return " + std::to_string(count) + " arrays.");
  return parts;
}

/// The lock of the interpreter, which the solver gives up and takes for calls. Cheaper than that of pybind11, which
/// looks up the thread each time.
class Lock {
 public:
  /// While it exists the lock is given up.
  class Released {
   public:
    explicit Released(Lock& lock) : lock_(lock) { lock_.thread_ = PyEval_SaveThread(); }
    ~Released() { lock_.take(); }
    Released(const Released&) = delete;
    Released& operator=(const Released&) = delete;

   private:
    Lock& lock_;
  };
  /// While it exists the lock is taken, within what has given it up.
  class Taken {
   public:
    explicit Taken(Lock& lock) : lock_(lock) { lock_.take(); }
    ~Taken() { lock_.thread_ = PyEval_SaveThread(); }
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;

   private:
    Lock& lock_;
  };

 private:
  void take() {
    continuo::python::or_stay([this] { PyEval_RestoreThread(thread_); });
    continuo::python::stay_where_python_ends();
  }

  PyThreadState* thread_ = nullptr;
};

/// Ctrl-C is an exception also where a function of the user's executes no bytecode.
void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// The functions of a problem, called with the lock of the interpreter, which the solver runs without.
template <class Number>
class FunctionsOfPython {
 public:
  using Numbers = std::span<const Number>;
  FunctionsOfPython(Lock& lock, py::object fun, py::object bc, py::object fun_jac, py::object bc_jac, std::size_t size,
                    std::size_t parameters)
      : lock_(lock),
        fun_(std::move(fun)),
        bc_(std::move(bc)),
        fun_jac_(std::move(fun_jac)),
        bc_jac_(std::move(bc_jac)),
        n_(static_cast<py::ssize_t>(size)),
        k_(static_cast<py::ssize_t>(parameters)) {}

  void add_to(TwoPointProblem<Number>& problem) const {
    problem.derivative = [this](std::span<const double> x, Numbers y, Numbers p, std::span<Number> f) {
      derivative(x, y, p, f);
    };
    problem.conditions = [this](Numbers first, Numbers last, Numbers p, std::span<Number> g) {
      conditions(first, last, p, g);
    };
    if (!fun_jac_.is_none())
      problem.derivative_jacobian = [this](std::span<const double> x, Numbers y, Numbers p, std::span<Number> by_y,
                                           std::span<Number> by_p) { jacobian(x, y, p, by_y, by_p); };
    if (!bc_jac_.is_none())
      problem.condition_jacobian = [this](Numbers first, Numbers last, Numbers p, std::span<Number> by_first,
                                          std::span<Number> by_last, std::span<Number> by_p) {
        condition_jacobian(first, last, p, by_first, by_last, by_p);
      };
  }

 private:
  py::object call_at_points(const py::object& function, std::span<const double> x, Numbers y, Numbers p) const {
    check_signals();
    const auto count = static_cast<py::ssize_t>(x.size());
    const auto points = array_of<double>(x);
    const auto values = array_of<Number>(std::array{n_, count}, y.data());
    return k_ == 0 ? function(points, values) : function(points, values, array_of<Number>(p));
  }
  py::object call_at_ends(const py::object& function, Numbers first, Numbers last, Numbers p) const {
    check_signals();
    const auto at_first = array_of<Number>(first), at_last = array_of<Number>(last);
    return k_ == 0 ? function(at_first, at_last) : function(at_first, at_last, array_of<Number>(p));
  }

  void derivative(std::span<const double> x, Numbers y, Numbers p, std::span<Number> f) const {
    const Lock::Taken taken(lock_);
    const std::array shape{n_, static_cast<py::ssize_t>(x.size())};
    const bool is_mesh = x.size() < 2 || x[0] < x[1];
    try {
      copy_checked<Number>(call_at_points(fun_, x, y, p), shape, "fun", f);
    } catch (const py::error_already_set& error) {
      if (is_mesh || !error.matches(PyExc_Exception)) throw;
      std::ranges::fill(f, Number(std::nan("")));
    } catch (const py::builtin_exception&) {
      // Points that coincide are those of differences: a function that takes meshes only is asked again, in meshes.
      if (is_mesh) throw;
      std::ranges::fill(f, Number(std::nan("")));
    }
  }
  void conditions(Numbers first, Numbers last, Numbers p, std::span<Number> g) const {
    const Lock::Taken taken(lock_);
    copy_checked<Number>(call_at_ends(bc_, first, last, p), std::array{n_ + k_}, "bc", g);
  }
  void jacobian(std::span<const double> x, Numbers y, Numbers p, std::span<Number> by_y, std::span<Number> by_p) const {
    const Lock::Taken taken(lock_);
    const auto count = static_cast<py::ssize_t>(x.size());
    const py::object returned = call_at_points(fun_jac_, x, y, p);
    const std::array shape{n_, n_, count};
    if (k_ == 0) return copy_checked<Number>(returned, shape, "fun_jac", by_y);
    const auto parts = parts_of(returned, 2, "fun_jac");
    copy_checked<Number>(parts[0], shape, "fun_jac", by_y);
    copy_checked<Number>(parts[1], std::array{n_, k_, count}, "fun_jac", by_p);
  }
  void condition_jacobian(Numbers first, Numbers last, Numbers p, std::span<Number> by_first, std::span<Number> by_last,
                          std::span<Number> by_p) const {
    const Lock::Taken taken(lock_);
    const auto parts = parts_of(call_at_ends(bc_jac_, first, last, p), k_ == 0 ? 2 : 3, "bc_jac");
    copy_checked<Number>(parts[0], std::array{n_ + k_, n_}, "bc_jac", by_first);
    copy_checked<Number>(parts[1], std::array{n_ + k_, n_}, "bc_jac", by_last);
    if (k_ > 0) copy_checked<Number>(parts[2], std::array{n_ + k_, k_}, "bc_jac", by_p);
  }

  Lock& lock_;
  py::object fun_, bc_, fun_jac_, bc_jac_;
  py::ssize_t n_, k_;
};

/// `fun` where it is compiled, called without the lock of the interpreter; nothing where it is a Python function.
template <class Number>
std::optional<NativeAtPoints> compiled(const py::object& fun, std::size_t size, std::size_t parameters) {
  auto native = continuo::python::native_of(fun, py::none());
  if (!native) return {};
  if (!std::is_same_v<Number, double>)
    throw py::type_error("a compiled `fun` computes with real numbers, and `y` is complex");
  return NativeAtPoints(std::move(*native), size, parameters);
}

void add_compiled(NativeAtPoints& function, TwoPointProblem<double>& problem) {
  using Values = std::span<const double>;
  problem.derivative = [&function](Values x, Values y, Values p, std::span<double> f) {
    function.derivative(x, y, p, f);
  };
  if (function.has_jacobian() && !problem.derivative_jacobian)
    problem.derivative_jacobian = [&function](Values x, Values y, Values p, std::span<double> by_y,
                                              std::span<double> by_p) { function.jacobian(x, y, p, by_y, by_p); };
}

template <class Number>
std::vector<Number> vector_of(const Array<Number>& array) {
  return {numbers_of<Number>(array), numbers_of<Number>(array) + array.size()};
}

/// From (row, column) to (column, row), and back.
template <class Number>
std::vector<Number> transposed(const Number* from, std::size_t rows, std::size_t columns) {
  std::vector<Number> to(rows * columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) to[j * rows + i] = from[i * columns + j];
  return to;
}

/// The coefficients of the spline: c[k, interval, component] of the power 3 - k.
template <class Number>
Array<Number> coefficients(const TwoPointSolution<Number>& solution, std::size_t n) {
  const std::size_t intervals = solution.x.size() - 1;
  std::vector<Number> result(4 * intervals * n);
  for (std::size_t interval = 0; interval < intervals; ++interval) {
    const double h = solution.x[interval + 1] - solution.x[interval];
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t first = interval * n + i, last = first + n;
      const auto c =
          continuo::boundary::cubic(h, solution.y[first], solution.y[last], solution.f[first], solution.f[last]);
      for (std::size_t k = 0; k < 4; ++k) result[k * intervals * n + first] = c[k];
    }
  }
  return array_of<Number>(std::array{py::ssize_t{4}, static_cast<py::ssize_t>(intervals), static_cast<py::ssize_t>(n)},
                          result.data());
}

template <class Number>
py::dict result_of(const TwoPointSolution<Number>& solution, std::size_t n) {
  const std::size_t nodes = solution.x.size();
  const std::array table{static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(nodes)};
  py::dict result;
  result["x"] = array_of<double>(solution.x);
  result["y"] = array_of<Number>(table, transposed(solution.y.data(), nodes, n).data());
  result["yp"] = array_of<Number>(table, transposed(solution.f.data(), nodes, n).data());
  result["p"] = array_of<Number>(std::span(solution.p));
  result["c"] = coefficients(solution, n);
  result["rms_residuals"] = array_of<double>(solution.residuals);
  result["niter"] = solution.last.iteration;
  result["ending"] = static_cast<int>(solution.ending);
  result["quantity"] = static_cast<int>(solution.not_finite);
  result["component"] = solution.component;
  result["where"] = solution.where;
  result["residual"] = solution.last.residual;
  result["condition"] = solution.last.condition;
  return result;
}

template <class Number>
py::dict solve(py::object fun, py::object bc, const Array<double>& x, const Array<Number>& y, const Array<Number>& p,
               const Array<Number>& singular_term, py::object fun_jac, py::object bc_jac, double tol, double bc_tol,
               std::size_t max_nodes, const py::object& progress) {
  const auto n = static_cast<std::size_t>(y.shape(0));
  TwoPointProblem<Number> problem{.size = n, .parameters = static_cast<std::size_t>(p.size())};
  auto native = compiled<Number>(fun, n, problem.parameters);
  Lock lock;
  const FunctionsOfPython<Number> functions(lock, std::move(fun), std::move(bc), std::move(fun_jac), std::move(bc_jac),
                                            n, problem.parameters);
  functions.add_to(problem);
  if constexpr (std::is_same_v<Number, double>) {
    if (native) add_compiled(*native, problem);
  }
  problem.singular_term = vector_of<Number>(singular_term);
  TwoPointOptions options{.tolerance = tol, .condition_tolerance = bc_tol, .most_nodes = max_nodes};
  if (!progress.is_none())
    options.progress = [&progress, &lock](const TwoPointProgress& now) {
      const Lock::Taken taken(lock);
      progress(now.iteration, now.residual, now.condition, now.nodes, now.added, now.exceeds);
    };
  std::vector<double> mesh = vector_of<double>(x);
  std::vector<Number> guess = transposed(numbers_of<Number>(y), n, mesh.size());
  std::vector<Number> parameters = vector_of<Number>(p);
  const auto solution = [&] {
    const Lock::Released released(lock);
    return solve_two_point<Number>(problem, std::move(mesh), std::move(guess), std::move(parameters), options);
  }();
  return result_of(solution, n);
}

/// The nu-th derivatives of the cubics at some points: (component, point). Outside they are extrapolated or not a
/// number.
template <class Number>
Array<Number> evaluate(const Array<double>& x, const Array<Number>& c, const Array<double>& points, std::size_t nu,
                       bool extrapolate) {
  const auto intervals = static_cast<std::size_t>(c.shape(1)), n = static_cast<std::size_t>(c.shape(2));
  const auto count = static_cast<std::size_t>(points.size());
  Array<Number> result(std::vector{c.shape(2), points.size()});
  Number* const to = reinterpret_cast<Number*>(result.mutable_data());
  const Number* const from = numbers_of<Number>(c);
  const double* const nodes = x.data();
  std::size_t interval = 0;
  for (std::size_t q = 0; q < count; ++q) {
    const double at = points.data()[q];
    const bool is_inside = at >= nodes[0] && at <= nodes[intervals];
    if (std::isnan(at) || (!is_inside && !extrapolate)) {
      for (std::size_t i = 0; i < n; ++i) to[i * count + q] = Number(std::nan(""));
      continue;
    }
    if (!(at >= nodes[interval] && at < nodes[interval + 1])) {
      const auto above = std::upper_bound(nodes + 1, nodes + intervals, at);
      interval = static_cast<std::size_t>(above - nodes) - 1;
    }
    const double s = at - nodes[interval];
    for (std::size_t i = 0; i < n; ++i) {
      Number sum{};
      for (std::size_t power = 3; power + 1 > nu; --power) {
        double factor = 1;
        for (std::size_t k = 0; k < nu; ++k) factor *= static_cast<double>(power - k);
        sum = sum * s + from[((3 - power) * intervals + interval) * n + i] * factor;
        if (power == 0) break;
      }
      to[i * count + q] = sum;
    }
  }
  return result;
}

template <class Number>
void add(py::module_& module) {
  module.def("solve_bvp", &solve<Number>, py::arg("fun"), py::arg("bc"), py::arg("x").noconvert(),
             py::arg("y").noconvert(), py::arg("p"), py::arg("S"), py::arg("fun_jac"), py::arg("bc_jac"),
             py::arg("tol"), py::arg("bc_tol"), py::arg("max_nodes"), py::arg("progress"),
             py::call_guard<continuo::python::Visit>());
  module.def("evaluate_cubics", &evaluate<Number>, py::arg("x"), py::arg("c").noconvert(), py::arg("points"),
             py::arg("nu"), py::arg("extrapolate"));
}

}  // namespace

void add_solve_bvp(py::module_& module) {
  add<double>(module);
  add<ComplexNumber<double>>(module);
}
