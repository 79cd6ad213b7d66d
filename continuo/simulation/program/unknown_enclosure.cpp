// continuo/simulation/program/unknown_enclosure.cpp
// Encloses a block of unknowns over a part of a step by its equations.
#include <algorithm>
#include <utility>

#include <continuo/simulation/program/unknown_enclosure.hpp>

namespace continuo::model {

namespace {

double middle_of(const Enclosure<double>& a) {
  return a.lo + (a.hi - a.lo) / 2;
}

}  // namespace

UnknownEnclosure::UnknownEnclosure(const ModelProgram& program, UnknownBlock block, std::span<const double> variables)
    : block_(std::move(block)),
      tape_(program.shared_tape_of(block_.residuals)),
      states_begin_(program.model.layout.states),
      variables_(variables.begin(), variables.end()),
      middle_(block_.components.size()),
      solution_(block_.components.size()),
      guess_(block_.components.size()) {
  const auto count = static_cast<std::uint32_t>(program.model.states.size());
  for (const std::uint32_t variable : variables_of(program.model.graph, block_.residuals)) {
    if (variable < states_begin_ || variable - states_begin_ >= count) continue;
    if (!std::ranges::binary_search(block_.components, variable - states_begin_))
      states_.push_back(variable - states_begin_);
  }
  moving_.resize(states_.size() + 1);
  find_columns(program.model.graph);
}

/// Columns that share no row are found by one evaluation (A. R. Curtis, M. J. D. Powell, J. K. Reid, IMA Journal of
/// Applied Mathematics 13 (1974), 117-119).
void UnknownEnclosure::find_columns(const Graph& graph) {
  const std::size_t n = block_.components.size();
  std::vector<std::vector<std::size_t>> rows(n);  // by column
  for (std::size_t row = 0; row < n; ++row) {
    const std::vector<std::uint32_t> read = variables_of(graph, block_.residuals[row]);
    for (std::size_t column = 0; column < n; ++column)
      if (std::ranges::binary_search(read, states_begin_ + block_.components[column])) rows[column].push_back(row);
  }
  for (std::size_t column = 0; column < n; ++column) {
    const auto shares_none = [&](const std::vector<Place>& places) {
      return std::ranges::none_of(
          places, [&](const Place& place) { return std::ranges::binary_search(rows[column], place.row); });
    };
    const auto fitting = std::ranges::find_if(together_, shares_none);
    std::vector<Place>& places = fitting == together_.end() ? together_.emplace_back() : *fitting;
    for (const std::size_t row : rows[column]) places.push_back({row, column});
  }
}

bool UnknownEnclosure::over(const Step& step, double from, double to) {
  numbers_at_middle_.prepare(*tape_, variables_);
  at_middle_.prepare(*tape_, variables_);
  over_part_.prepare(*tape_, variables_);
  const double middle = from + (to - from) / 2;
  place_middle(step, middle);
  is_instant_ = from == to;
  moving_.front() = {step.time(from, to), Enclosure<double>(step.size)};
  for (std::size_t k = 0; k < states_.size(); ++k)
    moving_[k + 1] = enclose_polynomial(component_.of(step, states_[k]), from, to);
  for (std::size_t k = 0; k < block_.components.size(); ++k) {
    const std::span<const double> polynomial = component_.of(step, block_.components[k]);
    guess_[k] = enclose_polynomial(polynomial, from, to).value;
    middle_[k] = middle_of(polynomial_at(polynomial, middle));
  }
  return solution_.over(
      guess_, middle_, Enclosure<double>(from, to) - Enclosure<double>(middle),
      [this](auto unknowns, auto residuals) { compute_residuals(unknowns, residuals); },
      [this](auto unknowns, auto residuals) { enclose_residuals(unknowns, residuals); },
      [this](auto box, auto by_unknowns, auto by_theta) { enclose_slopes(box, by_unknowns, by_theta); });
}

void UnknownEnclosure::place_middle(const Step& step, double middle) {
  const auto place = [this](std::uint32_t variable, const Enclosure<double>& value) {
    at_middle_[variable] = value;
    numbers_at_middle_[variable] = middle_of(value);
  };
  place(Layout::time, step.time(middle, middle));
  for (const std::uint32_t i : states_) place(states_begin_ + i, polynomial_at(component_.of(step, i), middle));
}

void UnknownEnclosure::compute_residuals(std::span<const double> unknowns, std::span<double> residuals) {
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    numbers_at_middle_[states_begin_ + block_.components[k]] = unknowns[k];
  std::ranges::copy(numbers_at_middle_.evaluate(*tape_), residuals.begin());
}

void UnknownEnclosure::enclose_residuals(std::span<const double> unknowns, std::span<Enclosure<double>> residuals) {
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    at_middle_[states_begin_ + block_.components[k]] = Enclosure<double>(unknowns[k]);
  std::ranges::copy(at_middle_.evaluate(*tape_), residuals.begin());
}

/// Column by column, with what does not move there held anywhere in its range: F(u) - F(v) is the sum of the
/// differences by one unknown each.
void UnknownEnclosure::enclose_slopes(std::span<const Enclosure<double>> box, std::span<Enclosure<double>> by_unknowns,
                                      std::span<Enclosure<double>> by_theta) {
  const std::size_t n = box.size();
  const auto place_moving = [&](bool moves) {
    const auto one = [&](const EnclosureWithSlope<double>& moving) {
      return EnclosureWithSlope<double>(moving.value, moves ? moving.slope : Enclosure<double>());
    };
    over_part_[Layout::time] = one(moving_.front());
    for (std::size_t k = 0; k < states_.size(); ++k) over_part_[states_begin_ + states_[k]] = one(moving_[k + 1]);
  };
  for (std::size_t k = 0; k < n; ++k) over_part_[states_begin_ + block_.components[k]] = {box[k], Enclosure<double>()};
  place_moving(false);
  const auto let_move = [&](const std::vector<Place>& places, double slope) {
    for (const Place& place : places)
      over_part_[states_begin_ + block_.components[place.column]].slope = Enclosure<double>(slope);
  };
  std::ranges::fill(by_unknowns, Enclosure<double>());
  for (const std::vector<Place>& places : together_) {
    let_move(places, 1);
    const std::span<const EnclosureWithSlope<double>> moved = over_part_.evaluate(*tape_);
    for (const Place& place : places) by_unknowns[place.row * n + place.column] = moved[place.row].slope;
    let_move(places, 0);
  }
  std::ranges::fill(by_theta, Enclosure<double>());
  if (is_instant_) return;
  place_moving(true);
  const std::span<const EnclosureWithSlope<double>> moved = over_part_.evaluate(*tape_);
  for (std::size_t i = 0; i < n; ++i) by_theta[i] = moved[i].slope;
}

void UnknownEnclosure::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  numbers_at_middle_.forget();
  at_middle_.forget();
  over_part_.forget();
}

}  // namespace continuo::model
