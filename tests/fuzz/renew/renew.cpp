// Writes anew what the fuzzers of snapshots and recordings start from, where the format has changed; not part of any
// build unless asked for:
//
//   cmake --build build --target renew_fuzz_inputs && build/tests/fuzz/renew_fuzz_inputs tests/fuzz
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <tests/fuzz/recorded_models.hpp>

#include <continuo/bodies/recording.hpp>
#include <continuo/bodies/snapshot.hpp>
#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/runs/recording.hpp>
#include <continuo/runs/run.hpp>

namespace {

using namespace continuo;

bool write(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) std::fprintf(stderr, "cannot write %s\n", path.c_str());
  return static_cast<bool>(file);
}

/// A few balls over a floor: a fixed one, a spring, groups, and an unused handle.
template <class Real, int Dim>
World<Real, Dim> few(bool has_spring) {
  World<Real, Dim> world;
  constexpr std::size_t up = Dim - 1;
  world.gravity[up] = Real(-9.81);
  Wall<Real, Dim> floor{.material = {.restitution = Real(0.3), .friction = Real(0.4)}};
  (void)world.add_wall(floor);
  BodyHandle last{};
  for (int i = 0; i < 5; ++i) {
    BodyDefinition<Real, Dim> ball{.shape = Sphere<Real>{Real(0.3) + Real(0.05) * Real(i)}};
    ball.position[0] = Real(i % 2) * Real(0.9);
    ball.position[up] = Real(0.6) + Real(i / 2);
    ball.velocity[0] = Real(0.3) * Real(i - 2);
    ball.spin[0] = Real(1);
    ball.material = {.restitution = Real(i % 3) / 4, .friction = Real(0.4), .rolling_resistance = Real(i % 2) / 50};
    ball.fixed = i == 4;
    ball.group = static_cast<std::uint32_t>(i % 2);
    const auto added = world.add(ball);
    if (i == 1) world.remove(last);
    last = *added;
  }
  if (has_spring) world.springs.push_back({.a = last, .b = Vector<Real, Dim>{}, .rest_length = 1, .stiffness = 3});
  return world;
}

template <class Real, int Dim>
Bytes exact(const Real& t, bool has_spring) {
  World<Real, Dim> world = few<Real, Dim>(has_spring);
  ExactMotion<Real, Dim> motion(world, {.contact_events = 10});
  (void)motion.advance_to(t);
  return snapshot(world, motion);
}
template <class Real, int Dim>
Bytes fast() {
  World<Real, Dim> world = few<Real, Dim>(true);
  HeightField<Real, Dim> field;
  field.counts.fill(3);
  field.heights.assign(Dim == 2 ? 3 : 9, Real(0.1));
  (void)world.add_mesh({.shape = field});
  if constexpr (Dim == 2) {
    (void)world.add_mesh({.shape = Chain<Real>{.points = {{{2, 0}}, {{0, 0}}}, .after = {{{-1, 0}}}}});
  } else {
    (void)world.add_mesh({.shape = TriangleMesh<Real>{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}, {{0, 1, 2}}}});
  }
  FastMotion<Real, Dim> motion(world, {.contact_events = 10});
  for (int k = 0; k < 40; ++k) (void)motion.advance();
  return snapshot(world, motion);
}

bool renew_snapshots(const std::filesystem::path& folder) {
  return write(folder / "world", snapshot(few<double, 3>(true))) &&
         write(folder / "exact", exact<double, 3>(0.1, false)) &&
         write(folder / "exact_flat", exact<float, 2>(0.1F, false)) &&
         write(folder / "exact_heap", exact<double, 3>(0.6, true)) &&
         write(folder / "exact_islands", exact<double, 3>(0.6, false)) && write(folder / "fast", fast<double, 3>()) &&
         write(folder / "fast_flat", fast<float, 2>());
}

/// Without its conditions: a run notes all states a thousand times for those, too much to start from.
std::string without_conditions(const std::string& text) {
  const std::size_t from = text.find("\nwhen ");
  return from == std::string::npos ? text : text.substr(0, from) + text.substr(text.find('\n', from + 1));
}

bool renew_run(const std::filesystem::path& folder, const RecordedModel& each) {
  const model::Source source("scene.sim", each.text);
  model::Checked checked = check(model::parse(source).model, source);
  if (!checked.model) return false;
  const auto program = model::compile(std::move(*checked.model));
  std::ostringstream file;
  model::RunHead head;
  head.file = std::string(each.name) + ".sim";
  head.text = each.text;
  runs::Log log(file, program->model, head, 3);
  return runs::run(program, {}, {.log = &log}).run &&
         write(folder / each.name, std::as_bytes(std::span(std::string_view(file.view()))));
}

bool renew_recordings(const std::filesystem::path& folder) {
  std::ostringstream bodies;
  Recorder<double, 3> recorder(bodies);
  World<double, 3> world = few<double, 3>(false);
  FastMotion<double, 3> motion(world);
  for (int k = 0; k < 10; ++k) {
    recorder.add(world);
    (void)motion.advance();
  }
  recorder.finish();
  return write(folder / "bodies", std::as_bytes(std::span(std::string_view(bodies.view())))) &&
         std::ranges::all_of(recorded_models,
                             [&](const RecordedModel& each) {
                               return renew_run(folder,
                                                {.name = each.name, .text = without_conditions(each.text).c_str()});
                             }) &&
         std::ranges::all_of(recorded_equations, [&](const RecordedModel& each) { return renew_run(folder, each); });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "the folder tests/fuzz is wanted\n"), 2;
  const std::filesystem::path folder(arguments[1]);
  return renew_snapshots(folder / "snapshot") && renew_recordings(folder / "recording") ? 0 : 1;
}
