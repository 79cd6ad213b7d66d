// Follows curves on the dense output by halving: a piece is divided where a straight line would miss it.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include <continuo/language/world.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::results {
namespace {

constexpr double pixels_across = 1920, pixels_upwards = 1440;  // pixels of the largest panel
constexpr double allowed_pixels = 0.25;                        // pixels between a curve and the line that stands for it
constexpr int most_halvings = 18;
constexpr std::size_t most_looks = 20'000;     // at one piece, which something without end in it would exceed
constexpr std::size_t many_points = 1U << 16;  // of one curve; then those that no picture shows are left out
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

bool are_same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// A line that goes over the same places again and again, without what lies where it has been before: of an orbit of a
/// million turns no picture shows more. `cells`: whether the line has been in each half of a pixel, both ways.
Path without_repetitions(const Path& path) {
  constexpr std::size_t across = 2048, upwards = 1536;
  double left = INFINITY, right = -INFINITY, low = INFINITY, top = -INFINITY;
  for (std::size_t i = 0; i < path.x.size(); ++i) {
    if (!std::isfinite(path.x[i]) || !std::isfinite(path.y[i])) continue;
    left = std::min(left, path.x[i]), right = std::max(right, path.x[i]);
    low = std::min(low, path.y[i]), top = std::max(top, path.y[i]);
  }
  if (!(left < right) || !(low < top)) return path;
  std::vector<bool> cells(across * upwards);
  Path made;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < path.x.size(); ++i) {
    const double part_x = (path.x[i] - left) / (right - left), part_y = (path.y[i] - low) / (top - low);
    if (!std::isfinite(part_x) || !std::isfinite(part_y)) {
      before.reset();
      if (!made.x.empty() && std::isfinite(made.x.back())) made.x.push_back(no_number), made.y.push_back(no_number);
      continue;
    }
    const auto cell =
        static_cast<std::size_t>(part_y * (upwards - 1)) * across + static_cast<std::size_t>(part_x * (across - 1));
    const bool is_new = !cells[cell] || i + 1 == path.x.size();
    cells[cell] = true;
    const bool goes_on =
        !made.x.empty() && before && made.x.back() == path.x[*before] && made.y.back() == path.y[*before];
    if (is_new && before && !goes_on) made.x.push_back(path.x[*before]), made.y.push_back(path.y[*before]);
    if (is_new || goes_on) made.x.push_back(path.x[i]), made.y.push_back(path.y[i]);
    if (!is_new && !made.x.empty() && std::isfinite(made.x.back()))
      made.x.push_back(no_number), made.y.push_back(no_number);
    before = i;
  }
  return made;
}

}  // namespace

MotionCurves::MotionCurves(std::shared_ptr<const model::ModelProgram> program, std::vector<PlotRequest> plots)
    : program_(std::move(program)), plots_(std::move(plots)) {
  for (const PlotRequest& request : plots_) add_plot(request);
  was_asked_ = !plots_.empty();
  if (!was_asked_) add_states();
  const model::Model& model = program_->model;
  if (model.total_energy.valid()) {
    nodes_.push_back(model.total_energy);
    energy_track_ = tracks_.size();
    const std::size_t time = add_quantity({Quantity::Kind::time});
    tracks_.push_back({time, add_quantity({Quantity::Kind::node, nodes_.size() - 1})});
  }
  if (model.world) add_ways();
  for (Track& track : tracks_) track.most_points = many_points;
  extents_.resize(quantities_.size());
  node_values_.resize(nodes_.size());
}

std::size_t MotionCurves::add_quantity(Quantity quantity) {
  quantities_.push_back(quantity);
  return quantities_.size() - 1;
}

std::size_t MotionCurves::add_series(const model::Series& series, bool logarithmic) {
  if (series.label == "t") return add_quantity({Quantity::Kind::time, 0, logarithmic});
  nodes_.push_back(series.node);
  return add_quantity({Quantity::Kind::node, nodes_.size() - 1, logarithmic});
}

