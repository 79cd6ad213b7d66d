// Writes the steps of a Taylor series: components in registers of four, all terms of a sum one by one.
#include <iterator>

#include <fmt/format.h>

#include <continuo/simulation/program/series_steps_source.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t width = 4, most_pieces_written_out = 2;

/// coarse_log2 and coarse_exp2 are those of methods/taylor_series/coarse_power.hpp. Of the numbers of a register that
/// belong to no component, nothing is added.
constexpr std::string_view step_helpers = R"(struct series_steps {
  double *rows, *scratch, *x, *rest, *now, *next;
  double t, scale, size, carried, limit, longest, until, forward;
  const double *rtol, *atol;
  long long rtol_each, atol_each;
  double terms[2], greatest_factor, safety, *times;
  const double *numbers;
  long long most, made;
};
typedef double lanes __attribute__((vector_size(32)));
typedef long long lane_masks __attribute__((vector_size(32)));
INLINE lanes load(const double *from) {
  lanes a;
  __builtin_memcpy(&a, from, sizeof a);
  return a;
}
INLINE void store(lanes a, double *to) { __builtin_memcpy(to, &a, sizeof a); }
INLINE lanes all_lanes(double a) { return (lanes){a, a, a, a}; }
INLINE lanes size_of(lanes a) { return (lanes)((lane_masks)a & 0x7fffffffffffffff); }
INLINE lanes keep(lanes a, lane_masks m) { return (lanes)((lane_masks)a & m); }
INLINE lanes greater(lanes a, lanes b) {
  const lane_masks m = a > b;
  return (lanes)(((lane_masks)a & m) | ((lane_masks)b & ~m));
}
INLINE double size_of_one(double a) { return __builtin_fabs(a); }
INLINE double coarse_log2(double x) {
  unsigned long long bits;
  __builtin_memcpy(&bits, &x, sizeof x);
  const unsigned long long of_fraction = (bits & 0x000fffffffffffff) | 0x3ff0000000000000;
  double m;
  __builtin_memcpy(&m, &of_fraction, sizeof m);
  const double exponent = (double)((int)(bits >> 52) - 1023), square = m * m;
  return (exponent - 2.498353148814169 + 4.029211391071479 * m) +
         square * ((0.6260321821639283 * m - 2.0783351682517117) - 0.0784406762091458 * square);
}
INLINE double coarse_exp2(double x) {
  const double shift = 0x1.8p52, shifted = x + shift, f = x - (shifted - shift);
  unsigned long long bits;
  __builtin_memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;
  double power;
  __builtin_memcpy(&power, &bits, sizeof bits);
  return power *
         ((0.9999245569508709 + 0.6931367338836214 * f) + f * f * (0.24263947854625845 + 0.055838282946220126 * f));
}
)";

/// TaylorSeries::measure_piece; the defect comes first, as nothing waits for it longer.
constexpr std::string_view measure_piece = R"(struct measure {
  lanes error, before, last;
};
struct measure_factors {
  double terms[2], defect, of_polynomial, of_slope;
};
INLINE void measure_piece(const struct series_steps *s, const struct measure_factors *f, const double *now,
    const double *next, const double *x, const double *x_new, const double *slope, long i, lane_masks kept,
    struct measure *sums) {
  const lanes to = load(x_new + i);
  lanes defect = all_lanes(f->defect) *
      (load(next + N + i) * all_lanes(f->of_slope) - load(slope + i) * all_lanes(f->of_polynomial));
  defect = size_of(defect);
  const lanes zero_if_finite = (to - to) + (defect - defect);
  const lanes relative = s->rtol_each ? each(s->rtol, i) : all_lanes(s->rtol[0]);
  const lanes absolute = s->atol_each ? each(s->atol, i) : all_lanes(s->atol[0]);
  const lanes before = size_of(load(now + (P - 1) * N + i)) * all_lanes(f->terms[0]);
  const lanes last = size_of(load(now + P * N + i)) * all_lanes(f->terms[1]);
  const lanes size = greater(size_of(load(x + i)), size_of(to));
  const lanes error = greater(greater(before, last), defect) / (absolute + relative * size);
  sums->error += keep(error * error + zero_if_finite, kept);
  const lanes weight = all_lanes(1.0) / (absolute + relative * size_of(to));
  const lanes next_before = load(next + (P - 1) * N + i) * weight, next_last = load(next + P * N + i) * weight;
  sums->before += keep(next_before * next_before, kept);
  sums->last += keep(next_last * next_last, kept);
}
INLINE double mean(lanes sum) { return ((sum[0] + sum[1]) + (sum[2] + sum[3])) * (1 / (double)N); }
)";

