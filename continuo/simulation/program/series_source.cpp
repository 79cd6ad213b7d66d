// Writes the recurrences of Taylor series as C.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include <continuo/simulation/program/series_source.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t most_single_operations = 4000, most_operations_written_out = 3000;
constexpr std::size_t least_order_of_steps = 4;
constexpr std::uint32_t block = 16;           // members whose sums are formed together
constexpr std::uint32_t most_scattered = 64;  // members of a linear operation that are written one by one

constexpr std::string_view helpers =
    R"(double sin(double), cos(double), tan(double), asin(double), acos(double), atan(double), atan2(double, double);
double sinh(double), cosh(double), tanh(double), exp(double), log(double), pow(double, double);
double sqrt(double), floor(double), ceil(double);
#define INLINE static inline __attribute__((always_inline))
#define PURE static __attribute__((pure))
typedef double two __attribute__((vector_size(16), aligned(8), may_alias));
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));
INLINE two pair(double a, double b) { return (two){a, b}; }
INLINE double plain(long j, double p, long k) { return 1; }
INLINE double weighted(long j, double p, long k) { return (double)j; }
INLINE double of_power(long j, double p, long k) { return (p + 1) * (double)j - (double)k; }
PURE double in_order(const double *a, const double *b, long k, long first, long last) {
  double total = 0;
  for (long j = first; j <= last; ++j) total += (double)j * (a[j * S] * b[(k - j) * S]);
  return total;
}
PURE int sign_of(const double *u, const double *v, long k) {
  for (long j = 0; j <= k; ++j) {
    const double difference = v ? u[j * S] - v[j * S] : u[j * S];
    if (difference != 0) return difference < 0 ? -1 : 1;
  }
  return 0;
}
PURE double power_at_zero(const double *a, const double *r, double p, long k) {
  long m = 0, first = 0;
  while (m <= k && a[m * S] == 0) ++m;
  if (m > k) return 0 * p;
  const double shift = p * (double)m;
  if (shift > (double)k) return 0;
  while ((double)first < shift) ++first;
  if ((double)first != shift) return __builtin_nan("");
  if (k == first) return pow(a[m * S], p);
  const long n = k - first;
  double total = 0;
  for (long j = 1; j <= n && m + j <= k; ++j)
    total += (p * (double)j - (double)(n - j)) * (a[(m + j) * S] * r[(k - j) * S]);
  return total / ((double)n * a[m * S]);
}
)";

/// The order of the coefficients that are written: a number, or the variable k of a loop from 1 on.
struct Order {
  bool is_number;
  std::size_t k;
};

class SeriesWriter {
 public:
  SeriesWriter(const SeriesProgram<double>& program, std::span<const std::uint32_t> derivatives, std::size_t order)
      : program_(program),
        derivatives_(derivatives),
        order_(order),
        row_(program.row_size()),
        use_(program.register_count(), Use::row),
        source_(program.register_count()) {
    find_uses();
    if (is_written_out()) find_pairs();
    std::uint32_t count = 0;
    for (std::uint32_t place = 0; place < use_.size(); ++place)
      if (use_[place] == Use::once) source_[place] = count++;
    once_count_ = count;
  }

  std::string text(std::string_view guards) {
    line("double t[{}];", once_count_ + 1);
    line("two q[{}];", order_ * pairs_.size() + 1);
    if (reads_time()) {
      line("w[{}] = scale;", row_);
      for (std::size_t k = 2; k <= order_; ++k) line("w[{}] = 0;", k * row_);
    }
    all({true, 0});
    if (is_written_out()) {
      for (std::size_t k = 1; k < order_; ++k) all({true, k});
    } else if (order_ > 1) {
      line("for (long k = 1; k < {}; ++k) {{", order_);
      line("double *const c = w + k * S;");
      all({false, 0});
      line("}}");
    }
    const std::string body =
        "static __attribute__((noinline)) void coefficients(double *restrict w, double *restrict x, double scale) {\n" +
        std::move(text_) + "}\n";
    text_.clear();
    // Sums of a few members that lie apart are not gathered into vectors: that would take longer.
    if (is_written_out()) line("#pragma GCC optimize(\"no-tree-slp-vectorize\")");
    line("enum {{ S = {} }};", row_);
    text_ += helpers;
    for (std::uint32_t count = 1; count <= block; ++count) {
      for (const std::string_view weight : {"plain", "weighted", "of_power"}) {
        const std::string name = fmt::format("sum_{}_{}", weight, count);
        if (body.find(name + "(") != std::string::npos) sum_function(name, weight, count);
      }
    }
    text_ += body;
    line("struct series_steps;");
    if (order_ >= least_order_of_steps) text_ += series_steps_source(derivatives_.size(), order_, guards);
    line("void evaluate(double *w, double *x, double scale, struct series_steps *steps) {{");
    if (order_ >= least_order_of_steps) line("if (steps) return take_steps(steps);");
    line("coefficients(w, x, scale);\n}}");
    return std::move(text_);
  }

