// Recorded runs: replayed they are the same runs, resumed they reach the same bits; truncated or changed ones give
// their intact part or are refused.
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <tests/fuzz/right_sums.hpp>
#include <tests/worlds/scene.hpp>

#include <continuo/worlds/run_log.hpp>

namespace continuo::worlds::run_log_test {
namespace {

Bytes bytes_of(const std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// Discs in a box, with equations and events of every kind: the complete state of a run.
const std::string scene = R"(
param g = 10
world {
  gravity (0, -g)
  container box (0, 0) to (8, 40)
  material restitution 0.7 friction 0.2
  bodies gas random 8 in (0, 5) to (8, 20) speed 3 seed 2
  body ball at (4, 2) velocity (1, 0)
}
)";
const std::string with_equations = R"(
force on ball = (-2*(ball.x - u), 0.1*sin(t))
torque on ball = -0.01*ball.angle'
u' = ball.x - u
u(0) = 1
when ball.x crosses 4 { mark "over"; u := u + 0.01 }
)";
const std::string with_events = R"(
when gas[1].y falls through 3 { mark "low" }
every 0.1 { ball.x' := ball.x' + 0.01 }
at 0.55 { ball.y' := 3 }
initially { ball.x' := 2 }
output height = distance(ball, box)
check always world.kinetic > 0
check ball.y(1.25) = 5 within 100
check energy drift < 1000
run 0..2 output 0.05
)";
struct Case {
  const char* name;
  std::string text;
};
std::vector<Case> cases() {
  std::string stepped = scene;
  stepped.insert(stepped.find("  container"), "  mode fast step 1/120\n");
  std::string walked = stepped;
  walked.insert(walked.find("  bodies gas"), "  character hero at (2, 1) walk 0.5\n");
  return {{"exact", scene + with_events},
          {"fast", stepped + with_events},
          {"fast with equations", stepped + with_equations + "run 0..1.5 output 0.05\n"},
          {"fast with a character", walked + with_events},
          {"exact with equations", R"(
world { body ball at (4, 2) velocity (1, 0); body other at (7, 2); wall (0, 1) at 0
  spring ball to (0, 3) stiffness 5; gravity (0, -2) }
)" + with_equations + "run 0..1.5 output 0.05\n"}};
}

struct Recorded {
  std::shared_ptr<const model::ModelProgram> program;
  model::Run run;
  std::string file;
};
Recorded recorded(const std::string& text, std::size_t checkpoints = 10) {
  Recorded made{program_of(text), {}, {}};
  std::ostringstream file;
  RunLog log(file, {.file = "scene.sim", .text = text}, checkpoints);
  model::Simulated simulated = simulate_world(made.program, {}, &log);
  EXPECT_TRUE(simulated.run);
  made.run = std::move(*simulated.run);
  made.file = file.str();
  return made;
}

/// Equal to the last bit, except for the run time.
void expect_same(const model::Run& a, const model::Run& b, const std::string& what) {
  EXPECT_EQ(a.motion.values, b.motion.values) << what;
  EXPECT_EQ(a.total_energy, b.total_energy) << what;
  ASSERT_EQ(a.events.size(), b.events.size()) << what;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].name, b.events[i].name) << what;
    EXPECT_EQ(a.events[i].t, b.events[i].t) << what;
    EXPECT_EQ(a.events[i].after, b.events[i].after) << what;
    EXPECT_EQ(a.events[i].impulse, b.events[i].impulse) << what;
  }
  ASSERT_EQ(a.checks.size(), b.checks.size());
  for (std::size_t i = 0; i < a.checks.size(); ++i) EXPECT_EQ(a.checks[i].value, b.checks[i].value) << what;
  EXPECT_EQ(a.outcome.ending, b.outcome.ending) << what;
  EXPECT_EQ(a.outcome.t, b.outcome.t) << what;
  if (a.energy) {
    EXPECT_EQ(a.energy->drift, b.energy->drift) << what;
  }
}