void MotionCurves::add_plot(const PlotRequest& request) {
  tracks_of_plot_.emplace_back();
  ProfileTimes& profiles = profiles_.emplace_back();
  profiles.order.resize(request.times.size());
  profiles.taken.resize(request.times.size());
  std::iota(profiles.order.begin(), profiles.order.end(), std::size_t{0});
  std::ranges::sort(profiles.order, {}, [&](std::size_t i) { return request.times[i]; });
  if (!request.times.empty()) return;
  const std::size_t x = add_series(request.plot.against, request.logarithmic_x);
  for (const model::Series& series : request.plot.curves) {
    tracks_of_plot_.back().push_back(tracks_.size());
    tracks_.push_back({x, add_series(series, request.logarithmic_y)});
  }
}

/// The states over time, as one plot.
void MotionCurves::add_states() {
  const model::Model& model = program_->model;
  PlotRequest request{.plot = {{}, {"t", {}, model.time_unit}, {}}};
  tracks_of_plot_.emplace_back();
  profiles_.emplace_back();
  const std::size_t time = add_quantity({Quantity::Kind::time});
  for (const std::size_t i : states_to_plot(model)) {
    request.plot.curves.push_back({model.states[i].column, {}, model.states[i].unit});
    tracks_of_plot_.back().push_back(tracks_.size());
    tracks_.push_back({time, add_quantity({Quantity::Kind::state, i})});
  }
  plots_.push_back(std::move(request));
}

void MotionCurves::add_ways() {
  const model::WorldDescription& world = *program_->model.world;
  if (std::ranges::count(world.bodies, false, &model::BodyDescription::fixed) > static_cast<int>(most_ways)) return;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    way_tracks_.push_back(tracks_.size());
    const std::size_t x = add_quantity({Quantity::Kind::right, i});
    tracks_.push_back({x, add_quantity({Quantity::Kind::up, i})});
  }
}

void MotionCurves::set_inputs(double t) {
  for (const model::TableInput& input : program_->step_inputs) evaluation_.set(input.variable, input.table.value(t));
}

MotionCurves::Instant MotionCurves::instant(double t, std::span<const double> x) {
  if (!nodes_.empty()) evaluation_(t, x, node_values_);
  Instant made{t, std::vector<double>(quantities_.size())};
  const auto coordinate = [&](std::size_t body, std::size_t axis) {
    return x[program_->model.world->bodies[body].first_state + 2 * axis];
  };
  const bool in_space = program_->model.world && program_->model.world->dimension == 3;
  for (std::size_t k = 0; k < quantities_.size(); ++k) {
    const std::size_t i = quantities_[k].index;
    switch (quantities_[k].kind) {
      case Quantity::Kind::time:
        made.values[k] = t;
        break;
      case Quantity::Kind::state:
        made.values[k] = x[i];
        break;
      case Quantity::Kind::node:
        made.values[k] = node_values_[i];
        break;
      case Quantity::Kind::right:
        made.values[k] = in_space ? right_in_space(coordinate(i, 0), coordinate(i, 1)) : coordinate(i, 0);
        break;
      case Quantity::Kind::up:
        made.values[k] =
            in_space ? up_in_space(coordinate(i, 0), coordinate(i, 1), coordinate(i, 2)) : coordinate(i, 1);
        break;
    }
  }
  return made;
}

MotionCurves::Instant MotionCurves::instant(double t, const At& at) {
  at(t, x_);
  return instant(t, x_);
}

/// Where a value stands on its axis: what has no place there is not finite.
double MotionCurves::place(std::size_t quantity, double value) const {
  if (!quantities_[quantity].logarithmic) return value;
  return value > 0 ? std::log10(value) : no_number;
}

void MotionCurves::see(const Instant& instant) {
  for (std::size_t k = 0; k < quantities_.size(); ++k) {
    const double at = place(k, instant.values[k]);
    if (!std::isfinite(at)) continue;
    extents_[k].low = std::min(extents_[k].low, at);
    extents_[k].high = std::max(extents_[k].high, at);
  }
}

