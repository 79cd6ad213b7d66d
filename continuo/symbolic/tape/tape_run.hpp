// continuo/symbolic/tape/tape_run.hpp
// The evaluation of a Tape for any Real. Numbers (float, double, long double) are compiled in tape.cpp; who evaluates
// with lanes or with derivatives includes this. The labels taken by address are an extension of g++ and clang++.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include <continuo/numerics/taylor.hpp>
#include <continuo/symbolic/tape/tape.hpp>
#include <continuo/symbolic/tape/wide_vectors.hpp>

namespace continuo::model::tape {

template <Code code, class Real>
void single(Real* registers, const Instruction& i) {
  constexpr std::size_t n = operands(code);
  const Real& a = registers[i.a];
  const Real& b = n > 1 ? registers[i.b] : a;
  const Real& c = n > 2 ? registers[i.c] : a;
  const Real& d = n > 3 ? registers[i.d] : a;
  registers[i.result] = operate<code, Real>(a, b, c, d);
}

/// A batch is computed a piece at a time: a loop of constant length over operands that lie side by side.
template <class Real>
inline constexpr std::size_t piece = std::max<std::size_t>(4, 64 * sizeof(double) / sizeof(Real));

/// Numbers begin, ..., begin + count - 1 of an operand side by side. `buffer` holds a number that is one for all.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline const Real* side_by_side(const Operand& operand, const Real* registers,
                                                                     const std::uint32_t* gathered, std::size_t begin,
                                                                     std::size_t count, Real* buffer) {
  if (operand.layout == Operand::Layout::contiguous) return registers + operand.begin + begin;
  if (operand.layout == Operand::Layout::gathered) {
    const std::uint32_t* const from = gathered + operand.begin + begin;
    for (std::size_t k = 0; k < count; ++k) buffer[k] = registers[from[k]];
  }
  return buffer;
}

/// No operand of a batch lies in its results.
template <Code code, class Real, class Count>
[[gnu::always_inline]] inline void one_by_one(const Real* a, const Real* b, const Real* c, const Real* d, Count count,
                                              Real* __restrict result) {
  for (std::size_t k = 0; k < count; ++k) result[k] = operate<code, Real>(a[k], b[k], c[k], d[k]);
}

template <Code code, class Real>
[[gnu::always_inline]] inline void in_pieces(Real* registers, const Batch& batch, const std::uint32_t* gathered) {
  constexpr std::size_t n = operands(code);
  Real buffers[n][piece<Real>];
  for (std::size_t j = 0; j < n; ++j) {
    if (batch.operand[j].layout == Operand::Layout::one)
      std::fill_n(buffers[j], piece<Real>, registers[batch.operand[j].begin]);
  }
  const auto compute = [&](std::size_t begin, auto count) __attribute__((always_inline)) {
    const auto from = [&](std::size_t j) __attribute__((always_inline)) {
      return side_by_side(batch.operand[j], registers, gathered, begin, count, buffers[j]);
    };
    const Real* const a = from(0);
    const Real* const b = n > 1 ? from(n > 1 ? 1 : 0) : a;
    const Real* const c = n > 2 ? from(n > 2 ? 2 : 0) : a;
    const Real* const d = n > 3 ? from(n > 3 ? 3 : 0) : a;
    one_by_one<code>(a, b, c, d, count, registers + batch.result + begin);
  };
  if (batch.count < piece<Real>) return compute(0, std::size_t{batch.count});
  constexpr std::integral_constant<std::size_t, piece<Real>> whole;
  std::size_t begin = 0;
  for (; begin + whole <= batch.count; begin += whole) compute(begin, whole);
  if (begin < batch.count) compute(batch.count - whole, whole);  // some of it again, with the same results
}

template <Code code, class Real>
void many(Real* registers, const Batch& batch, const std::uint32_t* gathered) {
  in_pieces<code>(registers, batch, gathered);
}

#if defined(__x86_64__)
/// The same in vectors of 256 bits. Without the instructions that round only once for a product and a sum, so that
/// every machine computes the same.
template <Code code, class Real>
[[gnu::target("avx2")]] void many_wide(Real* registers, const Batch& batch, const std::uint32_t* gathered) {
  in_pieces<code>(registers, batch, gathered);
}
#else
template <Code code, class Real>
void many_wide(Real* registers, const Batch& batch, const std::uint32_t* gathered) {
  many<code>(registers, batch, gathered);
}
#endif

/// What compilers make vectors of.
template <class Real>
[[nodiscard]] constexpr bool gains_by_vectors(Code code) {
  const bool is_plain = code <= Code::square_root || (code >= Code::select_less && code <= Code::absolute);
  return is_plain && (std::is_same_v<Real, float> || std::is_same_v<Real, double>);
}

