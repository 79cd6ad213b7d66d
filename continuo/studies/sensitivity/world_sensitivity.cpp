// Sensitivities of a world by central differences of runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <continuo/language/world.hpp>
#include <continuo/numerics/central_difference.hpp>
#include <continuo/studies/sensitivity/world_sensitivity.hpp>
#include <continuo/system/parametric_system.hpp>
#include <continuo/worlds/world_along.hpp>

namespace continuo::studies::detail {

namespace {

class Differences {
 public:
  Differences(const SensitiveProgram& program, const std::shared_ptr<const model::ModelProgram>& model_program,
              const SensitivityRequest& request)
      : program_(program), model_program_(model_program), request_(request) {}

  SensitivityRun run() {
    const model::Model& model = model_program_->model;
    SensitivityRun made;
    made.states = model.states.size();
    made.influences = program_.count();
    here_ = worlds::world_along(model_program_, {request_.experiment, request_.times, request_.initial});
    made.times = here_.times;
    made.variables = here_.variables;
    made.outcome = here_.outcome;
    made.diagnostics = here_.diagnostics;
    if (!made.diagnostics.empty()) return made;
    for (std::size_t k = 0; k < made.influences && made.status; ++k) made.status = take_sides(k);
    if (!made.status) return made;
    const std::size_t n = made.states, width = n * (1 + made.influences);
    made.values.resize(made.times.size() * width);
    for (std::size_t row = 0; row < made.times.size(); ++row) {
      double* values = made.values.data() + row * width;
      std::ranges::copy(here_.states[row], values);
      for (std::size_t k = 0; k < made.influences; ++k) compare(row, k, std::span(values + n * (1 + k), n));
    }
    return made;
  }

 private:
  struct Side {
    double p = 0;
    worlds::WorldAlong along;
    bool good = false;
  };
  using Sides = std::array<Side, 2>;

  Side at(const Influence& influence, double p) const {
    worlds::AlongRequest request{request_.experiment, here_.times, request_.initial};
    request.experiment.progress = nullptr;
    // Its interval stays, even where that is an expression of p.
    request.experiment.from = here_.variables[model::Layout::time];
    if (influence.kind == Influence::Kind::parameter) {
      request.experiment.parameters[model_program_->model.parameters[influence.index].name] = p;
    } else {
      std::erase_if(request.initial, [&](const auto& one) { return one.first == influence.index; });
      request.initial.emplace_back(influence.index, p);
    }
    Side side{.p = p, .along = worlds::world_along(model_program_, request)};
    side.good = side.along.diagnostics.empty() && succeeded(side.along.outcome.ending);
    return side;
  }
  /// A failure where there is none.
  Status take_sides(std::size_t k) {
    const model::Model& model = model_program_->model;
    const Influence& influence = program_.influences()[k];
    const std::uint32_t variable = influence.kind == Influence::Kind::parameter
                                       ? model.parameters[influence.index].variable
                                       : model.states[influence.index].variable;
    const double p = here_.variables[variable];
    const bool is_wide = k < request_.increments.size() && request_.increments[k] > 0;
    const double increment = is_wide ? request_.increments[k] : central_increment(p, p == 0 ? 1.0 : std::abs(p));
    is_wide_.push_back(is_wide);
    sides_.push_back({at(influence, p - increment), at(influence, p + increment)});
    p_.push_back(p);
    if (sides_.back()[0].good || sides_.back()[1].good) return {};
    return {
        .ending = Ending::cannot_continue,
        .message = fmt::format("the world cannot be run on either side of {} = {:g}", name_of(model, influence), p)};
  }

  bool has_row(const Side& side, std::size_t row) const { return side.good && row < side.along.states.size(); }
  void compare(std::size_t row, std::size_t k, std::span<double> slopes) const {
    const model::Model& model = model_program_->model;
    const auto collisions = [&](const std::vector<double>& x) { return model::collisions_of(*model.world, x); };
    const std::vector<double>& x = here_.states[row];
    const Sides& sides = sides_[k];
    std::array<bool, 2> is_there{}, is_same{};
    for (std::size_t s = 0; s < 2; ++s) {
      is_there[s] = has_row(sides[s], row);
      is_same[s] = is_there[s] && collisions(sides[s].along.states[row]) == collisions(x);
    }
    const std::array<bool, 2>& used = !is_wide_[k] && (is_same[0] || is_same[1]) ? is_same : is_there;
    const bool all_same = used == is_same;
    const std::vector<double>& low = used[0] ? sides[0].along.states[row] : x;
    const std::vector<double>& high = used[1] ? sides[1].along.states[row] : x;
    const double width = (used[1] ? sides[1].p : p_[k]) - (used[0] ? sides[0].p : p_[k]);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool is_known = width > 0 && (all_same || !jumps_at_impacts(model, i));
      slopes[i] = is_known ? (high[i] - low[i]) / width : std::numeric_limits<double>::quiet_NaN();
    }
  }

  const SensitiveProgram& program_;
  const std::shared_ptr<const model::ModelProgram>& model_program_;
  const SensitivityRequest& request_;
  worlds::WorldAlong here_;
  std::vector<Sides> sides_;  // of each influence
  std::vector<double> p_;
  std::vector<bool> is_wide_;
};

}  // namespace

bool jumps_at_impacts(const model::Model& model, std::size_t state) {
  const model::WorldDescription& world = *model.world;
  if (state >= world.first_measure) return true;
  if (state >= world.body_states()) return false;
  const std::size_t of_body = state % model::WorldDescription::states_of_body(world.dimension);
  const auto places = static_cast<std::size_t>(2 * world.dimension);
  if (of_body < places) return of_body % 2 == 1;
  return world.dimension == 2 ? of_body % 2 == 1 : of_body >= places + 4;  // in space after the quaternion
}

SensitivityRun world_sensitivity(const std::shared_ptr<const SensitiveProgram>& program,
                                 const SensitivityRequest& request) {
  return Differences(*program, program->shared_program(), request).run();
}

}  // namespace continuo::studies::detail
