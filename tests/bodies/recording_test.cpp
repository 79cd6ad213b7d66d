// Recordings of runs: they are read back exactly as written, and wrong or truncated files are reported.
#include <cstddef>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/recording.hpp>

namespace continuo::recording_test {
namespace {

Bytes bytes_of(const std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// Ten frames of balls that fall; before the sixth one comes.
std::string run(std::vector<World<double, 2>>& seen, bool finishes) {
  std::ostringstream out;
  Recorder<double, 2> recorder(out);
  World<double, 2> world;
  world.gravity = {{0, -10}};
  EXPECT_TRUE(world.add_wall({}));
  EXPECT_TRUE(world.add({.position = {{0, 1}}, .spin = {{2}}}));
  for (int k = 0; k < 10; ++k) {
    if (k == 5) {
      EXPECT_TRUE(world.add({.position = {{3, 1}}}));
    }
    ExactMotion motion(world);
    EXPECT_TRUE(motion.advance_to(0.1 * k));
    recorder.add(world);
    seen.push_back(world);
  }
  if (finishes) recorder.finish();
  return out.str();
}

TEST(Recording, IsWhatWasSeen) {
  std::vector<World<double, 2>> seen;
  const auto recording = Recording<double, 2>::read(bytes_of(run(seen, true)));
  ASSERT_TRUE(recording) << describe(recording.status());
  EXPECT_TRUE(recording->is_whole);
  ASSERT_EQ(recording->frames.size(), seen.size());
  ASSERT_EQ(recording->scenes.size(), 2u);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    EXPECT_EQ(recording->frame(k).time, seen[k].time);
    EXPECT_EQ(recording->frame(k).position, seen[k].position);
    EXPECT_EQ(recording->frame(k).orientation, seen[k].orientation);
    EXPECT_EQ(recording->scenes[recording->frame(k).scene].radius, seen[k].radius);
  }
  EXPECT_EQ(recording->at(0.25).time, seen[2].time);
  EXPECT_EQ(recording->at(-1).time, seen[0].time);
  EXPECT_EQ(recording->at(99).time, seen[9].time);
}

TEST(Recording, CutOffIsReadAsFarAsItGoes) {
  std::vector<World<double, 2>> seen;
  std::string text = run(seen, false);
  const auto all = Recording<double, 2>::read(bytes_of(text));
  ASSERT_TRUE(all) << describe(all.status());
  EXPECT_FALSE(all->is_whole);
  EXPECT_EQ(all->frames.size(), 10u);
  text.resize(text.size() - 5);
  EXPECT_EQ((Recording<double, 2>::read(bytes_of(text))->frames.size()), 9u);
}

TEST(Recording, CorruptBytesAreTold) {
  std::vector<World<double, 2>> seen;
  const Bytes bytes = bytes_of(run(seen, true));
  EXPECT_EQ((Recording<double, 3>::read(bytes).status().ending), Ending::unreadable);
  EXPECT_EQ((Recording<double, 2>::read({}).status().ending), Ending::unreadable);
  std::mt19937 engine(1);
  for (int k = 0; k < 200; ++k) {
    Bytes wrong = bytes;
    wrong[engine() % wrong.size()] ^= static_cast<std::byte>(1 + engine() % 255);
    const auto recording = Recording<double, 2>::read(wrong);
    // A size that is too large now reads as a file cut off; all else is found.
    EXPECT_TRUE(recording ? !recording->is_whole : recording.status().message.starts_with("byte "));
  }
}

}  // namespace
}  // namespace continuo::recording_test
