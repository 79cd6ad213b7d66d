// The evaluation for several runs at once, compiled once: what the tape does to one number is done to that of each run.
#include <cstddef>
#include <span>
#include <type_traits>

#include <continuo/symbolic/tape/tape_lanes.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {

namespace tape {

// These are chosen instead of those for any number in tape_run.hpp and tape_code.hpp.

template <Code code, bool wide>
[[gnu::always_inline]] inline LaneRegister<wide> operate_each(const LaneRegister<wide>& a, const LaneRegister<wide>& b,
                                                              const LaneRegister<wide>& c,
                                                              const LaneRegister<wide>& d) {
  LaneRegister<wide> result;
  for (std::size_t lane = 0; lane < result.width; ++lane)
    result.numbers[lane] = operate<code, double>(a.numbers[lane], b.numbers[lane], c.numbers[lane], d.numbers[lane]);
  return result;
}

template <Code code, class Real>
  requires std::is_same_v<Real, TapeLanes> || std::is_same_v<Real, WideTapeLanes>
[[nodiscard]] [[gnu::always_inline]] inline Real operate(const Real& a, const Real& b, const Real& c, const Real& d) {
  return operate_each<code>(a, b, c, d);
}

#if defined(__x86_64__)
template <Code code>
[[gnu::target("avx2")]] void single(WideTapeLanes* registers, const Instruction& i) {
  constexpr std::size_t n = operands(code);
  const WideTapeLanes& a = registers[i.a];
  const WideTapeLanes& b = n > 1 ? registers[i.b] : a;
  const WideTapeLanes& c = n > 2 ? registers[i.c] : a;
  const WideTapeLanes& d = n > 3 ? registers[i.d] : a;
  registers[i.result] = operate_each<code>(a, b, c, d);
}

template <Code code, class Count>
[[gnu::target("avx2")]] void one_by_one(const WideTapeLanes* a, const WideTapeLanes* b, const WideTapeLanes* c,
                                        const WideTapeLanes* d, Count count, WideTapeLanes* __restrict result) {
  for (std::size_t k = 0; k < count; ++k) result[k] = operate_each<code>(a[k], b[k], c[k], d[k]);
}
#endif

}  // namespace tape

template void Tape::prepare(std::span<TapeLanes>) const;
template void Tape::prepare(std::span<WideTapeLanes>) const;
template void Tape::evaluate(std::span<TapeLanes>, std::span<TapeLanes>) const;
template void Tape::evaluate(std::span<WideTapeLanes>, std::span<WideTapeLanes>) const;

}  // namespace continuo::model
