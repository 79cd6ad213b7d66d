// continuo/simulation/program/model_derivatives.cpp
// Evaluates df/dx and df/dt of a model, dense, banded or by pattern.
#include <algorithm>
#include <utility>

#include <continuo/simulation/program/derivative_tapes.hpp>
#include <continuo/simulation/program/model_derivatives.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model {

ModelDerivatives::ModelDerivatives(const ModelProgram& program, std::span<const double> variables, bool held) {
  DerivativeTapes tapes = derivative_tapes(program, held);
  pattern_ = std::move(tapes.pattern);
  if (pattern_.is_banded()) places_in_band_ = pattern_.places_in_band();
  for (DerivativeTapes::OfMode& found : tapes.modes) {
    if (program.model.native) program.model.native->watch(found.entries);
    OfMode& mine = modes_.emplace_back();
    mine.entries = Evaluation(std::move(found.entries), variables);
    if (pattern_.is_banded()) mine.in_band = mine.entries.outputs_at(places_in_band_);
    mine.moving = std::move(found.moving);
    mine.by_time = Evaluation(std::move(found.by_time), variables);
  }
  values_.resize(std::max(program.model.states.size(), pattern_.entries()));
}

void ModelDerivatives::jacobian_values(std::size_t mode, double t, std::span<const double> x,
                                       std::span<double> values) {
  modes_[mode].entries(t, x, values);
}

void ModelDerivatives::jacobian_band(std::size_t mode, double t, std::span<const double> x, std::span<double> band) {
  OfMode& mine = modes_[mode];
  if (!mine.entries.is_native()) return mine.entries(t, x, band, mine.in_band);
  mine.entries(t, x, values_);
  for (std::size_t k = 0; k < places_in_band_.size(); ++k) band[places_in_band_[k]] = values_[k];
}

void ModelDerivatives::jacobian(std::size_t mode, double t, std::span<const double> x, std::span<double> rows) {
  std::ranges::fill(rows, 0.0);
  modes_[mode].entries(t, x, values_);
  for (std::size_t column = 0; column < pattern_.size(); ++column) {
    for (std::size_t k = pattern_.begin(column); k < pattern_.end(column); ++k)
      rows[pattern_.row(k) * x.size() + column] = values_[k];
  }
}

void ModelDerivatives::time_derivative(std::size_t mode, double t, std::span<const double> x, std::span<double> dfdt) {
  OfMode& mine = modes_[mode];
  std::ranges::fill(dfdt, 0.0);
  mine.by_time(t, x, std::span(values_).first(mine.moving.size()));
  for (std::size_t k = 0; k < mine.moving.size(); ++k) dfdt[mine.moving[k]] = values_[k];
}

void ModelDerivatives::set(std::uint32_t variable, double value) {
  for (OfMode& mine : modes_) {
    mine.entries.set(variable, value);
    mine.by_time.set(variable, value);
  }
}

}  // namespace continuo::model