TEST(RunLog, IsTheSameRunAgain) {
  for (const Case& each : cases()) {
    const Recorded made = recorded(each.text);
    EXPECT_GT(made.run.events.size(), 3U) << each.name;
    expect_same(made.run, run_of(each.text), each.name);  // recording does not change the run
    const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file));
    ASSERT_TRUE(recording) << describe(recording.status());
    EXPECT_EQ(recording->head.text, each.text);
    const model::Simulated again = replay_world(made.program, *recording);
    ASSERT_TRUE(again.run) << each.name;
    expect_same(made.run, *again.run, each.name);
  }
}

TEST(RunLog, GoesOnToTheSameBits) {
  for (const Case& each : cases()) {
    // At every step; of these each twelfth, after 0.1, the scheduled events among them: some are off by rounding.
    const Recorded made = recorded(each.text, 400);
    const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file));
    ASSERT_GE(recording->checkpoints.size(), 20U) << each.name;
    for (std::size_t k = 0; k < recording->checkpoints.size(); k += recording->checkpoints.size() > 50 ? 12 : 1) {
      std::ostringstream file;
      RunLog log(file, recording->head, 400);
      const model::Simulated on = resume_world(made.program, *recording, k, {}, &log);
      const std::string what = each.name + (" from checkpoint " + std::to_string(k));
      ASSERT_TRUE(on.run) << what;
      expect_same(made.run, *on.run, what);
      // The recording of the resumed run is a complete run, too.
      const Result<RunRecording> longer = RunRecording::read(bytes_of(file.str()));
      ASSERT_TRUE(longer) << describe(longer.status());
      EXPECT_GE(longer->checkpoints.size(), recording->checkpoints.size()) << what;
      expect_same(made.run, *replay_world(made.program, *longer).run, what);
    }
  }
}

TEST(RunLog, GoesOnBeyondItsEnd) {
  const auto text = [](const char* end) {
    std::string made = cases()[1].text;
    return made.replace(made.find("0..2 "), 5, std::string("0..") + end + " ");
  };
  const Recorded made = recorded(text("2"));
  const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file));
  const model::Simulated on = resume_world(made.program, *recording, recording->checkpoints.size() - 1, {.to = 3});
  ASSERT_TRUE(on.run);
  expect_same(run_of(text("3")), *on.run, "beyond");
  EXPECT_EQ(recording->checkpoint_at(0.01), 0U);
  EXPECT_EQ(recording->checkpoint_at(100), recording->checkpoints.size() - 1);
}

// A recording truncated anywhere is a shorter run, or none, and can be resumed to the original end.
TEST(RunLog, MayBeCutOffAnywhere) {
  const Recorded made = recorded(cases()[0].text, 5);
  std::size_t usable = 0;
  for (std::size_t size = 0; size < made.file.size(); size += 1 + size / 100) {
    const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file.substr(0, size)));
    if (!recording) {
      EXPECT_EQ(recording.status().ending, Ending::unreadable);
      EXPECT_TRUE(recording.status().message.starts_with("byte ")) << recording.status().message;
      continue;
    }
    EXPECT_FALSE(recording->end);
    const model::Simulated again = replay_world(made.program, *recording);
    ASSERT_TRUE(again.run);
    EXPECT_EQ(again.run->outcome.ending, Ending::interrupted);
    ASSERT_LE(again.run->motion.values.size(), made.run.motion.values.size());
    EXPECT_TRUE(std::ranges::equal(again.run->motion.values,
                                   std::span(made.run.motion.values).first(again.run->motion.values.size())));
    if (recording->checkpoints.empty() || ++usable % 10 != 0) continue;
    const model::Simulated on = resume_world(made.program, *recording, recording->checkpoints.size() - 1);
    ASSERT_TRUE(on.run);
    expect_same(made.run, *on.run, "cut off after " + std::to_string(size));
  }
  EXPECT_GT(usable, 50U);
}

std::string with_right_sums(std::string file) {
  constexpr std::size_t head = 12;
  put_sums_right(std::as_writable_bytes(std::span(file)), head, [](std::uint8_t, std::span<std::byte>) {});
  return file;
}

