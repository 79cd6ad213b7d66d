// Models in which random search found missed or doubled events (tests/hybrid, whose referee gives the times), reduced
// to a small size. Each test names the error.
#include <cmath>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::model {
namespace {

struct Found {
  std::string name, method, text;
  std::vector<double> times;  // of the events that mark themselves
};
void PrintTo(const Found& found, std::ostream* out) {
  *out << found.name;
}

class FoundEvents : public testing::TestWithParam<Found> {};

TEST_P(FoundEvents, AreFoundOnce) {
  const Found& found = GetParam();
  const Loaded loaded = load(Source("found.sim", found.text));
  ASSERT_TRUE(loaded) << loaded.text();
  Experiment experiment;
  experiment.method = found.method;
  if (found.method == "rk4") {
    experiment.step = 1e-3;
  } else {
    experiment.rtol = 1e-12;
    experiment.atol = {1e-12};
  }
  experiment.max_steps = 100'000;
  const Simulated simulated = simulate(*loaded.model, experiment);
  ASSERT_TRUE(simulated.run) << render(simulated.diagnostics, loaded.source);
  EXPECT_TRUE(succeeded(simulated.run->outcome.ending)) << describe(simulated.run->outcome);
  std::vector<double> times;
  for (const RecordedEvent& event : simulated.run->events)
    if (!event.mark.empty()) times.push_back(event.t);
  ASSERT_EQ(times.size(), found.times.size());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], found.times[i], 1e-9) << i;
}

// One step contains both windows; the search for the first one takes the start of the second, zero by rounding, for its
// end.
const char* const two_windows = R"(
x'' = -1.034289*(x - 1.296)
x(0) = -0.324;  x'(0) = -0.487
when (t > 1.057 and t < 1.058) or (t > 1.054 and t < 1.055) { mark "e" }
run 0..1.2
)";

// One part of the condition remains at zero for ever, on the side where it is false, while the other leaves zero.
const char* const lasting_zero = R"(
n' = 0
x'' = -46.131264*(x + 1.771)
n(0) = 2;  x(0) = -3.879041746410642;  x'(0) = -1.191
when n > 2 or exp(-((x + 3.955)/0.097)^2) < 0.5 { x' := -1.191; mark "e" }
run 0..0.06
)";

// The guard falls, which is not a watched direction, and the action of another event takes it back.
const char* const carried_back = R"(
x'' = 9.777
x(0) = -1.912;  x'(0) = 1.616
when sin(1.721*x) >= 0.723 { mark "e0" }
when x > 6.812 { x := -0.337*x; mark "e1" }
run 0..1.2
)";

// An event of the new mode has the same guard as the one that leaves the old mode.
const char* const other_mode = R"(
x'' = -0.165649*(x - 0.155)
mode m0 { y' = 1 }
mode m1 { y' = 2 }
x(0) = 0.358;  x'(0) = -0.122;  y(0) = 0
when sin(1.872*x') rises through -0.266 { go m1; mark "e0" }
when sin(1.872*x') falls through -0.266 in m0 { mark "e1" }
run 0..2.1
)";

// A window of a thousandth while the equations slide: difference quotients over a longer distance miss it.
const char* const window_while_sliding = R"(
n' = 0
x'' = -4.997
y' = -0.463*sin(0.538*t) + (if y > 0.11 then -1.827 else 1.827)
n(0) = 0;  x(0) = -0.488;  x'(0) = 0.475;  y(0) = 1.319
when x > -1.579 and x < -1.578 { n := n + 1; mark "e" }
run 0..2.3
)";

// A jump of the guard at a time where by chance a step ends.
const char* const jump_at_the_end_of_a_step = R"(
let w = if mod(x, 0.515) < 0.202 then 1 else 0
x' = -1.17
x(0) = 0.01815420512820512
when w rises through 0.5 { x := -0.058*x; mark "e" }
run 0..0.4
)";

// Counters that change at the time of a jump, and a condition of three parts: the rounding of t carries the guard over
// its jump.
const char* const jump_in_time = R"(
n' = 0
x' = -2.101*(x + 1.419*cos(2.386*t)) - 1.525
y'' = -21.678336*(y + 0.64)
n(0) = 0;  x(0) = -0.337;  y(0) = 1.846;  y'(0) = -0.526
every 0.3 from 1 { n := n + 1 }
when not (mod(t, 1.338) > 0.642 and not (y' <= -0.914) and n == 2) { x := -1.489*x - 0.147; mark "e" }
run 0..1.4
)";

// After a step to an event the state is off by the tolerance, on the wrong side of the surface along which it slides.
const char* const event_while_sliding = R"(
x'' = -4.259
y' = -1.06*sin(6.808*t) - 1.727*sign(y)
x(0) = -0.837;  x'(0) = -0.498;  y(0) = -1.5
when 2*x'^2 > 191.366 { y := -0.679*y; mark "e" }
run 0..2.3
)";

// A step to an event was repeated, each time with a lower order.
const char* const order_kept = R"(
x'' = -29.648025*(x + 1.733)
x(0) = 1.689;  x'(0) = 0.315
when sin(0.846*x') rises through -0.46 { x := 0.509; mark "e" }
run 0..0.2
)";

// Another part of the condition keeps the guard at zero before the event: no slope indicates the crossing.
const char* const held_at_zero = R"(
n' = 0
x' = -10000*(x - 0.517*cos(2.112*t))
y' = -1.685*y + 0.348
n(0) = 3;  x(0) = -0.842;  y(0) = 1.203
when exp(-((x + 0.501)/0.01)^2) <= 0.5 or n > 3 { y := -0.956*y - 0.71*x; mark "e" }
run 0..0.01
)";