template <class Real>
using Single = void (*)(Real*, const Instruction&);
template <class Real>
using Many = void (*)(Real*, const Batch&, const std::uint32_t*);

template <class Real>
inline constexpr auto singles = []<std::size_t... I>(std::index_sequence<I...>) {
  return std::array<Single<Real>, operations>{&single<static_cast<Code>(I), Real>...};
}(std::make_index_sequence<operations>());

template <bool wide, class Real>
inline constexpr auto manys = []<std::size_t... I>(std::index_sequence<I...>) {
  constexpr auto one_of = []<Code code>() -> Many<Real> {
    if constexpr (wide && gains_by_vectors<Real>(code)) {
      return &many_wide<code, Real>;
    } else {
      return &many<code, Real>;
    }
  };
  return std::array<Many<Real>, operations> { one_of.template operator()<static_cast<Code>(I)>()... };
}(std::make_index_sequence<operations>());

/// The straight piece of a table at x, or its slope.
template <class Real>
[[nodiscard]] Real along(const Table::Piece& piece, const Real& x, bool slope) {
  return slope ? Real(piece.slope) : piece.y + piece.slope * (x - piece.x);
}

/// A table along a motion of x: at a corner the piece that comes. Within the rounding of x, but not at it, either one.
template <class Scalar, std::size_t order>
[[nodiscard]] Taylor<Scalar, order> look_up_along(const Table& table, const Taylor<Scalar, order>& x, bool slope) {
  const auto at = static_cast<double>(midpoint(x.c[0]));
  const Table::Piece& here = table.at(at);
  const Table::Piece& before = table.at(std::nextafter(at, -std::numeric_limits<double>::infinity()));
  const auto here_or = [&](auto condition, const Table::Piece& other) {
    return choose(condition, along(other, x, slope), along(here, x, slope));
  };
  if (&before != &here) return here_or(x < Taylor<Scalar, order>(at), before);
  if constexpr (std::is_floating_point_v<Scalar>) {
    return along(here, x, slope);
  } else {
    const Table::Piece& low = table.at(at - x.c[0].rounding);
    const Table::Piece& other = &low != &here ? low : table.at(at + x.c[0].rounding);
    return here_or(&other != &here ? Truth::undecided : Truth::no, other);
  }
}

/// A table at x; lanes one by one, derivatives along the piece that holds the value, enclosures by their own `enclose`.
template <class Real>
[[nodiscard]] Real look_up(const Table& table, const Real& x, bool slope) {
  if constexpr (requires { enclose(table, x, slope); }) {
    return enclose(table, x, slope);
  } else if constexpr (std::is_arithmetic_v<Real>) {
    const auto at = static_cast<double>(x);
    return static_cast<Real>(slope ? table.slope(at) : table.value(at));
  } else if constexpr (requires {
                         x.v;
                         x.a;
                       }) {
    return along(table.at(static_cast<double>(x.a)), x, slope);
  } else if constexpr (is_taylor<Real>) {
    return look_up_along(table, x, slope);
  } else {
    Real y = x;
    for (std::size_t lane = 0; lane < Real::width; ++lane) y.set(lane, look_up(table, x[lane], slope));
    return y;
  }
}

}  // namespace continuo::model::tape