/// The choice of the size, see TaylorSeries::next_factor; then what StepControl does.
constexpr std::string_view text_of_steps =
    R"(INLINE double next_factor(const struct series_steps *s, double before, double last) {
  before *= s->terms[0] * s->terms[0];
  last *= s->terms[1] * s->terms[1];
  const double sum = before + last;
  if (sum - sum != 0) return 0;
  const double a = (1 / (2.0 * (P - 1))) * coarse_log2(before), b = (1 / (2.0 * P)) * coarse_log2(last);
  const double wanted = coarse_exp2(-(a < b ? b : a));
  return (wanted < s->greatest_factor ? wanted : s->greatest_factor) * s->safety;
}
static void take_steps(struct series_steps *restrict s) {
  double *x = s->scratch, *rest = x + PADDED, *x_new = rest + PADDED, *next_rest = x_new + PADDED, *other;
  double *const slope = next_rest + PADDED, *const w = s->rows, *now = s->now, *next = s->next;
  double t = s->t, size = s->size, carried = s->carried, scale = s->scale;
  for (long i = 0; i < N; ++i) x[i] = s->x[i], rest[i] = s->rest[i];
  long long made = 0;
  for (; made < s->most; ++made) {
    const double room = s->limit - t, h = size_of_one(size) > s->longest ? s->forward * s->longest : size;
    const double wanted = h + carried, end = t + wanted, theta = h / scale;
    if (s->forward * (1.01 * h - room) >= 0 || end == t || s->forward * (end - s->until) >= 0) break;
    if (GUARDS) break;
    advance(now, x, rest, theta, x_new, next_rest, slope);
    w[0] = t + h;
    for (long i = 0; i < N; ++i) next[i] = w[i + 1] = x_new[i];
    coefficients(w, next, h);
    const struct measure sums = measure(s, theta, h, scale, now, next, x, x_new, slope);
    if (!(mean(sums.error) <= 1)) break;
    const double factor = next_factor(s, mean(sums.before), mean(sums.last));
    if (!(factor > 0)) break;
    size = h * factor, carried = wanted - (end - t), t = end, scale = h;
    s->times[made] = t;
    other = x, x = x_new, x_new = other;
    other = rest, rest = next_rest, next_rest = other;
    other = now, now = next, next = other;
  }
  for (long i = 0; i < N; ++i) s->x[i] = x[i], s->rest[i] = rest[i];
  s->t = t, s->size = size, s->carried = carried, s->scale = scale, s->made = made;
}
)";

class StepsWriter {
 public:
  StepsWriter(std::size_t components, std::size_t order) : components_(components), order_(order) {}

  std::string text(std::string_view guards) {
    const std::size_t pieces = (components_ + width - 1) / width;
    line("enum {{ N = {}, P = {}, PADDED = {} }};", components_, order_, pieces * width);
    text_ += step_helpers;
    sums_of_piece();
    advance();
    each_tolerance();
    text_ += measure_piece;
    measure();
    text_ += guards;
    line("#define GUARDS {}", guards.empty() ? "0" : "s->numbers && may_have_root(now, x, t, h, theta, s->numbers)");
    text_ += text_of_steps;
    return std::move(text_);
  }