// The counter is at its threshold: it is the greater of the two parts while the other condition is false, and the guard
// is zero there. The guard jumped back from the event's tolerance band to that zero, and was taken for one that had not
// left the band.
const char* const counter_at_its_threshold = R"(
n' = 0
x'' = -5.943*5.943*(x - 1.384)
n(0.455) = 1;  x(0.455) = 2;  x'(0.455) = 14
when mod(x', 1.146) <= 0.69 or n > 1 { mark "e" }
run 0.455..0.6
)";

// The same in time alone: one step contains a window that a jump closes and another that a jump opens.
const char* const counter_and_windows = R"(
let w = if mod(t, 0.488) < 0.111 then 1 else 0
n' = 0
n(0) = 0
when not (w >= 0.5 or n > 2 or mod(t, 1.035) < 0.546) { n := n + 1; mark "e" }
run 0..2.1
)";

// Two events at one instant, one of which only passes through: where the rest of its condition is identically zero, no
// derivative shows it.
const char* const counter_at_another_event = R"(
n' = 0
x' = 1
n(0) = 2;  x(0) = 0
when n >= 2 and mod(x, 1.035) < 0.546 { mark "e" }
when n > 2 or mod(x, 1.035) < 0.546 { n := 2 }
run 0..5
)";

// The event starts a slide at its own instant; its guard, short of zero by rounding, then seemed to turn back.
const char* const slide_at_an_event = R"(
n' = 0
x' = 1.674*cos(4.447*t) - 0.625
y' = -2.429*sin(4.044*t) + (if y > 0 then -1.681 else 1.681)
n(0) = 0;  x(0) = 1.737;  y(0) = 1.285
when not (x >= -0.893) { y := 0.363*y; n := n + 1; mark "e" }
run 0..5
)";

// The unknowns are solved for again after the event, and rounding takes the unknown back over its jump.
const char* const jump_of_an_unknown = R"(
unknown u = 0
x' = -1.612
y' = -1.631*y + 1.255
0 = u + u^3 - (1.2*y - sin(2.084*t))
x(0) = 0.921;  y(0) = 1.122
when floor(u/0.805) falls through 0.5 { x := -0.86*x; mark "e" }
run 0..0.3
)";

// The unknown passes zero, where its tolerance is far smaller than the accuracy of the states on which it depends: the
// steps of bdf shrank to nothing there.
const char* const unknown_near_zero = R"(
unknown u = 0
x'' = -6.898*6.898*(x - 1.659)
0 = u + u^3 - (0.556*x' - 0.802*x)
x(0) = 1.446;  x'(0) = -0.661
every 0.3 { x := -0.962*x + 0.511*x' - 0.026; mark "e" }
run 0..1.6
)";

// The event changes the mode while y slides, and y continues to slide in the new one: between the two the guard seemed
// to turn.
const char* const mode_left_while_sliding = R"(
let w = if mod(t, 1.199) < 1.059 then 1 else 0
n' = 0
y' = 1.196*sin(4.523*t) - 1.909*sign(y + 0.233)
mode m0 { x'' = -1.285*1.285*(x + 1.397) }
mode m1 { x'' = -3.075*3.075*(x + 1.213) }
n(0) = 0;  x(0) = -1.081;  x'(0) = -0.101;  y(0) = -0.968
every 0.2 { if w > 0.5 { n := 2*n + 1 } else { go m0 } }
when n rises through 4.5 { x' := x; x := x' }
every 0.2 from 0.1 { n := n + 1; if x'*x' + x*x < 2.962 { y := -0.845*y + 0.537*x } else { go m1 } }
when x' + 1.164*y crosses through 1.073 { go m0; mark "e" }
run 0..1.8
)";