void MotionCurves::see_tolerances(const Instant& now, std::span<const double> x) {
  tolerances_->see(x, now.values, [&](std::span<const double> moved, std::span<double> values) {
    std::ranges::copy(instant(now.t, moved).values, values.begin());
  });
}

/// How much of an axis a picture shows at least: what it has to show so far, and no less than what axes show at least.
double MotionCurves::extent(std::size_t quantity) const {
  const Quantity& of = quantities_[quantity];
  if (of.kind == Quantity::Kind::time && !of.logarithmic) return to_ - from_;
  const auto [low, high] = extents_[quantity];
  const double shown = high > low ? high - low : 0;
  return of.logarithmic ? shown : std::max(shown, least_tolerances_of_axis * (*tolerances_)[quantity]);
}

/// Whether a straight line from a to b would be seen to miss the point between them, of any curve.
bool MotionCurves::bends(const Instant& a, const Instant& middle, const Instant& b) const {
  for (const Track& track : tracks_) {
    const auto of = [&](const Instant& instant, std::size_t quantity, double pixels) {
      const double shown = extent(quantity), at = place(quantity, instant.values[quantity]);
      return shown > 0 || !std::isfinite(at) ? at / shown * pixels : 0;
    };
    const double ax = of(a, track.x, pixels_across), ay = of(a, track.y, pixels_upwards);
    const double mx = of(middle, track.x, pixels_across) - ax, my = of(middle, track.y, pixels_upwards) - ay;
    const double bx = of(b, track.x, pixels_across) - ax, by = of(b, track.y, pixels_upwards) - ay;
    const auto is_gap = [&](const Instant& instant) {
      return !std::isfinite(place(track.x, instant.values[track.x]) + place(track.y, instant.values[track.y]));
    };
    const bool gaps[] = {is_gap(a), is_gap(middle), is_gap(b)};
    if (gaps[0] && gaps[1] && gaps[2]) continue;
    if (gaps[0] || gaps[1] || gaps[2]) return true;
    const double square = bx * bx + by * by;
    const double part = square > 0 ? std::clamp((mx * bx + my * by) / square, 0.0, 1.0) : 0;
    if (std::hypot(mx - part * bx, my - part * by) > allowed_pixels) return true;
  }
  return false;
}

/// Appends what comes after a, up to b. Two points between them are looked at, so that a curve like an S, which crosses
/// the straight line in the middle, does not pass for one; of a whole piece three.
void MotionCurves::follow(const Instant& a, const Instant& b, const At& at, int depth) {
  const double length = b.t - a.t, half = a.t + length / 2;
  const bool goes_on = depth < most_halvings && a.t < half && half < b.t && budget_ > 2;
  if (!goes_on) return append(b);
  budget_ -= 2;
  const Instant early = instant(a.t + 0.27 * length, at), middle = instant(half, at);
  see(early);
  see(middle);
  bool divides = bends(a, early, b) || bends(a, middle, b);
  if (!divides && depth < 2) {
    const Instant late = instant(a.t + 0.79 * length, at);
    see(late);
    divides = bends(a, late, b);
  }
  if (!divides) return append(b);
  follow(a, middle, at, depth + 1);
  follow(middle, b, at, depth + 1);
}

