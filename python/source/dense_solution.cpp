// Dense output: evaluation at numbers and arrays, and pickling.
#include "dense_solution.hpp"

#include <algorithm>
#include <complex>
#include <cstring>
#include <vector>

#include <pybind11/pybind11.h>

#include "parts.hpp"

namespace py = pybind11;

namespace continuo::python {
namespace {

[[nodiscard]] py::array empty_array(bool complex, const std::vector<py::ssize_t>& shape) {
  if (complex) return py::array_t<std::complex<double>>(shape);
  return py::array_t<double>(shape);
}

[[nodiscard]] py::bytes bytes_of(const void* data, std::size_t size) {
  return {static_cast<const char*>(data), size};
}
template <class T>
void read_bytes(const py::handle& bytes, std::vector<T>& values) {
  const std::string text = bytes.cast<std::string>();
  values.resize(text.size() / sizeof(T));
  if (values.size() * sizeof(T) != text.size()) throw py::value_error("a pickled solution that is damaged");
  std::memcpy(values.data(), text.data(), text.size());
}

[[nodiscard]] DenseSolution unpickled(const py::tuple& state) {
  if (state.size() != 5) throw py::value_error("a pickled solution of another version");
  ForeignDense dense;
  dense.size = state[0].cast<std::size_t>();
  read_bytes(state[1], dense.pieces);
  read_bytes(state[2], dense.coefficients);
  read_bytes(state[3], dense.ends);
  bool whole = dense.ends.size() == dense.pieces.size() * dense.size && !dense.pieces.empty();
  for (const ForeignDense::Piece& piece : dense.pieces)
    whole = whole && piece.terms > 0 && piece.terms < 1000 && piece.first <= dense.coefficients.size() &&
            (piece.first + piece.terms) * dense.size <= dense.coefficients.size();
  if (!whole) throw py::value_error("a pickled solution that is damaged");
  return {std::move(dense), state[4].cast<bool>()};
}

}  // namespace

std::size_t DenseSolution::piece_at(double t) const {
  const auto& pieces = dense_.pieces;
  const bool forward = pieces.back().end >= pieces.front().begin;
  const auto found = std::lower_bound(pieces.begin(), pieces.end(), t, [&](const auto& piece, double time) {
    return forward ? piece.end < time : piece.end > time;
  });
  return static_cast<std::size_t>(std::min(found, pieces.end() - 1) - pieces.begin());
}

py::array DenseSolution::operator()(const py::object& t) const {
  const std::size_t size = dense_.size;
  const auto n = static_cast<py::ssize_t>(complex_ ? size / 2 : size);
  if (PyFloat_Check(t.ptr()) || PyLong_Check(t.ptr())) {
    const double time = t.cast<double>();
    py::array result = empty_array(complex_, {n});
    dense_.evaluate(piece_at(time), time, static_cast<double*>(result.mutable_data()));
    return result;
  }
  const py::array_t<double, py::array::c_style | py::array::forcecast> times(t);
  if (times.ndim() > 1) throw py::value_error("`t` must be a float or a 1-D array.");
  if (times.ndim() == 0) return (*this)(py::float_(*times.data()));
  const py::ssize_t points = times.shape(0);
  // Written point after point, and seen with the components first.
  py::array rows = empty_array(complex_, {points, n});
  auto* at = static_cast<double*>(rows.mutable_data());
  for (py::ssize_t k = 0; k < points; ++k, at += size) dense_.evaluate(piece_at(times.data()[k]), times.data()[k], at);
  return rows.attr("T").cast<py::array>();
}

py::array_t<double> DenseSolution::ends() const {
  py::array_t<double> ends(static_cast<py::ssize_t>(dense_.pieces.size() + 1));
  double* at = ends.mutable_data();
  *at++ = dense_.pieces.front().begin;
  for (const ForeignDense::Piece& piece : dense_.pieces) *at++ = piece.end;
  return ends;
}

DenseSolution DenseSolution::piece(std::ptrdiff_t number) const {
  const auto count = static_cast<std::ptrdiff_t>(dense_.pieces.size());
  if (number < 0) number += count;
  if (number < 0 || number >= count) throw py::index_error("the solution has no such piece");
  const auto k = static_cast<std::size_t>(number);
  ForeignDense one{.size = dense_.size, .pieces = {dense_.pieces[k]}, .coefficients = {}, .ends = {}};
  const auto from = dense_.coefficients.begin() + static_cast<std::ptrdiff_t>(one.pieces[0].first * one.size);
  one.coefficients.assign(from, from + static_cast<std::ptrdiff_t>(one.pieces[0].terms * one.size));
  const auto end = dense_.ends.begin() + static_cast<std::ptrdiff_t>(k * one.size);
  one.ends.assign(end, end + static_cast<std::ptrdiff_t>(one.size));
  one.pieces[0].first = 0;
  return {std::move(one), complex_};
}

}  // namespace continuo::python

void add_dense_solution(py::module_& module) {
  using continuo::python::DenseSolution;
  py::class_<DenseSolution>(module, "DenseSolution",
                            "The dense output of a run, called with a time or an array of times.")
      .def("__call__", &DenseSolution::operator(), py::arg("t"))
      .def("__len__", [](const DenseSolution& self) { return self.dense().pieces.size(); })
      .def("piece", &DenseSolution::piece, py::arg("number"))
      .def_property_readonly("ts", &DenseSolution::ends)
      .def_property_readonly(
          "n", [](const DenseSolution& self) { return self.complex() ? self.dense().size / 2 : self.dense().size; })
      .def(py::pickle(
          [](const DenseSolution& self) {
            using continuo::python::bytes_of;
            const continuo::ForeignDense& dense = self.dense();
            return py::make_tuple(dense.size,
                                  bytes_of(dense.pieces.data(), dense.pieces.size() * sizeof(dense.pieces[0])),
                                  bytes_of(dense.coefficients.data(), dense.coefficients.size() * sizeof(double)),
                                  bytes_of(dense.ends.data(), dense.ends.size() * sizeof(double)), self.complex());
          },
          &continuo::python::unpickled));
}
