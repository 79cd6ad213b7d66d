// Characters in the language: against closed forms, and against `walk` called by hand in the same world.
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

#include <continuo/bodies/character.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::worlds::characters_test {
namespace {

constexpr double h = 1.0 / 128, skin = 0.005;  // a step without rounding
const WorldOptions fast{.method = "fast", .step = h};

/// On a floor, driven by the inputs `right` and `up`.
const std::string on_a_floor = R"(
input right = 0 in -1..1 key "d"
input up = 0 in 0..1 key "w"
param height = 1.8, jump = 4
world {
  gravity (0, -9.81)
  mode fast step 1/128
  wall floor (0, 1) at 0
  wall (-1, 0) at -5
  character hero at (0, 2.9) height height walk 2*right jump jump*up
}
run 0..4
check energy drift < 1e-12
)";

std::uint32_t input(const std::string& text, std::size_t number) {
  return program_of(text)->model.inputs[number].variable;
}

TEST(Characters, FallStandAndWalkAsTheirKeysSay) {
  const auto run = started(on_a_floor, fast);
  ASSERT_TRUE(run->advance_to(0.5));
  EXPECT_NEAR(run->position(0)[1], 2.9 - 9.81 / 2 * 0.25, 1e-12);
  EXPECT_NEAR(run->velocity(0)[1], -9.81 / 2, 1e-12);
  EXPECT_EQ(run->state().back(), 0);
  ASSERT_TRUE(run->advance_to(1));
  EXPECT_NEAR(run->position(0)[1], 0.9 + skin, skin / 2 + 1e-4);
  EXPECT_EQ(run->velocity(0), (Point{0, 0, 0}));
  EXPECT_EQ(run->state().back(), 1);
  ASSERT_TRUE(run->set(input(on_a_floor, 0), 1));
  ASSERT_TRUE(run->advance_to(2));
  EXPECT_NEAR(run->position(0)[0], 2, 1e-9);
  EXPECT_NEAR(run->velocity(0)[0], 2, 1e-9);
  ASSERT_TRUE(run->advance_to(4));
  EXPECT_NEAR(run->position(0)[0], 5 - 0.3 - skin, skin);  // at the wall, where it has no velocity
  EXPECT_NEAR(run->velocity(0)[0], 0, 1e-9);
}

/// A key that is held makes it jump again where it lands: every 2 v/g, and a little before it would reach the floor.
TEST(Characters, JumpAsHighAsTheirSpeedCarriesThem) {
  const auto run = started(on_a_floor, fast);
  ASSERT_TRUE(run->advance_to(1));
  const double floor = run->position(0)[1];
  ASSERT_TRUE(run->set(input(on_a_floor, 1), 1));
  double highest = 0;
  int landings = 0;
  for (double t = 1; t < 5;) {
    const double before = run->state().back();
    ASSERT_TRUE(run->advance_to(t += h));
    highest = std::max(highest, run->position(0)[1] - floor);
    landings += before == 0 && run->state().back() == 1 ? 1 : 0;
  }
  EXPECT_NEAR(highest, 16 / (2 * 9.81), 9.81 * h * h / 2 + 1e-9);
  EXPECT_EQ(landings, 4);  // of 0.815 s
}

TEST(Characters, GrowWithTheirParameterAndStandAgain) {
  const auto run = started(on_a_floor, fast);
  ASSERT_TRUE(run->advance_to(1));
  const auto height = program_of(on_a_floor)->model.parameters[0].variable;
  ASSERT_TRUE(run->set(height, 1.2));
  ASSERT_TRUE(run->advance_to(2));
  EXPECT_NEAR(run->position(0)[1], 0.6 + skin, skin);
  const Status fault = run->set(height, 0.5);
  EXPECT_THAT(fault.message, testing::HasSubstr("`hero`"));
  ASSERT_TRUE(run->advance_to(3));  // as before
  EXPECT_NEAR(run->position(0)[1], 0.6 + skin, skin);
}

