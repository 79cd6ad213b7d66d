// Tests of the referee: against a second one that shares only the rules with it, against itself with ten times as many
// samples, and against known motions.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <tests/hybrid/brute_force.hpp>
#include <tests/hybrid/flow.hpp>
#include <tests/hybrid/generator.hpp>
#include <tests/hybrid/referee.hpp>

namespace continuo::hybrid {
namespace {

constexpr Ability everything{.algebraic = true, .stiff = false, .any_rate = true};

bool slides(const HybridModel& model) {
  return std::ranges::any_of(model.blocks, [](const Block& b) { return b.kind == Block::Kind::relay; });
}

bool touches(const HybridModel& model) {
  return std::ranges::any_of(model.comparisons, [](const Comparison& c) { return c.contact; });
}

/// Converts to double: the values compared are far above its rounding.
double seen(Real value) {
  return static_cast<double>(value);
}

void expect_same(const HybridModel& model, const Expected& expected, const Expected& found, double error) {
  ASSERT_EQ(found.events.size(), expected.events.size()) << text_of(model);
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    EXPECT_EQ(found.events[i].event, expected.events[i].event) << i << "\n" << text_of(model);
    EXPECT_NEAR(seen(found.events[i].t - expected.events[i].t), 0, error) << i << "\n" << text_of(model);
  }
  for (std::size_t i = 0; i < found.end.size(); ++i)
    EXPECT_NEAR(seen(found.end[i] - expected.end[i]), 0, error * (1 + std::fabs(seen(expected.end[i]))))
        << i << "\n"
        << text_of(model);
}

TEST(Referee, AgreesWithTheWrittenEquationsInTinySteps) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const HybridModel model = random_model(seed, everything);
    if (slides(model) || touches(model)) continue;
    const Expected expected = referee_of_well_conditioned(model);
    if (!expected.rejected.empty()) continue;
    // `soon` moves a root by 1e-8, and later ones by up to twenty times that at each event.
    expect_same(model, expected, brute_force(model), 1e-6);
    ++compared;
  }
  EXPECT_GE(compared, 25);
}

TEST(Referee, FindsNoMoreInTenTimesAsManySamples) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const HybridModel model = random_model(seed, {.algebraic = true, .stiff = true, .any_rate = true});
    const Expected expected = referee(model);
    if (expected.rejected.empty()) expect_same(model, expected, referee(model, 10), 1e-12);
  }
}

/// Friction by Moreau's time-stepping, without case distinctions: the velocity due to the drive alone, moved towards
/// the surface by the greatest impulse of friction.
Real velocity_by_moreau(const HybridModel& model, const Block& block, Real end) {
  const Block::Parameters& p = block.in_mode.front();
  const std::vector<Real> start(model.initial.begin(), model.initial.end());
  const Flow flow(model, 0, 0, start);  // of the block's drive, which does not switch
  const Real constant = p.c + (block.flag == none ? 0 : p.b * start[static_cast<std::size_t>(block.flag)]);
  Real v = start[static_cast<std::size_t>(block.state)];
  constexpr Real h = 2e-5L;
  const long steps = std::lround(static_cast<double>(end / h));
  v -= block.level;
  for (long i = 0; i < steps; ++i) {
    const Real middle = (static_cast<Real>(i) + 0.5L) * h;
    const Real moving =
        block.drive == none ? std::sin(p.w * middle) : flow.states_at(middle)[static_cast<std::size_t>(block.drive)];
    const Real free = v + h * (p.a * moving + constant);
    v = std::copysign(std::max<Real>(std::fabs(free) - h * p.mu, 0), free);
  }
  return v + block.level;
}

TEST(Referee, SlidesAsMoreausStepsDo) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 90; ++seed) {
    HybridModel model = random_model(seed, everything);
    model.events.clear();
    const Expected expected = referee(model);
    if (!expected.rejected.empty()) continue;
    for (const Block& block : model.blocks) {
      if (block.kind != Block::Kind::relay) continue;
      const auto i = static_cast<std::size_t>(block.state);
      const Real end = model.end_time();
      EXPECT_NEAR(seen(velocity_by_moreau(model, block, end) - expected.end[i]), 0, 1e-4) << text_of(model);
      ++compared;
    }
  }
  EXPECT_GE(compared, 10);
}

}  // namespace
}  // namespace continuo::hybrid
