// Samples each piece of a motion and refines what the samples show.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <continuo/studies/sweep/kept_values.hpp>

namespace continuo::studies {
namespace {

using model::SweepKeep;

constexpr std::size_t parts_of_a_piece = 8;
constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
constexpr double exactness = 1.5e-8;  // of the place of an extreme, whose value is then exact to rounding

/// Sign with which an extreme becomes a maximum.
double sign_of(SweepKeep::Kind kind) {
  return kind == SweepKeep::Kind::minimum ? -1 : 1;
}
bool is_extreme(SweepKeep::Kind kind) {
  return kind == SweepKeep::Kind::maximum || kind == SweepKeep::Kind::minimum;
}

std::vector<model::NodeId> nodes_of(std::span<const SweepKeep> keeps) {
  std::vector<model::NodeId> nodes;
  for (const SweepKeep& keep : keeps) nodes.push_back(keep.node);
  return nodes;
}

// The rule of Gauss and Kronrod with 7 and 15 points, on (-1, 1): R. Piessens et al., "QUADPACK", Springer (1983).
constexpr std::array<double, 8> kronrod_places = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693240, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kronrod_weights = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
    0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> gauss_weights = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780, 0.381830050505118944950369775488975,
    0.417959183673469387755102040816327};

}  // namespace

KeptNodes::KeptNodes(std::shared_ptr<const model::ModelProgram> program, std::span<const SweepKeep> keeps)
    : program_(std::move(program)) {
  std::ranges::copy_if(keeps, std::back_inserter(keeps_),
                       [](const SweepKeep& keep) { return keep.kind != SweepKeep::Kind::reading; });
  if (!keeps_.empty()) tape_ = program_->busy_tape_of(nodes_of(keeps_));
}

KeptValues::KeptValues(const KeptNodes& kept) : kept_(kept) {
  for (const SweepKeep& keep : kept_.keeps_) values_.emplace_back(keep.width(), not_there);
  integrals_.resize(values_.size());
  sizes_.resize(values_.size());
  next_.resize(values_.size());
  now_.resize(values_.size());
  has_extremes_ = std::ranges::any_of(kept_.keeps_, [](const SweepKeep& keep) { return is_extreme(keep.kind); });
}

std::span<const double> KeptValues::evaluate(double t, std::span<const double> x) {
  evaluation_(t, x, now_);
  return now_;
}

std::span<const double> KeptValues::evaluate(double t, const At& at) {
  at(t, x_);
  return evaluate(t, x_);
}

void KeptValues::see(double value, std::size_t keep) {
  double& best = values_[keep].front();
  const double sign = sign_of(kept_.keeps_[keep].kind);
  if (std::isnan(best)) return;  // what is no number somewhere has no extreme
  if (std::isnan(value) || sign * value > sign * best) best = value;
}

void KeptValues::begin(const model::Plan& plan, const X& x) {
  evaluation_ = {kept_.tape_, plan.variables};
  for (const model::TableInput& input : kept_.program_->step_inputs)
    evaluation_.set(input.variable, input.table.value(plan.from));
  begin_ = from_ = plan.from;
  x_ = x;
  std::ranges::fill(integrals_, 0.0);
  std::ranges::fill(sizes_, 0.0);
  std::ranges::fill(next_, std::size_t{0});
  const auto start = evaluate(plan.from, x);
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const SweepKeep& keep = kept_.keeps_[k];
    std::ranges::fill(values_[k], not_there);
    if (keep.kind != SweepKeep::Kind::series) {
      values_[k].front() = start[k];
      continue;
    }
    for (; next_[k] < keep.times.count && keep.times.at(next_[k]) <= plan.from; ++next_[k])
      values_[k][next_[k]] = start[k];
  }
}

void KeptValues::on_piece(double to, const At& at) {
  take_times(to, at);
  if (to > from_) {
    if (has_extremes_) take_samples(to, at);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (is_extreme(kept_.keeps_[k].kind)) look_between(k, at);
      if (kept_.keeps_[k].kind != SweepKeep::Kind::mean) continue;
      add_mean(from_, to, k, at, 0);
      if (to > begin_) values_[k].front() = integrals_[k] / (to - begin_);
    }
  }
  from_ = to;
}

void KeptValues::on_jump(double t, const X& before, const X& after) {
  for (const X* x : {&before, &after}) {
    if (x == &after)
      for (const model::TableInput& input : kept_.program_->step_inputs)
        evaluation_.set(input.variable, input.table.value(t));
    const auto values = evaluate(t, *x);
    for (std::size_t k = 0; k < values_.size(); ++k)
      if (is_extreme(kept_.keeps_[k].kind)) see(values[k], k);
  }
}