namespace continuo::model {

template <class Real>
void Tape::run_batch(const Program& program, const tape::Batch& batch, Real* registers) const {
  const auto& manys = has_wide_vectors() ? tape::manys<true, Real> : tape::manys<false, Real>;
  manys[static_cast<std::size_t>(batch.code)](registers, batch, program.gathered.data());
}

template <class Real>
void Tape::run(const Program& program, Real* registers) const {
  using tape::Code, tape::single;
  // A jump of its own at the end of each operation tells the processor's predictor which one comes next: 1.6 times
  // as fast as a switch in a loop (measured). Their order is that of `entry`.
  // clang-format off
  static const void* const labels[] = {
      &&add_, &&subtract_, &&multiply_, &&divide_, &&multiply_add_, &&multiply_subtract_, &&subtract_product_,
      &&negated_product_, &&negated_sum_, &&negated_multiply_add_, &&negated_sum_of_products_, &&sum_of_products_,
      &&difference_of_products_, &&sum_times_, &&difference_times_, &&multiply_twice_,
      &&sum_less_product_, &&less_product_plus_, &&negate_, &&square_root_, &&sine_, &&cosine_,
      &&other_, &&table_, &&table_, &&batch_, &&stop_};
  // clang-format on
  static_assert(std::size(labels) == tape::entry(Code::stop) + 1);
  const tape::Instruction* i = program.instructions.data();
  goto* labels[i->entry];
add_:
  single<Code::add>(registers, *i++);
  goto* labels[i->entry];
subtract_:
  single<Code::subtract>(registers, *i++);
  goto* labels[i->entry];
multiply_:
  single<Code::multiply>(registers, *i++);
  goto* labels[i->entry];
divide_:
  single<Code::divide>(registers, *i++);
  goto* labels[i->entry];
multiply_add_:
  single<Code::multiply_add>(registers, *i++);
  goto* labels[i->entry];
multiply_subtract_:
  single<Code::multiply_subtract>(registers, *i++);
  goto* labels[i->entry];
subtract_product_:
  single<Code::subtract_product>(registers, *i++);
  goto* labels[i->entry];
negated_product_:
  single<Code::negated_product>(registers, *i++);
  goto* labels[i->entry];
negated_sum_:
  single<Code::negated_sum>(registers, *i++);
  goto* labels[i->entry];
negated_multiply_add_:
  single<Code::negated_multiply_add>(registers, *i++);
  goto* labels[i->entry];
negated_sum_of_products_:
  single<Code::negated_sum_of_products>(registers, *i++);
  goto* labels[i->entry];
sum_of_products_:
  single<Code::sum_of_products>(registers, *i++);
  goto* labels[i->entry];
difference_of_products_:
  single<Code::difference_of_products>(registers, *i++);
  goto* labels[i->entry];
sum_times_:
  single<Code::sum_times>(registers, *i++);
  goto* labels[i->entry];
difference_times_:
  single<Code::difference_times>(registers, *i++);
  goto* labels[i->entry];
multiply_twice_:
  single<Code::multiply_twice>(registers, *i++);
  goto* labels[i->entry];
sum_less_product_:
  single<Code::sum_less_product>(registers, *i++);
  goto* labels[i->entry];
less_product_plus_:
  single<Code::less_product_plus>(registers, *i++);
  goto* labels[i->entry];
negate_:
  single<Code::negate>(registers, *i++);
  goto* labels[i->entry];
square_root_:
  single<Code::square_root>(registers, *i++);
  goto* labels[i->entry];
sine_:
  single<Code::sine>(registers, *i++);
  goto* labels[i->entry];
cosine_:
  single<Code::cosine>(registers, *i++);
  goto* labels[i->entry];
other_:
  tape::singles<Real>[static_cast<std::size_t>(i->code)](registers, *i);
  ++i;
  goto* labels[i->entry];
table_:
  registers[i->result] = tape::look_up(tables_[i->b], registers[i->a], i->code == Code::interpolate_slope);
  ++i;
  goto* labels[i->entry];
batch_:
  run_batch(program, program.batches[i->a], registers);
  ++i;
  goto* labels[i->entry];
stop_:
  return;
}

template <class Real>
void Tape::prepare(std::span<Real> registers) const {
  for (const Constant& constant : constants_) registers[constant.target] = Real(constant.value);
  run(preparation_, registers.data());
}

template <class Real>
void Tape::run(std::span<Real> registers, std::span<Real> outputs, const tape::Copies& copies) const {
  run(body_, registers.data());
  if (copies.is_empty()) {
    for (std::size_t k = 0; k < outputs_.size(); ++k) outputs[k] = registers[outputs_[k]];
  } else {
    tape::run(copies, registers.data(), outputs.data());
  }
}

template <class Real>
void Tape::evaluate(std::span<Real> registers, std::span<Real> outputs) const {
  if constexpr (std::is_same_v<Real, double>) {
    if (const NativeEvaluation native = native_->function.load(std::memory_order_acquire))
      return native(registers.data(), registers.data() + states_begin_, outputs.data());
  }
  tape::run(copies_, registers.data() + copied_from_, registers.data());
  run(registers, outputs, many_outputs_);
}

template <class Real>
void Tape::evaluate(std::span<Real> registers, std::span<const Real> states, std::span<Real> outputs) const {
  if constexpr (std::is_same_v<Real, double>) {
    if (const NativeEvaluation native = native_->function.load(std::memory_order_acquire))
      return native(registers.data(), states.data(), outputs.data());
  }
  evaluate(registers, states, outputs, many_outputs_);
}

template <class Real>
void Tape::evaluate(std::span<Real> registers, std::span<const Real> states, std::span<Real> outputs,
                    const tape::Copies& copies) const {
  if (reads_only_copies_) {
    tape::run(copies_, states.data(), registers.data());
  } else {
    std::ranges::copy(states, registers.data() + states_begin_);
    tape::run(copies_, registers.data() + copied_from_, registers.data());
  }
  run(registers, outputs, copies);
}

}  // namespace continuo::model