// At another event, the part of the condition that is nearest to zero rises; the condition is never true.
const char* const never = R"(
x' = 2 - x;  y' = -1000*(y - x*z);  z' = 0
x(0) = 0;  y(0) = 0;  z(0) = 1
when x rises through 1 { z := z + 0.1; mark "e" }
when x > 1 and x < 1 { mark "never" }
run 0..2
)";

// One part of the condition remains at zero, so that its guard never leaves zero between events, and there are more
// events than the limit for chattering.
const char* const held_by_another_part = R"(
x' = 1;  n' = 0
x(0) = 0;  n(0) = 1
when n > 1 or x > 0.1 { x := 0; mark "e" }
run 0..3.05
)";

std::vector<Found> cases() {
  std::vector<double> thirty;
  for (int k = 1; k <= 30; ++k) thirty.push_back(0.1 * k);
  std::vector<Found> all;
  for (const char* method : {"dop853", "radau", "bdf", "rk4"}) {
    const std::string of = method;
    all.push_back({"two_windows_" + of, of, two_windows, {1.054, 1.057}});
    all.push_back({"lasting_zero_" + of, of, lasting_zero, {0.0279615445733, 0.0524552148699}});
    all.push_back(
        {"carried_back_" + of, of, carried_back, {0.5519993466247, 0.9578040059809, 1.1807883883446, 1.1807883883446}});
    all.push_back({"other_mode_" + of, of, other_mode, {0.9245650982353, 2.0006148246094}});
    all.push_back({"window_while_sliding_" + of, of, window_while_sliding, {0.7623632583853}});
    all.push_back(
        {"jump_at_the_end_of_a_step_" + of, of, jump_at_the_end_of_a_step, {(0.01815420512820512 + 0.313) / 1.17}});
    all.push_back({"jump_in_time_" + of, of, jump_in_time, {1.338}});
    all.push_back({"event_while_sliding_" + of, of, event_while_sliding, {2.1798001305968}});
    all.push_back({"order_kept_" + of, of, order_kept, {0.0342825277507, 0.1706905640340}});
    all.push_back({"counter_at_its_threshold_" + of,
                   of,
                   counter_at_its_threshold,
                   {0.4802314943895, 0.5085819234227, 0.5308966926569, 0.5501674319159, 0.5675650712736,
                    0.5836963042036, 0.5989271956171}});
    all.push_back({"counter_and_windows_" + of, of, counter_and_windows, {0.599, 1.581, 2.063}});
    all.push_back(
        {"counter_at_another_event_" + of, of, counter_at_another_event, {1.035, 2 * 1.035, 3 * 1.035, 4 * 1.035}});
    all.push_back({"slide_at_an_event_" + of, of, slide_at_an_event, {3.7352313665773, 4.7180438686701}});
    all.push_back({"held_by_another_part_" + of, of, held_by_another_part, thirty});
    all.push_back({"mode_left_while_sliding_" + of, of, mode_left_while_sliding, {1.6697218830926}});
    if (of == "radau" || of == "bdf") {
      all.push_back({"jump_of_an_unknown_" + of, of, jump_of_an_unknown, {0.0071265470750}});
      all.push_back({"unknown_near_zero_" + of, of, unknown_near_zero, {0.3, 0.6, 0.9, 1.2, 1.5}});
    }
    if (of != "rk4") all.push_back({"never_" + of, of, never, {std::log(2.0)}});
    if (of != "rk4") all.push_back({"held_at_zero_" + of, of, held_at_zero, {2.97121179248e-5}});
  }
  all.push_back({"mode_left_while_sliding_by_choice", "dop853_radau", mode_left_while_sliding, {1.6697218830926}});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Each, FoundEvents, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Found>& found) { return found.param.name; });

}  // namespace
}  // namespace continuo::model