TEST(Characters, GoOnFromWhereAnEventPutsThem) {
  const model::Run run = run_of(R"(
world {
  gravity (0, -9.81)
  mode fast step 1/128
  wall floor (0, 1) at 0
  character hero at (0, 0.9) walk 1
}
at 1 { hero.x := 5; hero.y := 10 }
at 3 { hero.y' := 4 }
run 0..4
check hero.x(0.5) = 0.5 within 1e-9
check hero.x after event 1 = 5 within 0
check hero.x(1.5) = 5.5 within 1e-9
check hero.y(1.5) = 10 - 9.81/2*0.25 within 1e-9
check hero.on_ground(1.5) = 0 within 0
check hero.on_ground before event 2 = 1 within 0
check hero.y(3.25) = 0.905 + 4*0.25 - 9.81/2*0.25^2 within 0.003
)");
  EXPECT_EQ(failed_checks(run), "");
}

/// A sensor to all others: a ball falls through it with the bits of a world without, and both meet.
TEST(Characters, PushNobody) {
  const auto text = [](const std::string& character) {
    return "world { gravity (0, -9.81)\n mode fast step 1/128\n wall floor (0, 1) at 0\n"
           "body stone at (0.1, 4) box (0.3, 0.3) angle 0.3\n" +
           character + " }\nrun 0..2\n";
  };
  const model::Run alone = run_of(text("")), both = run_of(text("character hero at (0, 0.9) walk 0.2"));
  for (const char* column : {"stone.x", "stone.y", "stone.angle"}) EXPECT_EQ(last(alone, column), last(both, column));
  std::size_t meetings = 0;
  for (const model::RecordedEvent& event : both.events)
    meetings += event.is_contact() && event.name.find("hero") != std::string::npos ? 1 : 0;
  EXPECT_GT(meetings, 0U);
}

/// The same boxes, walls and driven platform, and `walk` by hand after each step: the same bits.
template <int Dim>
void expect_walk_by_hand(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-4, 4), height(0.05, 0.9), speed(-3, 3);
  const auto at = [](double x, double up) {
    Vector<double, Dim> v;
    v[0] = x, v[Dim - 1] = up;
    return v;
  };
  const auto as_text = [](const Vector<double, Dim>& v) {
    std::string text;
    for (const double component : v.components) text += fmt::format("{}{}", text.empty() ? "(" : ", ", component);
    return text + ")";
  };
  std::string text = fmt::format("world {{ dimension {}\n gravity {}\n mode fast step 1/128\n wall {} at 0\n", Dim,
                                 as_text(at(0, -9.81)), as_text(at(0, 1)));
  World<double, Dim> world;
  world.gravity = at(0, -9.81);
  require(world.add_wall({.normal = at(0, 1)}));
  const auto add = [&](const Vector<double, Dim>& x, const Vector<double, Dim>& v, double size, bool is_driven) {
    Box<double, Dim> box;
    for (double& side : box.size.components) side = size;
    BodyDefinition<double, Dim> body{.shape = box, .position = x, .velocity = v, .mass = 2.0, .fixed = is_driven};
    body.traits.is_driven = is_driven;
    require(world.add(body));
    text += fmt::format(" body it[{}] at {} velocity {} box {} mass 2 {}\n", world.size(), as_text(x), as_text(v),
                        as_text(box.size), is_driven ? "driven" : "");
  };
  for (int k = 0; k < 8; ++k) {
    const double size = height(random);
    add(at(place(random), size / 2), {}, size, false);
  }
  add(at(0.1, -0.4), at(0.7, 0.3), 1.5, true);
  Vector<double, Dim> wish;
  for (std::size_t axis = 0; axis + 1 < Dim; ++axis) wish[axis] = speed(random);
  const std::string walk = Dim == 2 ? fmt::format("{}", wish[0]) : fmt::format("({}, {})", wish[0], wish[1]);
  text += fmt::format(" character hero at {} height 1.8 walk {} jump 3 }}\nrun 0..3\n", as_text(at(0, 3)), walk);

  const auto run = started(text, fast);
  FastMotion<double, Dim> motion(world, {.step = h});
  Character<double, Dim> hero{.position = at(0, 3) - at(0, 0.9)};
  const CharacterOptions<double> options{.steepest = 0.7853981633974483, .skin = 1.0 / 60 * 0.3};
  int steps_on_ground = 0;
  for (int k = 0; k < 256; ++k) {
    require(motion.advance());
    if (hero.is_on_ground) hero.rise = 3, ++steps_on_ground;
    hero = require(continuo::walk(world, Queries(world), hero, wish, h, options));
  }
  ASSERT_TRUE(run->advance_to(2));
  const Vector<double, Dim> centre = hero.position + at(0, 0.9);
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(run->position(i)[axis], world.position[i][axis]) << text;
    EXPECT_EQ(run->position(9)[axis], centre[axis]) << text;
  }
  EXPECT_EQ(run->state().back(), hero.is_on_ground ? 1 : 0);
  EXPECT_GT(steps_on_ground, 1) << text;
}
TEST(Characters, WalkAsByHandInRandomWorlds) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    expect_walk_by_hand<2>(seed);
    expect_walk_by_hand<3>(seed);
  }
}

/// At every instant of a walk with falls, jumps and a ride: what goes on from a snapshot has the same bits.
TEST(Characters, GoOnToTheSameBitsFromASnapshot) {
  const std::string text = R"(
world {
  dimension 3
  gravity (0, 0, -9.81)
  mode fast step 1/128
  wall floor (0, 0, 1) at 0
  body crate at (1.2, 0, 0.1) box (0.5, 0.5, 0.2)
  body turntable at (3, 0, 0.1) spin (0, 0, 1) box (2, 2, 0.2) driven
  character hero at (0, 0, 1.5) walk (if t < 2 then 1.5 else 0, 0.2*sin(5*t)) jump if t > 3 then 2 else 0
  character other at (0, 1, 0.95) walk (hero.x - other.x, 0)
}
run 0..4
)";
  const auto run = started(text, fast);
  for (int k = 1; k <= 16; ++k) {
    const Snapshot saved = run->snapshot();
    const auto again = started(text, fast);
    ASSERT_TRUE(again->check(saved));
    ASSERT_TRUE(again->restore(saved));
    ASSERT_TRUE(run->advance_to(0.25 * k));
    ASSERT_TRUE(again->advance_to(0.25 * k));
    EXPECT_EQ(run->state(), again->state()) << k;
  }
  EXPECT_GT(run->position(2)[0], 2);  // on the turntable
  Snapshot wrong = run->snapshot();
  wrong.characters[0] = std::nan("");
  EXPECT_FALSE(run->check(wrong));
  wrong = run->snapshot();
  wrong.characters.back() = -1;
  EXPECT_FALSE(run->check(wrong));
  wrong.characters.pop_back();
  EXPECT_FALSE(run->restore(wrong));
}

TEST(Characters, AWishThatIsNoNumberEndsTheRun) {
  const auto run =
      started("world { mode fast step 1/128\n character hero at (0, 1) walk sqrt(1 - t) }\nrun 0..4\n", fast);
  const Status status = run->advance_to(4);
  EXPECT_FALSE(status);
  EXPECT_THAT(status.message, testing::StartsWith("`hero`: "));
  EXPECT_NEAR(run->time(), 1, 2 * h);
}

}  // namespace
}  // namespace continuo::worlds::characters_test