/// Samples the piece at equal distances, its ends included.
void KeptValues::take_samples(double to, const At& at) {
  sample_times_.clear();
  samples_.clear();
  for (std::size_t i = 0; i <= parts_of_a_piece; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(parts_of_a_piece);
    sample_times_.push_back(i == parts_of_a_piece ? to : from_ + (to - from_) * part);
    const auto values = evaluate(sample_times_.back(), at);
    samples_.insert(samples_.end(), values.begin(), values.end());
  }
}

/// An extreme lies beside the sample that is higher than its neighbours. One that cannot exceed what has been seen is
/// passed over.
void KeptValues::look_between(std::size_t keep, const At& at) {
  const double sign = sign_of(kept_.keeps_[keep].kind);
  const auto value = [&](std::size_t i) { return sign * samples_[i * values_.size() + keep]; };
  const std::size_t last = sample_times_.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) see(sign * value(i), keep);
  for (std::size_t i = 0; i <= last; ++i) {
    const std::size_t before = i > 0 ? i - 1 : i, behind = i < last ? i + 1 : i;
    if (value(i) < value(before) || value(i) < value(behind)) continue;
    const double rise = std::max(value(i) - value(before), value(i) - value(behind));
    if (!(rise > 0) || value(i) + rise <= sign * values_[keep].front()) continue;
    double low = sample_times_[before], high = sample_times_[behind];
    if (before == i || behind == i) {
      // At an end of the piece it is the end itself, unless the motion rises from there into the piece.
      const double beside = before == i ? low + (high - low) / 64 : high - (high - low) / 64;
      if (!(sign * evaluate(beside, at)[keep] > value(i))) continue;
    }
    search(low, high, keep, at);
  }
}

/// The maximum between two times by parabolas and golden sections: R. P. Brent, "Algorithms for minimization without
/// derivatives", Prentice-Hall (1973), chapter 5.
void KeptValues::search(double low, double high, std::size_t keep, const At& at) {
  constexpr double golden = 0.3819660112501051;
  const double sign = sign_of(kept_.keeps_[keep].kind);
  const auto value = [&](double t) {
    const double v = evaluate(t, at)[keep];
    see(v, keep);
    return -sign * v;
  };
  const double tolerance = exactness * (high - low);
  double x = low + golden * (high - low), w = x, v = x, fx = value(x), fw = fx, fv = fx, step = 0, before = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    if (std::abs(x - middle) <= 2 * tolerance - (high - low) / 2) return;
    double p = 0, q = 0;
    if (std::abs(before) > tolerance) {
      const double r = (x - w) * (fx - fv);
      q = (x - v) * (fx - fw);
      p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      q = std::abs(q);
    }
    const bool is_parabola = q > 0 && std::abs(p) < std::abs(q * before / 2) && p > q * (low - x) && p < q * (high - x);
    before = is_parabola ? step : (x < middle ? high - x : low - x);
    step = is_parabola ? p / q : golden * before;
    const double u = x + (std::abs(step) >= tolerance ? step : std::copysign(tolerance, step));
    const double fu = value(u);
    if (fu <= fx) {
      (u < x ? high : low) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
      continue;
    }
    (u < x ? low : high) = u;
    if (fu <= fw || w == x) {
      v = w, fv = fw, w = u, fw = fu;
    } else if (fu <= fv || v == x || v == w) {
      v = u, fv = fu;
    }
  }
}

void KeptValues::take_times(double to, const At& at) {
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const model::SweepTimes& times = kept_.keeps_[k].times;
    // The last time may lie a rounding behind the end of the run.
    const double slack = 1e-12 * std::max(std::abs(to), std::abs(begin_));
    for (; next_[k] < values_[k].size() && times.count > 0 && times.at(next_[k]) <= to + slack; ++next_[k])
      values_[k][next_[k]] = evaluate(std::min(times.at(next_[k]), to), at)[k];
  }
}

/// The integral over a piece, halved where the two rules do not agree.
void KeptValues::add_mean(double from, double to, std::size_t keep, const At& at, int depth) {
  constexpr int deepest = 12;
  constexpr double allowed = 1e-12;
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double kronrod = 0, gauss = 0, size = 0;
  for (std::size_t i = 0; i < kronrod_places.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      if (side > 0 && kronrod_places[i] == 0) continue;
      const double value = evaluate(middle + side * half * kronrod_places[i], at)[keep];
      kronrod += kronrod_weights[i] * value;
      size += kronrod_weights[i] * std::abs(value);
      if (i % 2 == 1) gauss += gauss_weights[i / 2] * value;
    }
  }
  if (depth < deepest && std::abs(kronrod - gauss) > allowed * (size + sizes_[keep] / half)) {
    add_mean(from, middle, keep, at, depth + 1);
    add_mean(middle, to, keep, at, depth + 1);
    return;
  }
  integrals_[keep] += half * kronrod;
  sizes_[keep] += half * size;
}

}  // namespace continuo::studies