TEST(RunLog, IsRefusedWhereItIsWrong) {
  const Recorded made = recorded(cases()[2].text, 5);
  ASSERT_EQ(with_right_sums(made.file), made.file);
  std::mt19937 engine(7);
  std::size_t refused = 0, taken = 0;
  for (int k = 0; k < 600; ++k) {
    std::string wrong = made.file;
    const bool is_mended = k % 2 == 1;
    for (int n = 0; n < 1 + k % 3; ++n) {
      // Half of the changes are near the beginning, where sizes and kinds are.
      const std::size_t at = engine() % (k % 4 < 2 ? wrong.size() : std::min<std::size_t>(wrong.size(), 4000));
      wrong[at] = static_cast<char>(static_cast<unsigned char>(wrong[at]) ^ (1 + engine() % 255));
    }
    if (is_mended) wrong = with_right_sums(wrong);
    const Result<RunRecording> recording = RunRecording::read(bytes_of(wrong));
    if (!recording) {
      EXPECT_EQ(recording.status().ending, Ending::unreadable);
      EXPECT_TRUE(recording.status().message.starts_with("byte ")) << recording.status().message;
      ++refused;
      continue;
    }
    ++taken;
    EXPECT_TRUE(is_mended || !recording->end) << "a changed byte was not seen";  // a changed size looks truncated
    for (const model::Simulated& simulated :
         {replay_world(made.program, *recording),
          recording->checkpoints.empty()
              ? model::Simulated{}
              : resume_world(made.program, *recording, engine() % recording->checkpoints.size(), {.to = 1.5})})
      EXPECT_TRUE(simulated.run || recording->checkpoints.empty() || has_errors(simulated.diagnostics));
  }
  EXPECT_GT(refused, 100U);
  EXPECT_GT(taken, 50U);
}

TEST(RunLog, OfAnotherModelIsRefused) {
  const Recorded made = recorded(cases()[0].text);
  const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file));
  const auto other = program_of("world { body ball at (0, 0) }\nrun 0..1\n");
  for (const model::Simulated& simulated : {replay_world(other, *recording), resume_world(other, *recording, 0)}) {
    EXPECT_FALSE(simulated.run);
    ASSERT_EQ(simulated.diagnostics.size(), 1U);
    EXPECT_EQ(simulated.diagnostics[0].code, "E325");
  }
}

// Wrong contents with right checksums: more bodies than the model has (their states were once written beyond the end of
// the array), and steps that began so early that no number of them reaches the end.
TEST(RunLog, DoesNotGoOnFromPlacesThatAreNoneOfItsRun) {
  const Recorded made = recorded(cases()[2].text, 5);
  const Result<RunRecording> recording = RunRecording::read(bytes_of(made.file));
  const std::size_t last = recording->checkpoints.size() - 1;
  const auto more_bodies = [] {
    std::string text = cases()[2].text;
    text.replace(text.find("random 8"), 8, "random 9");
    return *RunRecording::read(bytes_of(recorded(text, 5).file));
  }();
  const auto expect_refused = [&](auto&& change, const std::string& why) {
    RunRecording wrong = *recording;
    change(wrong.checkpoints[last].world);
    const model::Simulated on = resume_world(made.program, wrong, last, {.to = 1.6});
    EXPECT_FALSE(on.run) << why;
    ASSERT_EQ(on.diagnostics.size(), 1U) << why;
    EXPECT_EQ(on.diagnostics[0].code, "E325");
    EXPECT_NE(on.diagnostics[0].label.find(why), std::string::npos) << on.diagnostics[0].label;
  };
  expect_refused([&](Snapshot& world) { world.bodies = more_bodies.checkpoints[last].world.bodies; }, "other bodies");
  expect_refused([&](Snapshot& world) { world.bodies = recording->checkpoints[0].world.bodies; }, "another time");
  expect_refused([](Snapshot& world) { world.start = -1e300; }, "none of its steps");
  expect_refused([](Snapshot& world) { world.steps += 5; }, "none of its steps");
  expect_refused([](Snapshot& world) { world.equations[0] = std::nan(""); }, "not finite");
}

}  // namespace
}  // namespace continuo::worlds::run_log_test
