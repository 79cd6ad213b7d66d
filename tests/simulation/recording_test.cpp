// A run of equations that is recorded, broken off and resumed has the bits of the one without a break: random models of
// each kind, by each method of the catalogue that takes them, broken off after a random number of steps. A recording
// that was cut or changed is refused, and never anything worse.
#include <bit>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/integration_recording.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::model::recording_test {
namespace {

using Random = std::mt19937;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// Nonlinear, with a forcing, a guard that only marks, energies and checks at a time and along the run.
std::string forced_oscillator(Random& random) {
  return fmt::format(R"(param k = {}, c = {}, f = {}
x'' = -k*x - c*x' - 0.3*x^3 + f*cos(1.3*t)
z' = x - 0.1*z
x(0) = {}; x'(0) = 0.2; z(0) = 1
energy kinetic = 1/2*x'^2, potential = k/2*x^2
when x crosses 0.1 {{ mark "through" }}
check always x < 100
check x(1.5) < 100
run 0..6 output 0.11
)",
                     between(random, 0.5, 4), between(random, 0, 0.3), between(random, 0, 1), between(random, 0.5, 2));
}
/// x'' = a(x), all in pairs.
std::string orbit(Random& random) {
  return fmt::format(R"(param ecc = {}
let r = hypot(x, y)
x'' = -x/r^3
y'' = -y/r^3
x(0) = 1 - ecc; x'(0) = 0; y(0) = 0; y'(0) = sqrt((1 + ecc)/(1 - ecc))
when y crosses 0 {{ mark "apsis" }}
energy kinetic = 1/2*(x'^2 + y'^2), potential = -1/r
run 0..8
)",
                     between(random, 0, 0.6));
}
/// Becomes stiff and ceases to be, so that a switching method changes to and fro.
std::string relaxation(Random& random) {
  return fmt::format(R"(param mu = {}
x'' = mu*(1 - x^2)*x' - x
x(0) = 2; x'(0) = 0
run 0..{} output 0.5
)",
                     between(random, 5, 60), between(random, 10, 60));
}
/// A ball whose bounces accumulate, a schedule, a counter that no equation reads, modes.
std::string bounces(Random& random) {
  return fmt::format(R"(param g = {}, e = {}, dose = {}
mode flight {{ h'' = -g }}
mode rest {{ h'' = 0 }}
n' = 0
V' = -0.3*V
h(0) = 1; h'(0) = 0; n(0) = 0; V(0) = 1
when h falls through 0 in flight {{
  h := 0
  n := n + 1
  if -e*h' > 0.3 {{ h' := -e*h' }} else {{ h' := 0; go rest }}
}}
every 0.7 from 0.7 {{ V := V + dose; mark "dose" }}
check count of events > 3
run 0..6 output 0.13
)",
                     between(random, 5, 12), between(random, 0.5, 0.9), between(random, 0.1, 1));
}
/// Equations that jump: friction with sliding, steps of floor, a switch by the time.
std::string jumps(Random& random) {
  return fmt::format(R"(param mu = {}, push = {}
v' = push*sin(t) - mu*sign(v)
w' = floor(2*t)/5 - w
u' = if mod(t, 1.1) < 0.4 then 1 - u else -u
v(0) = {}; w(0) = 0; u(0) = 0
run 0..7 output 0.2
)",
                     between(random, 0.2, 1.2), between(random, 0.5, 2), between(random, -1, 1));
}
/// With algebraic equations, and guards on an unknown.
std::string circuit(Random& random) {
  return fmt::format(R"(param battery = {}, R = {}
unknown v = 0.6
let i = 1e-6*(exp(v/0.2) - 1)
q' = i - 0.1*q
0 = battery - q - R*i*1000 - v
q(0) = 0
when v falls through 0.9 {{ mark "low" }}
every 1.3 from 1.3 {{ q := q*0.9 }}
run 0..8 output 0.3
)",
                     between(random, 2, 5), between(random, 0.5, 3));
}
/// A band, of the Jacobian.
std::string rod(Random& random) {
  return fmt::format(R"(param N = 30, D = {}
for i in 1..N {{ u[i](0) = sin(3*i) }}
u[1]' = D*(-2*u[1] + u[2])*900
for i in 2..N-1 {{ u[i]' = D*(u[i-1] - 2*u[i] + u[i+1])*900 - u[i]^3 }}
u[N]' = D*(u[N-1] - 2*u[N])*900
when u[10] falls through 0.05 {{ mark "cold" }}
run 0..0.3 output 0.01
)",
                     between(random, 0.2, 2));
}
/// Sparse without a band, with a state on which all others depend.
std::string star(Random& random) {
  return fmt::format(R"(param N = 40, k = {}
for i in 1..N {{ u[i](0) = cos(i) }}
m(0) = 0.3
for i in 1..N {{ u[i]' = -k*i*(u[i] - m) + 0.1*u[i]^2 }}
m' = sum(i in 1..N: u[i])/N - 2*m + 0.2*sin(3*t)
run 0..3 output 0.1
)",
                     between(random, 0.5, 5));
}
/// Pairs that are coupled along a line, for the methods of structural dynamics.
std::string beads(Random& random) {
  return fmt::format(R"(param N = 12, k = {}, c = {}
for i in 1..N {{ x[i](0) = sin(i); x[i]'(0) = 0 }}
x[1]'' = k*(-2*x[1] + x[2]) - c*x[1]'
for i in 2..N-1 {{ x[i]'' = k*(x[i-1] - 2*x[i] + x[i+1]) - c*x[i]' - 0.1*x[i]^3 }}
x[N]'' = k*(x[N-1] - 2*x[N]) - c*x[N]'
when x[3] crosses 0 {{ mark "zero" }}
run 0..4 output 0.2
)",
                     between(random, 1, 30), between(random, 0, 0.5));
}

using Maker = std::string (*)(Random&);
constexpr Maker makers[] = {forced_oscillator, orbit, relaxation, bounces, jumps, circuit, rod, star, beads};

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(bits(a[i]), bits(b[i])) << what << ' ' << i;
}

/// All that a run has but the time that it took.
void expect_same(const Run& a, const Run& b) {
  expect_same(a.motion.values, b.motion.values, "rows");
  expect_same(a.total_energy, b.total_energy, "energies");
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    ASSERT_EQ(a.events[i].name, b.events[i].name);
    ASSERT_EQ(a.events[i].mark, b.events[i].mark);
    ASSERT_EQ(bits(a.events[i].t), bits(b.events[i].t));
    expect_same(a.events[i].before, b.events[i].before, "before an event");
    expect_same(a.events[i].after, b.events[i].after, "after an event");
  }
  ASSERT_EQ(a.outcome.ending, b.outcome.ending);
  ASSERT_EQ(bits(a.outcome.t), bits(b.outcome.t));
  ASSERT_EQ(a.outcome.hint, b.outcome.hint);
  ASSERT_EQ(a.energy.has_value(), b.energy.has_value());
  if (a.energy) {
    ASSERT_EQ(bits(a.energy->drift), bits(b.energy->drift));
  }
  ASSERT_EQ(a.checks.size(), b.checks.size());
  for (std::size_t i = 0; i < a.checks.size(); ++i) ASSERT_EQ(bits(a.checks[i].value), bits(b.checks[i].value));
  ASSERT_EQ(a.statistics.steps, b.statistics.steps);
  ASSERT_EQ(a.statistics.rejected, b.statistics.rejected);
  ASSERT_EQ(a.statistics.jacobians, b.statistics.jacobians);
  ASSERT_EQ(a.statistics.factorizations, b.statistics.factorizations);
}

Bytes bytes_of(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

struct Recorded {
  Simulated simulated;
  Bytes bytes;
};
Recorded record(const std::shared_ptr<const ModelProgram>& program, const Experiment& experiment,
                std::size_t checkpoints = 20) {
  std::ostringstream file;
  RunHead head;
  head.experiment = experiment;
  IntegrationLog log(file, head, checkpoints);
  Simulated simulated = simulate(program, experiment, {.log = &log});
  return {std::move(simulated), bytes_of(file.str())};
}

/// By the method and a tolerance, or a step where it estimates no error.
Experiment by_method(const MethodInfo& method, Random& random, bool fixed) {
  Experiment experiment;
  experiment.method = std::string(method.name);
  if (method.error_order == 0 || fixed) {
    experiment.step = between(random, 0.004, 0.02);
  } else {
    experiment.rtol = method.order < 2 ? 0.1 : method.order < 3 ? 1e-2 : 1e-6;
  }
  experiment.doubts = method.order > 3;  // for the others another run is a long one
  experiment.output_steps = std::bernoulli_distribution(0.3)(random);
  return experiment;
}

void expect_resumes(const std::string& text, const Experiment& experiment, Random& random) {
  const Loaded loaded = load(Source("random.sim", text));
  ASSERT_TRUE(loaded) << loaded.text() << text;
  const auto program = compile(*loaded.model);
  const Simulated whole = simulate(program, experiment);
  if (!whole.run) return;  // the method is not for this model
  const Recorded recorded = record(program, experiment);
  ASSERT_TRUE(recorded.simulated.run);
  ASSERT_NO_FATAL_FAILURE(expect_same(*whole.run, *recorded.simulated.run));
  const Result<IntegrationRecording> recording = IntegrationRecording::read(recorded.bytes);
  ASSERT_TRUE(recording) << recording.status().message;
  ASSERT_FALSE(recording->checkpoints.empty());
  const Simulated replayed = replay_integration(program, *recording);
  ASSERT_TRUE(replayed.run);
  ASSERT_NO_FATAL_FAILURE(expect_same(*whole.run, *replayed.run));
  for (int tries = 0; tries < 3; ++tries) {
    const std::size_t k = std::uniform_int_distribution<std::size_t>(0, recording->checkpoints.size() - 1)(random);
    const Simulated resumed = resume_integration(program, *recording, k);
    ASSERT_TRUE(resumed.run) << "from checkpoint " << k << ": " << resumed.diagnostics.front().label;
    ASSERT_NO_FATAL_FAILURE(expect_same(*whole.run, *resumed.run)) << "from checkpoint " << k;
  }
  // Broken off after some steps, and once more on the rest of the way.
  const std::size_t all = whole.run->statistics.steps + whole.run->statistics.rejected;
  if (all < 3) return;
  Experiment broken_off = experiment;
  broken_off.max_steps = std::uniform_int_distribution<std::size_t>(1, all - 1)(random);
  const Recorded first = record(program, broken_off, 1);
  const Result<IntegrationRecording> part = IntegrationRecording::read(first.bytes);
  ASSERT_TRUE(part) << part.status().message;
  std::ostringstream second;
  IntegrationLog log(second, part->head, 1);
  const std::size_t further = std::uniform_int_distribution<std::size_t>(*broken_off.max_steps, all)(random);
  const Simulated middle =
      resume_integration(program, *part, part->checkpoints.size() - 1, {.max_steps = further}, &log);
  ASSERT_TRUE(middle.run);
  const Result<IntegrationRecording> rest = IntegrationRecording::read(bytes_of(second.str()));
  ASSERT_TRUE(rest) << rest.status().message;
  const Simulated resumed =
      resume_integration(program, *rest, rest->checkpoints.size() - 1, {.max_steps = usual_max_steps});
  ASSERT_TRUE(resumed.run);
  ASSERT_NO_FATAL_FAILURE(expect_same(*whole.run, *resumed.run))
      << "broken off after " << *broken_off.max_steps << " and " << further << " of " << all << " steps";
}

class RecordingByMethod : public testing::TestWithParam<std::string> {};

TEST_P(RecordingByMethod, ResumesToTheSameBits) {
  const MethodInfo& method = *find_method(GetParam());
  Random random(static_cast<unsigned>(std::hash<std::string>{}(GetParam())));
  for (const Maker maker : makers) {
    const std::string text = maker(random);
    for (const bool fixed : {false, true}) {
      if (fixed && method.error_order == 0) continue;
      const Experiment experiment = by_method(method, random, fixed);
      SCOPED_TRACE(text + "method " + GetParam() + (experiment.step ? fmt::format(" step {}", *experiment.step) : ""));
      ASSERT_NO_FATAL_FAILURE(expect_resumes(text, experiment, random));
    }
  }
}

std::vector<std::string> catalogued_methods() {
  std::vector<std::string> names;
  for (const MethodInfo& method : method_catalogue()) names.emplace_back(method.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Methods, RecordingByMethod, testing::ValuesIn(catalogued_methods()),
                         [](const auto& name) { return name.param; });

TEST(Recording, ResumesBeyondItsEndAsTheLongerRunGoes) {
  Random random(7);
  const Loaded loaded = load(Source("orbit.sim", orbit(random)));
  const auto program = compile(*loaded.model);
  const Result<IntegrationRecording> recording = IntegrationRecording::read(record(program, {}).bytes);
  ASSERT_TRUE(recording);
  const Simulated longer = simulate(program, {.to = 20});
  const Simulated resumed = resume_integration(program, *recording, recording->checkpoints.size() - 1, {.to = 20});
  ASSERT_TRUE(resumed.run);
  expect_same(*longer.run, *resumed.run);
}

TEST(Recording, IsRefusedWhereItWasChanged) {
  Random random(11);
  const Loaded loaded = load(Source("bounces.sim", bounces(random)));
  const auto program = compile(*loaded.model);
  const Bytes whole = record(program, {.method = "dop853_radau", .rtol = 1e-6}, 5).bytes;
  for (int tries = 0; tries < 300; ++tries) {
    Bytes bytes = whole;
    const std::size_t at = std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random);
    bytes[at] ^= static_cast<std::byte>(std::uniform_int_distribution(1, 255)(random));
    const Result<IntegrationRecording> recording = IntegrationRecording::read(bytes);
    // What is left of a file that was cut off is used; a change of one byte may make a block seem to reach beyond it.
    if (recording) {
      EXPECT_FALSE(recording->end) << "byte " << at;
    }
  }
  for (int tries = 0; tries < 100; ++tries) {
    const std::size_t size = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    const Result<IntegrationRecording> recording = IntegrationRecording::read(std::span(whole).first(size));
    if (recording) {
      EXPECT_TRUE(replay_integration(program, *recording).run);
    }
  }
}

/// The bytes of a checkpoint are right by their checksum, and still not those of the integration.
TEST(Recording, RefusesACheckpointOfAnotherIntegration) {
  Random random(13);
  for (const char* method : {"dop853_radau", "bdf", "adams", "radau", "seulex", "kvaerno5", "tsitouras5_rodas5p"}) {
    const Loaded loaded = load(Source("bounces.sim", bounces(random)));
    const auto program = compile(*loaded.model);
    Experiment experiment{.method = method, .rtol = 1e-4};
    experiment.max_steps = 20'000;
    Result<IntegrationRecording> recording = IntegrationRecording::read(record(program, experiment, 5).bytes);
    ASSERT_TRUE(recording);
    for (int tries = 0; tries < 60; ++tries) {
      IntegrationRecording changed = *recording;
      Bytes& state = changed.checkpoints[2].state;
      const std::size_t at = std::uniform_int_distribution<std::size_t>(0, state.size() - 1)(random);
      if (tries % 3 == 0) {
        state.resize(at);
      } else {
        state[at] ^= static_cast<std::byte>(std::uniform_int_distribution(1, 255)(random));
      }
      const Simulated resumed = resume_integration(program, changed, 2);  // refused, or another run: no crash
      if (tries % 3 == 0) {
        EXPECT_FALSE(resumed.run);
      }
    }
  }
}

}  // namespace
}  // namespace continuo::model::recording_test