 private:
  template <class... Arguments>
  void line(fmt::format_string<Arguments...> form, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  /// write(place, mask) for every four components; the mask has the bits of those that there are.
  template <class Write>
  void each_piece(Write&& write) {
    constexpr std::string_view all = "(lane_masks){-1, -1, -1, -1}";
    const std::size_t whole = components_ / width, rest = components_ % width;
    if (whole > most_pieces_written_out) {
      line("for (long i = 0; i < {}; i += {}) {{", whole * width, width);
      write("i", all);
      line("}}");
    } else {
      for (std::size_t k = 0; k < whole; ++k) write(fmt::format("{}", k * width), all);
    }
    if (rest == 0) return;
    write(fmt::format("{}", whole * width),
          fmt::format("(lane_masks){{-1, {}, {}, 0}}", rest > 1 ? -1 : 0, rest > 2 ? -1 : 0));
  }

  /// The sums of TaylorSeries::sums_of, even and odd terms apart.
  void sums_of_piece() {
    line("INLINE void sums_of(const double *c, double theta, lanes *sum, lanes *slope) {{");
    line("const double square = theta * theta;");
    line("const lanes q = all_lanes(square), part = all_lanes(theta), first = load(c + N);");
    for (const auto& [name, least] : {std::pair("even", 2), std::pair("odd", 3)}) {
      std::size_t k = order_ - (order_ - static_cast<std::size_t>(least)) % 2;
      line("lanes {0} = all_lanes(0.0) + load(c + {1} * N), {0}_slope = all_lanes(0.0);", name, k);
      for (k -= 2; k >= static_cast<std::size_t>(least); k -= 2) {
        line("{0}_slope = {0}_slope * q + {0};", name);
        line("{0} = {0} * q + load(c + {1} * N);", name, k);
      }
    }
    line("const lanes second = even + part * odd;");
    line("const lanes rise = all_lanes(2.0) * even + part * (all_lanes(3.0) * odd) +");
    line("    all_lanes(2.0 * square) * (even_slope + part * odd_slope);");
    line("*sum = part * (first + part * second);");
    line("*slope = first + part * rise;\n}}");
  }

  void advance() {
    line("INLINE void advance(const double *now, const double *x, const double *rest, double theta, double *x_new,");
    line("    double *next_rest, double *slope) {{");
    each_piece([this](std::string_view i, std::string_view) {
      line("{{ lanes sum, rise;");
      line("sums_of(now + {}, theta, &sum, &rise);", i);
      line("const lanes change = sum + load(rest + {}), from = load(x + {}), to = from + change;", i, i);
      line("store(to, x_new + {0}), store((from - to) + change, next_rest + {0}), store(rise, slope + {0}); }}", i);
    });
    line("}}");
  }

  /// Tolerances of components, which lie in arrays without room behind them.
  void each_tolerance() {
    line("INLINE lanes each(const double *from, long i) {{");
    line("return (lanes){{from[i], i + 1 < N ? from[i + 1] : 1, i + 2 < N ? from[i + 2] : 1,");
    line("    i + 3 < N ? from[i + 3] : 1}};\n}}");
  }

  void measure() {
    line("INLINE struct measure measure(const struct series_steps *s, double theta, double h, double scale,");
    line("    const double *now, const double *next, const double *x, const double *x_new, const double *slope) {{");
    line("struct measure sums = {{all_lanes(0.0), all_lanes(0.0), all_lanes(0.0)}};");
    line("double power = size_of_one(theta), before = 1;");
    for (std::size_t n = order_ - 1; n > 0; n /= 2) line("{}power *= power;", n % 2 == 1 ? "before *= power; " : "");
    line("const struct measure_factors f = {{{{before * s->terms[0], before * size_of_one(theta) * s->terms[1]}},");
    line("    h / {}.0, 1 / scale, 1 / h}};", order_ + 1);
    each_piece([this](std::string_view i, std::string_view mask) {
      line("measure_piece(s, &f, now, next, x, x_new, slope, {}, {}, &sums);", i, mask);
    });
    line("return sums;\n}}");
  }

  std::size_t components_, order_;
  std::string text_;
};

}  // namespace

std::string series_steps_source(std::size_t components, std::size_t order, std::string_view guards) {
  return StepsWriter(components, order).text(guards);
}

}  // namespace continuo::model
