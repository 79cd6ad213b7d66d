// The class RightHandSide of the module: the equations of a model as a function, and what they are called.
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "parts.hpp"
#include "right_hand_side.hpp"
#include <continuo/language/text/words.hpp>
#include <continuo/simulation/c_export.hpp>

namespace py = pybind11;

using namespace continuo::model;
using continuo::Result;
using continuo::python::RightHandSide;

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

NativeUse use_of(const std::string& native) {
  const auto use = native_use_named(native);
  if (!use)
    throw std::invalid_argument(fmt::format("native is '{}'; it can be 'auto', 'always', 'fused' or 'never'", native));
  if (const std::string why = why_not(*use); !why.empty()) throw std::invalid_argument("native: " + why);
  return *use;
}

const double* state_of(const RightHandSide& f, const Numbers& y) {
  if (y.ndim() == 1 && y.shape(0) == static_cast<py::ssize_t>(f.size())) return y.data();
  throw std::invalid_argument(fmt::format(
      "y has the shape {}, but there are {} states: it must be ({},)",
      py::cast<std::string>(py::str(py::tuple(py::cast(std::vector<py::ssize_t>(y.shape(), y.shape() + y.ndim()))))),
      f.size(), f.size()));
}

Numbers derivative_at(const RightHandSide& f, double t, const Numbers& y) {
  const double* x = state_of(f, y);
  Numbers dydt(static_cast<py::ssize_t>(f.size()));
  f.evaluate(t, x, dydt.mutable_data());
  return dydt;
}

Numbers jacobian_at(const RightHandSide& f, double t, const Numbers& y) {
  const double* x = state_of(f, y);
  const auto n = static_cast<py::ssize_t>(f.size());
  Numbers rows({n, n});
  f.jacobian(t, x, rows.mutable_data());
  return rows;
}

py::tuple jacobian_pattern(const RightHandSide& f) {
  const continuo::SparsePattern pattern = f.jacobian_pattern();
  const auto entries = static_cast<py::ssize_t>(pattern.entries());
  py::array_t<std::uint32_t> rows(entries), columns(entries);
  for (std::size_t j = 0; j < pattern.size(); ++j)
    for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) {
      rows.mutable_data()[p] = static_cast<std::uint32_t>(pattern.row(p));
      columns.mutable_data()[p] = static_cast<std::uint32_t>(j);
    }
  return py::make_tuple(rows, columns);
}

py::dict parameters(const RightHandSide& f) {
  py::dict values;
  for (const Parameter& p : f.model().parameters) values[py::str(p.name)] = f.variables()[p.variable];
  for (const Input& input : f.model().inputs) values[py::str(input.name)] = f.variables()[input.variable];
  return values;
}

std::vector<std::string> state_names(const RightHandSide& f) {
  std::vector<std::string> names;
  for (const State& state : f.model().states) names.push_back(state.column);
  return names;
}

std::vector<double> initial_state(const RightHandSide& f) {
  const auto first = f.variables().begin() + f.model().layout.states;
  return {first, first + static_cast<std::ptrdiff_t>(f.size())};
}

std::string exported(const RightHandSide& f) {
  const Result<std::string> text = c_text(*f.program());
  if (!text) throw std::invalid_argument(describe(text.status()));
  return *text;
}

py::dict native_report(const RightHandSide& f) {
  const NativeCompiler::Report report = f.model().native->report();
  py::dict values;
  values["compiled"] = report.compiled;
  values["loaded"] = report.loaded;
  values["trouble"] = report.trouble;
  return values;
}

template <class Function>
std::uintptr_t address(Function* function) {
  return reinterpret_cast<std::uintptr_t>(function);
}

}  // namespace

void add_right_hand_side(py::module_& module) {
  module.def("is_reserved_word", [](const std::string& word) {
    return is_reserved(word) || continuo::model::is_function(word) || word == "t" || word == "pi";
  });
  py::class_<RightHandSide, std::shared_ptr<RightHandSide>>(module, "RightHandSide")
      .def(py::init([](const std::string& text, const std::string& path, const std::string& native) {
             return std::make_shared<RightHandSide>(continuo::python::load_equations(text, path, use_of(native)),
                                                    Overrides{});
           }),
           py::arg("text"), py::arg("path"), py::arg("native"))
      .def(
          "with_parameters",
          [](const RightHandSide& f, const std::map<std::string, double>& values) {
            return std::make_shared<RightHandSide>(f.program(), Overrides(values.begin(), values.end()));
          },
          py::arg("values"))
      .def("__call__", &derivative_at, py::arg("t"), py::arg("y"))
      .def("jacobian", &jacobian_at, py::arg("t"), py::arg("y"))
      .def("jacobian_pattern", &jacobian_pattern)
      .def("c", &exported)
      .def_property_readonly("n", &RightHandSide::size)
      .def_property_readonly("text", [](const RightHandSide& f) { return f.model().text.content; })
      .def_property_readonly("name", [](const RightHandSide& f) { return f.model().name; })
      .def_property_readonly("states", &state_names)
      .def_property_readonly("initial", &initial_state)
      .def_property_readonly("parameters", &parameters)
      .def_property_readonly("native", &native_report)
      .def_property_readonly_static("derivative_address",
                                    [](const py::object&) { return address(&RightHandSide::derivative); })
      .def_property_readonly_static("jacobian_address",
                                    [](const py::object&) { return address(&RightHandSide::jacobian_rows); })
      .def_property_readonly_static("jacobian_entries_address",
                                    [](const py::object&) { return address(&RightHandSide::jacobian_entries); })
      .def_property_readonly("user", [](const RightHandSide& f) { return address(&f); });
}