void MotionCurves::append(Track& track, double x, double y) {
  const Quantity& across = quantities_[track.x];
  if (across.kind == Quantity::Kind::time && across.logarithmic && x < first_) return;  // decades before the first row
  Path& path = track.curve.path;
  path.x.push_back(x);
  path.y.push_back(y);
  if (path.x.size() < track.most_points) return;
  const auto at_places = [&](std::size_t quantity, std::vector<double>& values) {
    if (quantities_[quantity].logarithmic)
      std::ranges::transform(values, values.begin(), [&](double value) { return place(quantity, value); });
  };
  const auto back = [&](std::size_t quantity, std::vector<double>& values) {
    if (quantities_[quantity].logarithmic)
      std::ranges::transform(values, values.begin(), [](double at) { return std::pow(10, at); });
  };
  at_places(track.x, path.x);
  at_places(track.y, path.y);
  Curve few =
      thinned({.label = {}, .x = std::move(path.x), .y = std::move(path.y)}, static_cast<std::size_t>(pixels_across));
  path = {std::move(few.x), std::move(few.y)};
  if (path.x.size() > track.most_points / 2) path = without_repetitions(path);
  back(track.x, path.x);
  back(track.y, path.y);
  track.most_points = std::max(track.most_points, 2 * path.x.size());
}

void MotionCurves::append(const Instant& instant) {
  for (Track& track : tracks_) append(track, instant.values[track.x], instant.values[track.y]);
  last_ = instant;
}

void MotionCurves::prepare(const model::Plan& plan, std::size_t states) {
  from_ = plan.from;
  to_ = plan.to;
  if (plan.output == model::OutputPlan::Kind::logarithmic) first_ = plan.first;
  const MethodInfo* const method = find_method(plan.method);
  is_straight_ = method != nullptr && method->dense_order == 1;
  for (Quantity& quantity : quantities_)
    if (quantity.kind == Quantity::Kind::time && plan.output == model::OutputPlan::Kind::logarithmic)
      quantity.logarithmic = true;  // so are the axes of its pictures
  const auto evaluation_of = [&](const std::vector<model::NodeId>& nodes) {
    const std::size_t variables = program_->model.layout.size + program_->switch_variables;
    const std::span all(plan.variables);
    return model::Evaluation(program_->tape_of(nodes), all.first(std::min(all.size(), variables)));
  };
  evaluation_ = evaluation_of(nodes_);
  tolerances_.emplace(plan, states, quantities_.size());
  x_.resize(states);
  for (std::size_t p = 0; p < plots_.size(); ++p) {
    if (plots_[p].times.empty()) continue;
    std::vector<model::NodeId> nodes;
    for (const model::Series& series : plots_[p].plot.curves) nodes.push_back(series.node);
    for (const model::Series& series : plots_[p].places) nodes.push_back(series.node);
    profiles_[p].evaluation = evaluation_of(nodes);
  }
}

void MotionCurves::begin(const model::Plan& plan, const X& x) {
  prepare(plan, x.size());
  set_inputs(from_);
  const Instant first = instant(from_, x);
  see(first);
  see_tolerances(first, x);
  append(first);
  take_profiles(from_, [&](double, X& state) { state = x; });
}

void MotionCurves::on_piece(double to, const At& at) {
  if (!(to > last_->t)) return;
  budget_ = most_looks;
  const Instant begin = *last_, end = instant(to, at);
  see(end);
  // Where tolerances are looked at, the picture has to magnify nothing for a while: at the beginning of a run often.
  ++pieces_;
  if (pieces_ < 64 || pieces_ % 64 == 0) see_tolerances(end, X(x_));
  take_profiles(to, at);
  if (is_straight_) return append(end);
  follow(begin, end, at, 0);
}

void MotionCurves::on_jump(double t, const X& before, const X& after) {
  // Whatever the run has not shown as a piece: an event at its very beginning, or a world between two rows.
  if (last_->t != t) append(instant(t, before));
  const Instant from = *last_;
  set_inputs(t);
  const Instant to = instant(t, after);
  see(to);
  see_tolerances(to, after);
  for (Track& track : tracks_) {
    const double x0 = from.values[track.x], y0 = from.values[track.y];
    const double x1 = to.values[track.x], y1 = to.values[track.y];
    if (are_same(x0, x1) && are_same(y0, y1)) continue;
    if (x0 != x1) {  // across a plane: nothing has moved there
      append(track, no_number, no_number);
      for (const auto [x, y] : {std::array{x0, y0}, std::array{x1, y1}, std::array{no_number, no_number}})
        if (track.curve.jumps.x.size() < many_points)
          track.curve.jumps.x.push_back(x), track.curve.jumps.y.push_back(y);
    }
    append(track, x1, y1);
  }
  last_ = to;
  for (std::size_t p = 0; p < plots_.size(); ++p) {
    ProfileTimes& profiles = profiles_[p];
    for (std::size_t k = profiles.next; k-- > 0 && plots_[p].times[profiles.order[k]] == t;) {
      x_ = after;
      take_profile(p, profiles.order[k], t);
    }
  }
}

