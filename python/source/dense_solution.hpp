// The dense output of a run as Python sees it: a function of time that takes numbers and arrays.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>

#include <pybind11/numpy.h>

#include <continuo/foreign/foreign_run.hpp>

namespace continuo::python {

/// The pieces of a solution, called as SciPy's OdeSolution: continued beyond the ends by the outer pieces, and between
/// two pieces that of the earlier one.
class DenseSolution {
 public:
  DenseSolution(ForeignDense dense, bool complex) : dense_(std::move(dense)), complex_(complex) {}

  /// y at t: an array of shape (n,) for a number, of (n, points) for an array.
  [[nodiscard]] pybind11::array operator()(const pybind11::object& t) const;
  [[nodiscard]] const ForeignDense& dense() const { return dense_; }
  [[nodiscard]] bool complex() const { return complex_; }
  /// The ends of the pieces.
  [[nodiscard]] pybind11::array_t<double> ends() const;
  /// The piece of this number alone.
  [[nodiscard]] DenseSolution piece(std::ptrdiff_t number) const;

 private:
  [[nodiscard]] std::size_t piece_at(double t) const;

  ForeignDense dense_;
  bool complex_;
};

}  // namespace continuo::python