 private:
  template <class... Arguments>
  void line(fmt::format_string<Arguments...> form, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  enum class Use : std::uint8_t { nowhere, once, row };

  /// Whether the operations of all orders are few.
  [[nodiscard]] bool is_written_out() const {
    std::size_t operations = 0;
    for (const SeriesOperation& o : program_.operations())
      operations += (o.count + 1) / 2 * (is_sum(o.code) ? order_ / 2 : 1);
    return operations * order_ <= most_operations_written_out;
  }
  static bool is_sum(SeriesCode code) { return code >= SeriesCode::product && code <= SeriesCode::arc_tangent2; }

  /// Linear operations on few members are written member by member: what they read may lie anywhere.
  static bool is_scattered(const SeriesOperation& o) { return is_linear(o.code) && o.count <= most_scattered; }
  /// The sums of a product are made of its factors: of its own coefficients it needs none of lower order.
  static bool is_single_product(const SeriesOperation& o) { return o.code == SeriesCode::product && o.count == 1; }
  static bool is_linear(SeriesCode code) { return code >= SeriesCode::add && code <= SeriesCode::divide_by_number; }
  /// Of a number, coefficient 0 is read.
  static bool is_number(SeriesCode code, std::size_t operand) {
    switch (code) {
      case SeriesCode::scale:
      case SeriesCode::subtract_from_number:
        return operand == 0;
      case SeriesCode::add_number:
      case SeriesCode::divide_by_number:
      case SeriesCode::power:
        return operand == 1;
      default:
        return false;
    }
  }

  /// Where coefficients are kept: those that nothing reads but linear operations of the same order in an array that
  /// stays in registers or in the nearest memory. Copies that only these read are not made.
  void find_uses() {
    for (const SeriesOperation& o : program_.operations()) {
      const bool is_copy = o.code == SeriesCode::copy;
      if (!is_copy && !is_scattered(o) && !is_single_product(o)) continue;
      for (std::uint32_t i = 0; i < o.count; ++i) {
        use_[o.result + i] = is_copy ? Use::nowhere : Use::once;
        if (is_copy) source_[o.result + i] = program_.copied()[o.a + i];
      }
    }
    for (auto o = program_.operations().rbegin(); o != program_.operations().rend(); ++o) {
      if (o->code == SeriesCode::copy) {
        const auto uses = std::span(use_).subspan(o->result, o->count);
        std::ranges::fill(uses, std::ranges::max(uses));
        for (std::uint32_t i = 0; i < o->count && uses.front() == Use::row; ++i) need(program_.copied()[o->a + i]);
        continue;
      }
      const std::array operands{o->a, o->b, o->c};
      for (std::size_t k = 0; k < operand_count(o->code); ++k) {
        const std::uint32_t count = o->code == SeriesCode::power && k == 1 ? 1 : o->count;
        const bool is_read_once = is_scattered(*o) && !is_number(o->code, k);
        for (std::uint32_t i = 0; i < count && !is_read_once; ++i) need(operands[k] + i);
      }
    }
  }
  void need(std::uint32_t place) { use_[place] = Use::row; }
  [[nodiscard]] bool reads_time() const {
    const auto copied = program_.copied();
    return std::ranges::find(copied, 0U) != copied.end() || std::ranges::find(derivatives_, 0U) != derivatives_.end() ||
           std::ranges::any_of(program_.operations(), [](const SeriesOperation& o) {
             const std::array operands{o.a, o.b, o.c};
             const auto read = std::span(operands).first(operand_count(o.code));
             return o.code != SeriesCode::copy && std::ranges::find(read, 0U) != read.end();
           });
  }
  static std::size_t operand_count(SeriesCode code) {
    switch (code) {
      case SeriesCode::negate:
      case SeriesCode::square:
      case SeriesCode::square_root:
      case SeriesCode::exponential:
      case SeriesCode::logarithm:
      case SeriesCode::sine_cosine:
      case SeriesCode::hyperbolic_sine_cosine:
      case SeriesCode::tangent:
      case SeriesCode::hyperbolic_tangent:
      case SeriesCode::absolute:
      case SeriesCode::sign:
      case SeriesCode::floor:
      case SeriesCode::ceiling:
      case SeriesCode::logical_not:
        return 1;
      case SeriesCode::select:
      case SeriesCode::arc_tangent2:
        return 3;
      default:
        return 2;
    }
  }
  /// What a copy that is not made was made of.
  [[nodiscard]] std::uint32_t source_of(std::uint32_t place) const {
    while (use_[place] == Use::nowhere) place = source_[place];
    return place;
  }

  /// The coefficient of the order that is written, or of order 0.
  [[nodiscard]] std::string at(Order order, std::uint32_t place, std::string_view member) const {
    const std::string shift = member.empty() ? "" : fmt::format(" + {}", member);
    if (use_[place] == Use::once) return fmt::format("t[{}{}]", source_[place], shift);
    if (order.is_number) return fmt::format("w[{}{}]", order.k * row_ + place, shift);
    return fmt::format("c[{}{}]", place, shift);
  }
  [[nodiscard]] static std::string start(std::uint32_t place, std::string_view member) {
    return member.empty() ? fmt::format("w[{}]", place) : fmt::format("w[{} + {}]", place, member);
  }
  [[nodiscard]] static std::string order_text(Order order) {
    return order.is_number ? fmt::format("{}", order.k) : "k";
  }

  void all(Order order) {
    placed_.clear();
    const std::span<const SeriesOperation> operations = program_.operations();
    for (std::size_t i = 0; i < operations.size(); ++i) {
      const SeriesOperation& o = operations[i];
      if (o.code >= SeriesCode::table_slope) {
        if (order.is_number && order.k == 0) each(o, [&](std::string_view m) { assign(o, order, m, step(o, m)); });
      } else if (const auto one = pair_of_.find(i); one == pair_of_.end()) {
        operation(o, order);
      } else if (one->second > i) {
        both(o, operations[one->second], order);
      }
    }
    // Coefficient k + 1 of the states.
    if (order.is_number) {
      line("{{ const double factor = scale / {}.0;", order.k + 1);
    } else {
      line("{{ const double factor = scale / (double)(k + 1);");
    }
    for_runs(
        derivatives_,
        [&](std::size_t begin, std::size_t count, std::uint32_t from, std::int64_t) {
          const auto to = static_cast<std::uint32_t>(begin + 1);
          const std::string result = order.is_number ? fmt::format("x[{}", (order.k + 1) * derivatives_.size() + begin)
                                                     : fmt::format("x[(k + 1) * {} + {}", derivatives_.size(), begin);
          const std::string next =
              order.is_number ? fmt::format("w[{}", (order.k + 1) * row_ + to) : fmt::format("c[{}", row_ + to);
          const auto uses = std::span(use_).subspan(from, count);
          if (count == 1 || std::ranges::any_of(uses, [](Use use) { return use != Use::row; })) {
            for (std::uint32_t i = 0; i < count; ++i)
              line("{} + {}] = {} + {}] = factor * {};", result, i, next, i, at(order, source_of(from + i), ""));
            return;
          }
          line("for (long i = 0; i < {}; ++i) {} + i] = {} + i] = factor * {};", count, result, next,
               at(order, from, "i"));
        },
        1);
    line("}}");
  }

  /// Parts of a list that go on by a step, this one or any.
  template <class Write>
  static void for_runs(std::span<const std::uint32_t> list, Write&& write, std::int64_t only_step = 0) {
    constexpr std::size_t least = 4;
    for (std::size_t begin = 0; begin < list.size();) {
      std::size_t end = begin + 1;
      std::int64_t step = only_step;
      if (end < list.size()) {
        const std::int64_t here = static_cast<std::int64_t>(list[end]) - static_cast<std::int64_t>(list[begin]);
        if (only_step == 0) step = here;
        while (end < list.size() &&
               static_cast<std::int64_t>(list[end]) - static_cast<std::int64_t>(list[end - 1]) == step)
          ++end;
      }
      if (end - begin < least) end = begin + 1;
      write(begin, end - begin, list[begin], step);
      begin = end;
    }
  }

  /// write(i) for every member: in a loop, or alone.
  template <class Write>
  void each(const SeriesOperation& o, Write&& write) {
    if (o.count == 1) return write("");
    line("for (long i = 0; i < {}; ++i) {{", o.count);
    write("i");
    line("}}");
  }
  void assign(const SeriesOperation& o, Order order, std::string_view i, const std::string& value) {
    line("{} = {};", at(order, o.result, i), value);
  }

  void operation(const SeriesOperation& o, Order order) {
    if (is_scattered(o) && o.count > 1) {
      for (std::uint32_t i = 0; i < o.count; ++i)
        operation({o.code, o.result + i, 1, o.a + i, o.b + i, o.c + i}, order);
      return;
    }
    const bool is_first = order.is_number && order.k == 0;
    const bool is_alone = is_scattered(o);
    const auto a = [&](std::string_view i) { return at(order, is_alone ? source_of(o.a) : o.a, i); };
    const auto b = [&](std::string_view i) { return at(order, is_alone ? source_of(o.b) : o.b, i); };
    const auto set = [&](auto&& value) { each(o, [&](std::string_view i) { assign(o, order, i, value(i)); }); };
    switch (o.code) {
      case SeriesCode::copy:
        return copy(o, order);
      case SeriesCode::add:
        return set([&](std::string_view i) { return a(i) + " + " + b(i); });
      case SeriesCode::subtract:
        return set([&](std::string_view i) { return a(i) + " - " + b(i); });
      case SeriesCode::negate:
        return set([&](std::string_view i) { return fmt::format("-{}", a(i)); });
      case SeriesCode::add_number:
        return set([&](std::string_view i) { return is_first ? a(i) + " + " + start(o.b, i) : a(i); });
      case SeriesCode::subtract_from_number:
        return set(
            [&](std::string_view i) { return is_first ? start(o.a, i) + " - " + b(i) : fmt::format("-{}", b(i)); });
      case SeriesCode::scale:
        return set([&](std::string_view i) { return start(o.a, i) + " * " + b(i); });
      case SeriesCode::divide_by_number:
        return set([&](std::string_view i) {
          const std::string divisor = start(o.b, i);
          return a(i) + (is_first ? " / " + divisor : fmt::format(" * (1 / {})", divisor));
        });
      case SeriesCode::minimum:
      case SeriesCode::maximum:
      case SeriesCode::absolute:
      case SeriesCode::select:
        return set([&](std::string_view i) { return chosen(o, order, i); });
      default:
        return is_first ? value(o) : sums(o, order);
    }
  }

  void copy(const SeriesOperation& o, Order order) {
    if (use_[o.result] == Use::nowhere) return;
    const auto list = program_.copied().subspan(o.a, o.count);
    for_runs(list, [&](std::size_t begin, std::size_t count, std::uint32_t from, std::int64_t step) {
      const auto to = static_cast<std::uint32_t>(o.result + begin);
      if (count == 1) return line("{} = {};", at(order, to, ""), at(order, from, ""));
      line("for (long i = 0; i < {}; ++i) {} = {};", count, at(order, to, "i"),
           at(order, from, fmt::format("i * ({})", step)));
    });
  }

  std::string chosen(const SeriesOperation& o, Order order, std::string_view i) const {
    const std::string a = at(order, o.a, i), b = at(order, o.b, i), k = order_text(order);
    switch (o.code) {
      case SeriesCode::minimum:
      case SeriesCode::maximum:
        return fmt::format("sign_of(&{}, &{}, {}) {} 0 ? {} : {}", start(o.b, i), start(o.a, i), k,
                           o.code == SeriesCode::minimum ? "<" : ">", b, a);
      case SeriesCode::absolute:
        return fmt::format("sign_of(&{}, 0, {}) < 0 ? -{} : {}", start(o.a, i), k, a, a);
      default:
        return fmt::format("{} != 0 ? {} : {}", start(o.a, i), b, at(order, o.c, i));
    }
  }

  /// What is piecewise constant.
  static std::string step(const SeriesOperation& o, std::string_view i) {
    const std::string a = start(o.a, i), b = start(o.b, i);
    switch (o.code) {
      case SeriesCode::sign:
        return fmt::format("{} > 0 ? 1 : {} < 0 ? -1 : {}", a, a, a);
      case SeriesCode::floor:
        return fmt::format("floor({})", a);
      case SeriesCode::ceiling:
        return fmt::format("ceil({})", a);
      case SeriesCode::less:
        return fmt::format("{} < {}", a, b);
      case SeriesCode::less_equal:
        return fmt::format("{} <= {}", a, b);
      case SeriesCode::equal:
        return fmt::format("{} == {}", a, b);
      case SeriesCode::not_equal:
        return fmt::format("{} != {}", a, b);
      case SeriesCode::logical_and:
        return fmt::format("{} != 0 && {} != 0", a, b);
      case SeriesCode::logical_or:
        return fmt::format("{} != 0 || {} != 0", a, b);
      default:
        return fmt::format("{} == 0", a);
    }
  }

  /// The coefficient of order 0 of a product or a function.
  void value(const SeriesOperation& o) {
    each(o, [&](std::string_view i) {
      const std::string a = start(o.a, i), b = start(o.b, i), r = start(o.result, i);
      const std::string second = start(o.result + o.count, i), product = at({true, 0}, o.result, i);
      const auto of = [&](std::string_view function) { line("{} = {}({});", r, function, a); };
      switch (o.code) {
        case SeriesCode::product:
          return line("{} = {} * {};", product, a, b);
        case SeriesCode::square:
          return line("{} = {} * {};", r, a, a);
        case SeriesCode::quotient:
          return line("{} = {} / {};", r, a, b);
        case SeriesCode::square_root:
          return of("sqrt");
        case SeriesCode::exponential:
          return of("exp");
        case SeriesCode::logarithm:
          return of("log");
        case SeriesCode::power:
          return line("{} = {};", r, power_of(o, a));
        case SeriesCode::sine_cosine:
          return line("{} = sin({}), {} = cos({});", r, a, second, a);
        case SeriesCode::hyperbolic_sine_cosine:
          return line("{} = sinh({}), {} = cosh({});", r, a, second, a);
        case SeriesCode::tangent:
          return line("{} = tan({}), {} = 1 + {} * {};", r, a, second, r, r);
        case SeriesCode::hyperbolic_tangent:
          return line("{} = tanh({}), {} = (1 - {}) * (1 + {});", r, a, second, r, r);
        case SeriesCode::arc_tangent:
          return of("atan");
        case SeriesCode::arc_sine:
          return of("asin");
        case SeriesCode::arc_cosine:
          return of("acos");
        default:
          return line("{} = atan2({}, {});", r, a, b);
      }
    });
  }

  /// What is said of a sum: its factors, its range, its weight.
  struct Sum {
    std::uint32_t a, b;
    std::size_t first;
    enum class Last : std::uint8_t { order, before, half } last;  // k, k - 1, (k - 1)/2
    std::string_view weight = "plain";
  };
  static std::size_t last_of(Sum::Last last, std::size_t k) {
    return last == Sum::Last::order ? k : last == Sum::Last::before ? k - 1 : (k - 1) / 2;
  }
  static std::string last_text(Sum::Last last, Order order) {
    if (order.is_number) return fmt::format("{}", last_of(last, order.k));
    return last == Sum::Last::order ? "k" : last == Sum::Last::before ? "k - 1" : "(k - 1) / 2";
  }

  /// finish(i, sum) is written for all members.
  template <class Finish>
  void by_sum(const SeriesOperation& o, Order order, const Sum& sum, Finish&& finish) {
    const std::string p = sum.weight == "of_power" ? exponent_text(o) : "0";
    if (o.count == 1) {
      line("{{ const double s = {};", order.is_number ? terms(o, sum, order.k) : call(sum, order, p, 1, "0", ""));
      finish("", "s");
      return line("}}");
    }
    const std::uint32_t blocks = o.count / block, rest = o.count % block;
    if (blocks > 0) {
      line("for (long m = 0; m < {}; m += {}) {{", blocks * block, block);
      members(o, order, sum, p, block, "m", finish);
      line("}}");
    }
    if (rest > 0) {
      line("{{ enum {{ m = {} }};", blocks * block);
      members(o, order, sum, p, rest, "m", finish);
      line("}}");
    }
  }
  template <class Finish>
  void members(const SeriesOperation&, Order order, const Sum& sum, const std::string& p, std::uint32_t count,
               std::string_view begin, Finish&& finish) {
    line("double s[{}];", count + (count % 4 == 3 ? 1 : 0));
    line("{}{};", count == 1 ? "s[0] = " : "", call(sum, order, p, count, begin, count == 1 ? "" : ", s"));
    line("for (long n = 0; n < {}; ++n) {{ const long i = {} + n;", count, begin);
    finish("i", "s[n]");
    line("}}");
  }
  static std::string call(const Sum& sum, Order order, const std::string& p, std::uint32_t count,
                          std::string_view begin, std::string_view result) {
    return fmt::format("sum_{}_{}(w + {} + {}, w + {} + {}, {}, {}, {}, {}{})", sum.weight, count, sum.a, begin, sum.b,
                       begin, p, order_text(order), sum.first, last_text(sum.last, order), result);
  }

  /// The terms of a sum one by one, in the order of SeriesProgram. factor(register, k) is written for coefficient k.
  template <class Factor>
  [[nodiscard]] std::string terms(const SeriesOperation& o, const Sum& sum, std::size_t k, Factor&& factor) const {
    const std::size_t first = sum.first, last = last_of(sum.last, k);
    const auto term = [&](std::size_t j) {
      const std::string product = factor(sum.a, j) + " * " + factor(sum.b, k - j);
      if (sum.weight == "plain") return product;
      if (sum.weight == "weighted") return fmt::format("{}.0 * ({})", j, product);
      const double weight = (exponent(o) + 1) * static_cast<double>(j) - static_cast<double>(k);
      return fmt::format("{} * ({})", number_text(weight), product);
    };
    // A sum begins with -0, which changes nothing; so it is left out.
    std::string even, odd;
    const auto add = [](std::string& to, const std::string& what) {
      to = to.empty() ? what : fmt::format("{} + {}", to, what);
    };
    for (std::size_t j = first + 1; j < last; ++j) add((j - first) % 2 == 1 ? even : odd, term(j));
    if (!odd.empty()) even = fmt::format("({}) + ({})", even, odd);
    if (first <= last) even = even.empty() ? term(first) : fmt::format("({}) + {}", even, term(first));
    if (first < last) even = fmt::format("({}) + {}", even, term(last));
    return even;
  }
  [[nodiscard]] std::string terms(const SeriesOperation& o, const Sum& sum, std::size_t k) const {
    const std::string sum_text =
        terms(o, sum, k, [this](std::uint32_t place, std::size_t j) { return fmt::format("w[{}]", j * row_ + place); });
    return sum_text.empty() ? "-0.0" : sum_text;
  }

  [[nodiscard]] double exponent(const SeriesOperation& o) const { return program_.number_in(o.b); }
  [[nodiscard]] std::string exponent_text(const SeriesOperation& o) const { return number_text(exponent(o)); }
  /// To the bit.
  static std::string number_text(double number) {
    return std::isnan(number)   ? "__builtin_nan(\"\")"
           : std::isinf(number) ? (number > 0 ? "__builtin_inf()" : "(-__builtin_inf())")
                                : fmt::format("({:a})", number);
  }
  /// See SeriesProgram::power_of.
  [[nodiscard]] std::string power_of(const SeriesOperation& o, const std::string& a) const {
    if (exponent(o) == 1.5) return fmt::format("{} * sqrt({})", a, a);
    if (exponent(o) == -1.5) return fmt::format("1 / ({} * sqrt({}))", a, a);
    return fmt::format("pow({}, {})", a, exponent_text(o));
  }

  // ---- two operations in the halves of one register

  using Pair = std::array<std::uint32_t, 2>;

  /// Of operations with sums, which are alone, those that two can be computed of together: the same one, the second of
  /// which reads nothing that the first one or what comes between them computes.
  void find_pairs() {
    constexpr std::size_t farthest = 12;
    const std::span<const SeriesOperation> operations = program_.operations();
    for (std::size_t i = 0; i < operations.size(); ++i) {
      const SeriesOperation& o = operations[i];
      if (!is_paired(o.code) || o.count != 1 || pair_of_.contains(i)) continue;
      for (std::size_t j = i + 1; j < std::min(operations.size(), i + farthest); ++j) {
        const SeriesOperation& other = operations[j];
        const bool is_alike = other.code == o.code && other.count == 1 && !pair_of_.contains(j);
        if (!is_alike || std::max(other.a, other.code == SeriesCode::square ? 0 : other.b) >= o.result) continue;
        pair_of_[i] = j;
        pair_of_[j] = i;
        for (const Pair& pair : operands_of(o, other))
          if (pair[0] != pair[1]) pairs_.try_emplace(pair, pairs_.size());
        break;
      }
    }
  }
  static bool is_paired(SeriesCode code) {
    return code == SeriesCode::product || code == SeriesCode::square || code == SeriesCode::quotient;
  }
  /// The factors of their sums.
  static std::array<Pair, 2> operands_of(const SeriesOperation& o, const SeriesOperation& other) {
    const Pair a{o.a, other.a}, b{o.b, other.b}, result{o.result, other.result};
    if (o.code == SeriesCode::square) return {a, a};
    return {o.code == SeriesCode::quotient ? b : a, o.code == SeriesCode::quotient ? result : b};
  }
  /// Coefficients k of two registers as one, which `place` has placed where they are kept so.
  [[nodiscard]] std::string pair_at(const Pair& pair, std::size_t k) const {
    const auto kept = pairs_.find(pair);
    if (kept != pairs_.end()) return fmt::format("q[{}]", k * pairs_.size() + kept->second);
    return fmt::format("pair(w[{}], w[{}])", k * row_ + pair[0], k * row_ + pair[1]);
  }
  void place(const Pair& pair, std::size_t k) {
    const auto kept = pairs_.find(pair);
    if (kept == pairs_.end() || !placed_.insert(pair).second) return;
    line("q[{}] = pair(w[{}], w[{}]);", k * pairs_.size() + kept->second, k * row_ + pair[0], k * row_ + pair[1]);
  }
  void both(const SeriesOperation& o, const SeriesOperation& other, Order order) {
    const std::size_t k = order.k;
    const Pair a{o.a, other.a}, b{o.b, other.b}, result{o.result, other.result};
    const auto operands = operands_of(o, other);
    for (const Pair& operand : operands)
      if (operand != result) place(operand, k);
    if (k == 0) {
      value(o);
      value(other);
      return place(result, k);
    }
    const Sum sum = sum_of(o);
    const auto factor = [&](std::uint32_t place, std::size_t j) {
      return pair_at(place == operands[0][0] ? operands[0] : operands[1], j);
    };
    const std::string sum_text = terms(o, sum, k, factor);
    line("{{ const two s = {};", sum_text.empty() ? "pair(-0.0, -0.0)" : sum_text);
    if (o.code == SeriesCode::product) {
      line("const two r = s;");
    } else if (o.code == SeriesCode::quotient) {
      line("const two r = ({} - s) * (1 / {});", pair_at(a, k), pair_at(b, 0));
    } else {
      const std::string middle = k % 2 == 1 ? "" : fmt::format(" + {} * {}", pair_at(a, k / 2), pair_at(a, k / 2));
      line("const two r = (2 * s{}) + 2 * {} * {};", middle, pair_at(a, 0), pair_at(a, k));
    }
    line("{} = r[0]; {} = r[1];", at(order, result[0], ""), at(order, result[1], ""));
    if (const auto kept = pairs_.find(result); kept != pairs_.end()) {
      placed_.insert(result);
      line("q[{}] = r;", k * pairs_.size() + kept->second);
    }
    line("}}");
  }
  /// Of a product, a square or a quotient.
  static Sum sum_of(const SeriesOperation& o) {
    if (o.code == SeriesCode::product) return {o.a, o.b, 0, Sum::Last::order};
    if (o.code == SeriesCode::square) return {o.a, o.a, 1, Sum::Last::half};
    return {o.b, o.result, 1, Sum::Last::order};
  }

  /// The sums of some members, in vectors that do not overlap.
  void sum_function(const std::string& name, std::string_view weight, std::uint32_t count) {
    struct Piece {
      std::string_view type;
      std::uint32_t begin;
    };
    std::vector<Piece> pieces;
    std::uint32_t begin = 0;
    for (; begin + 4 <= count; begin += 4) pieces.push_back({"four", begin});
    // Of three, a fourth number is computed that nobody reads: behind the registers of a row there is always one more.
    if (count - begin == 3) pieces.push_back({"four", begin}), begin += 3;
    if (begin + 2 <= count) pieces.push_back({"two", begin}), begin += 2;
    if (begin < count) pieces.push_back({"double", begin});
    line("INLINE {} {}(const double *a, const double *b, double p, long k, long first, long last{}) {{",
         count == 1 ? "double" : "void", name, count == 1 ? "" : ", double *s");
    for (const Piece& piece : pieces)
      line("{} e{} = -({}){{0}}, o{} = e{};", piece.type, piece.begin, piece.type, piece.begin, piece.begin);
    const auto add = [&](std::string_view sum, std::string_view j) {
      line("{{ const double *const u = a + ({}) * S, *const v = b + (k - ({})) * S, x = {}({}, p, k);", j, j, weight,
           j);
      for (const Piece& piece : pieces)
        line("{}{} += x * (*(const {} *)(u + {}) * *(const {} *)(v + {}));", sum, piece.begin, piece.type, piece.begin,
             piece.type, piece.begin);
      line("}}");
    };
    line("long j = first + 1;");
    line("for (; j + 1 < last; j += 2) {{");
    add("e", "j");
    add("o", "j + 1");
    line("}}\nif (j < last)");
    add("e", "j");
    for (const Piece& piece : pieces) line("e{} += o{};", piece.begin, piece.begin);
    line("if (first <= last)");
    add("e", "first");
    line("if (first < last)");
    add("e", "last");
    if (count == 1) {
      line("return e0;");
    } else {
      for (const Piece& piece : pieces) line("*({} *)(s + {}) = e{};", piece.type, piece.begin, piece.begin);
    }
    line("}}");
  }

  /// The functions from order 1 on: see SeriesProgram::evaluate_sums.
  void sums(const SeriesOperation& o, Order order) {
    const std::uint32_t second = o.result + o.count;
    const std::string k =
        fmt::format("{}{}", order.is_number ? "" : "(double)", order_text(order)) + (order.is_number ? ".0" : "");
    const auto result = [&](std::uint32_t place, std::string_view form) {
      return [this, order, place, form](std::string_view i, std::string_view s) {
        line("{} = {};", at(order, place, i), fmt::format(fmt::runtime(form), fmt::arg("s", s)));
      };
    };
    const std::string by_order = "{s} * (1 / " + k + ")";
    using Last = Sum::Last;
    switch (o.code) {
      case SeriesCode::product:
        return by_sum(o, order, sum_of(o), result(o.result, "{s}"));
      case SeriesCode::square:
        return by_sum(o, order, sum_of(o), [&](std::string_view i, std::string_view s) {
          line("{} = ({}) + 2 * {} * {};", at(order, o.result, i), both_halves(order, o.a, i, s), start(o.a, i),
               at(order, o.a, i));
        });
      case SeriesCode::quotient:
        return by_sum(o, order, sum_of(o), [&](std::string_view i, std::string_view s) {
          line("{} = ({} - {}) * (1 / {});", at(order, o.result, i), at(order, o.a, i), s, start(o.b, i));
        });
      case SeriesCode::square_root:
        by_sum(o, order, {o.result, o.result, 1, Last::half}, [&](std::string_view i, std::string_view s) {
          line("const double rest = {} - ({});", at(order, o.a, i), both_halves(order, o.result, i, s));
          line("{} = rest * (0.5 / {});", at(order, o.result, i), start(o.result, i));
        });
        return at_zero(o, order, o.result, "0.5");
      case SeriesCode::exponential:
        return by_sum(o, order, {o.a, o.result, 1, Last::order, "weighted"}, result(o.result, by_order));
      case SeriesCode::logarithm:
        return by_slope(o, order, o.a, "", k);
      case SeriesCode::arc_tangent:
      case SeriesCode::arc_sine:
        return by_slope(o, order, o.b, "", k);
      case SeriesCode::arc_cosine:
        return by_slope(o, order, o.b, "-", k);
      case SeriesCode::power:
        by_sum(o, order, {o.a, o.result, 1, Last::order, "of_power"}, [&](std::string_view i, std::string_view s) {
          line("{} = {} * (1 / {} * (1 / {}));", at(order, o.result, i), s, k, start(o.a, i));
        });
        return at_zero(o, order, o.a, exponent_text(o));
      case SeriesCode::sine_cosine:
      case SeriesCode::hyperbolic_sine_cosine:
        by_sum(o, order, {o.a, second, 1, Last::order, "weighted"}, result(o.result, by_order));
        return by_sum(o, order, {o.a, o.result, 1, Last::order, "weighted"},
                      result(second, o.code == SeriesCode::sine_cosine ? "-" + by_order : by_order));
      case SeriesCode::tangent:
      case SeriesCode::hyperbolic_tangent:
        by_sum(o, order, {o.a, second, 1, Last::order, "weighted"}, result(o.result, by_order));
        return by_sum(o, order, {o.result, o.result, 0, Last::order},
                      result(second, o.code == SeriesCode::tangent ? "{s}" : "-{s}"));
      default:
        return each(o, [&](std::string_view i) { arc_tangent2(o, order, i, k); });
    }
  }

  /// Powers and roots of what begins at 0, apart: the others are computed in vectors.
  void at_zero(const SeriesOperation& o, Order order, std::uint32_t zero, const std::string& exponent) {
    each(o, [&](std::string_view i) {
      line("if ({} == 0) {} = power_at_zero(&{}, &{}, {}, {});", start(zero, i), at(order, o.result, i), start(o.a, i),
           start(o.result, i), exponent, order_text(order));
    });
  }
  [[nodiscard]] std::string both_halves(Order order, std::uint32_t of, std::string_view i, std::string_view s) const {
    if (order.is_number && order.k % 2 == 1) return fmt::format("2 * {}", s);
    const std::string m = order.is_number
                              ? at({true, order.k / 2}, of, i)
                              : fmt::format("w[k / 2 * S + {}{}]", of, i.empty() ? "" : fmt::format(" + {}", i));
    const std::string whole = fmt::format("2 * {} + {} * {}", s, m, m);
    return order.is_number ? whole : fmt::format("k % 2 == 0 ? {} : 2 * {}", whole, s);
  }
  void by_slope(const SeriesOperation& o, Order order, std::uint32_t slope, std::string_view sign,
                const std::string& k) {
    by_sum(o, order, {o.result, slope, 1, Sum::Last::before, "weighted"}, [&](std::string_view i, std::string_view s) {
      line("{} = ({}{} - {} * (1 / {})) * (1 / {});", at(order, o.result, i), sign, at(order, o.a, i), s, k,
           start(slope, i));
    });
  }
  void arc_tangent2(const SeriesOperation& o, Order order, std::string_view i, const std::string& k) {
    const std::string n = order_text(order), a = "&" + start(o.a, i), b = "&" + start(o.b, i), c = start(o.c, i);
    line(
        "{} = (in_order({}, {}, {}, 1, {}) - in_order({}, {}, {}, 1, {}) - in_order(&{}, &{}, {}, 1, {} - 1)) / ({} * "
        "{});",
        at(order, o.result, i), a, b, n, n, b, a, n, n, start(o.result, i), c, n, n, k, c);
  }

  const SeriesProgram<double>& program_;
  std::span<const std::uint32_t> derivatives_;
  std::size_t order_, row_;
  std::vector<Use> use_;               // by register
  std::vector<std::uint32_t> source_;  // of a copy; of what is kept once its place
  std::size_t once_count_ = 0;
  std::map<std::size_t, std::size_t> pair_of_;  // by operation
  std::map<Pair, std::size_t> pairs_;           // of registers that are kept so
  std::set<Pair> placed_;                       // in the order that is written
  std::string text_;
};

}  // namespace

std::string series_source(const SeriesProgram<double>& program, std::span<const std::uint32_t> derivatives,
                          std::size_t order, std::string_view guards) {
  return SeriesWriter(program, derivatives, order).text(guards);
}

bool is_worth_compiling(const SeriesProgram<double>& program) {
  std::size_t statements = 0;
  for (const SeriesOperation& o : program.operations()) {
    const bool is_linear = o.code >= SeriesCode::add && o.code <= SeriesCode::divide_by_number;
    statements += o.code == SeriesCode::copy ? o.count / 4 + 1 : is_linear && o.count <= most_scattered ? o.count : 1;
    if (o.code == SeriesCode::table || o.code == SeriesCode::table_slope) return false;
  }
  return statements <= most_single_operations;
}

}  // namespace continuo::model