/// Of the state in x_.
void MotionCurves::take_profile(std::size_t plot, std::size_t number, double t) {
  ProfileTimes& profiles = profiles_[plot];
  for (const model::TableInput& input : program_->step_inputs)
    profiles.evaluation.set(input.variable, input.table.value(t));
  const std::vector<double> values = profiles.evaluation(t, x_);
  const std::size_t count = plots_[plot].plot.curves.size();
  Profile made{t, {}, {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)}};
  for (std::size_t i = 0; i < count; ++i)
    made.x.push_back(plots_[plot].places.empty() ? plots_[plot].first_place + static_cast<double>(i)
                                                 : values[count + i]);
  profiles.taken[number] = std::move(made);
}

void MotionCurves::take_profiles(double to, const At& at) {
  for (std::size_t p = 0; p < plots_.size(); ++p) {
    ProfileTimes& profiles = profiles_[p];
    for (; profiles.next < profiles.order.size(); ++profiles.next) {
      const std::size_t number = profiles.order[profiles.next];
      const double t = plots_[p].times[number];
      if (t > to) break;
      if (t < from_) continue;
      at(t, x_);
      take_profile(p, number, t);
    }
  }
}

void MotionCurves::take_rows(const model::Run& run) {
  const model::Motion& motion = run.motion;
  if (motion.rows() == 0) return;
  prepare(run.plan, motion.states);
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const double t = motion.time(row);
    const X x(motion.state(row).begin(), motion.state(row).end());
    if (last_ && last_->t == t) {
      on_jump(t, x, x);
      continue;
    }
    set_inputs(t);
    const Instant now = instant(t, x);
    see(now);
    if (row < 64 || row % 64 == 0) see_tolerances(now, x);
    const double before = last_ ? last_->t : t;
    append(now);
    // A profile is that of the last row up to its time.
    for (std::size_t p = 0; p < plots_.size(); ++p) {
      for (std::size_t k = 0; k < plots_[p].times.size(); ++k) {
        const double due = plots_[p].times[k];
        const double next = row + 1 < motion.rows() ? motion.time(row + 1) : t;
        if (due < before || due < t || (due >= next && due > t)) continue;
        x_ = x;
        take_profile(p, k, t);
      }
    }
  }
}

std::vector<MotionCurve> MotionCurves::curves_of(std::size_t plot) const {
  std::vector<MotionCurve> curves;
  for (const std::size_t track : tracks_of_plot_[plot]) curves.push_back(with_tolerances(track));
  return curves;
}

MotionCurve MotionCurves::with_tolerances(std::size_t number) const {
  const Track& track = tracks_[number];
  MotionCurve curve = track.curve;
  curve.tolerance_x = (*tolerances_)[track.x];
  curve.tolerance_y = (*tolerances_)[track.y];
  return curve;
}

std::vector<Profile> MotionCurves::profiles_of(std::size_t plot) const {
  std::vector<Profile> profiles;
  for (const auto& profile : profiles_[plot].taken)
    if (profile) profiles.push_back(*profile);
  return profiles;
}

std::optional<MotionCurve> MotionCurves::energy() const {
  return energy_track_ ? std::optional(with_tolerances(*energy_track_)) : std::nullopt;
}

std::optional<Path> MotionCurves::way_of(std::size_t body) const {
  return body < way_tracks_.size() ? std::optional(tracks_[way_tracks_[body]].curve.path) : std::nullopt;
}

}  // namespace continuo::results
