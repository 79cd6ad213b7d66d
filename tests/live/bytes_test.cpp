// The bytes of the protocol, as a client reads them.
#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <continuo/live/server/frames.hpp>
#include <continuo/live/server/gzip.hpp>
#include <continuo/live/server/row_log.hpp>
#include <continuo/live/session/commands.hpp>

namespace continuo::live {
namespace {

std::string hex(std::string_view bytes) {
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

Slice slice_at(double t, std::vector<double> rows) {
  Slice slice;
  slice.run = 3;
  slice.t = t;
  slice.reached = 1;
  slice.target = 2;
  for (const double row : rows) {
    slice.rows.push_back(static_cast<float>(row));
    slice.rows.push_back(-1);
    slice.ghost_rows.push_back(0);
    slice.ghost_rows.push_back(0);
  }
  slice.row_t = std::move(rows);
  slice.scene = {0.5F};
  return slice;
}

// The expected bytes are written by hand from docs/protocol.md: IEEE 754, little endian.
TEST(LiveFrames, AreTheBytesOfTheProtocol) {
  const Slice slice = slice_at(1.5, {1.5});
  EXPECT_EQ(hex(frame_of(slice, {slice.row_t, slice.rows, {}}, false)),
            "01000000"
            "03000000"
            "00000000"
            "01000000"  // kind, run, flags, rows
            "000000000000f83f"
            "000000000000f03f"
            "0000000000000040"  // t, reached, target
            "000000000000f83f"
            "0000c03f"
            "000080bf"    // the row: t, two columns
            "0000003f");  // the scene
}

TEST(LiveFrames, OfGhostsAndBodies) {
  Slice slice = slice_at(1.5, {1.5});
  slice.ghost = true;
  slice.looking_back = true;
  slice.ghost_scene = {2};
  auto bodies = std::make_shared<Bodies>();
  bodies->dimension = 2;
  bodies->position = {1, 2};
  bodies->orientation = {0};
  slice.bodies = bodies;
  EXPECT_EQ(hex(frame_of(slice, {slice.row_t, slice.rows, slice.ghost_rows}, true)),
            "01000000"
            "03000000"
            "1f000000"
            "01000000"
            "000000000000f83f"
            "000000000000f03f"
            "0000000000000040"
            "000000000000f83f"
            "0000c03f"
            "000080bf"
            "0000003f"
            "00000000"
            "00000000"
            "00000040"  // the ghost's row and scene
            "01000000"
            "0000803f"
            "00000040"
            "00000000");  // bodies: count, position, angle
}

TEST(LiveFrames, OfAGhostsBodiesAndOfTrails) {
  Slice slice = slice_at(1.5, {1.5});
  slice.ghost = true;
  slice.ghost_scene = {2};
  Bodies bodies;
  bodies.dimension = 2;
  bodies.position = {1, 2};
  bodies.orientation = {0};
  slice.bodies = std::make_shared<Bodies>(bodies);
  bodies.position = {0.5, 2};
  bodies.orientation = {1};
  slice.ghost_bodies = std::make_shared<Bodies>(bodies);
  slice.paths = {1, 0.5};
  slice.ghost_paths = {2, 0.5};
  const std::string frame =
      hex(frame_of(slice, {slice.row_t, slice.rows, slice.ghost_rows, slice.paths, slice.ghost_paths}, false));
  EXPECT_EQ(frame.substr(16, 8), "6e000000");  // ghost, bodies, how they stand, the ghost's, trails
  const std::string end =
      "01000000"
      "0000803f"
      "00000040"
      "00000000"  // bodies: count, position, angle
      "0000003f"
      "00000040"
      "0000803f"  // the ghost's: position, angle
      "0000803f"
      "0000003f"  // where the trail was at the row's time
      "00000040"
      "0000003f";  // the ghost's
  EXPECT_EQ(frame.substr(frame.size() - end.size()), end);
}

struct Read {
  std::uint32_t flags, rows;
  std::vector<double> t;
};
Read read_frame(const std::string& bytes) {
  Read read{};
  std::memcpy(&read.flags, bytes.data() + 8, 4);
  std::memcpy(&read.rows, bytes.data() + 12, 4);
  read.t.resize(read.rows);
  if (read.rows > 0) std::memcpy(read.t.data(), bytes.data() + 40, 8 * read.rows);
  return read;
}

TEST(LiveRows, EachClientGetsWhatItHasNotHad) {
  RowLog log;
  ReadMark a, b;
  log.add(std::make_shared<Slice>(slice_at(1, {0.5, 1})), {&a, &b});
  EXPECT_EQ(read_frame(*log.frame(a)).t, (std::vector<double>{0.5, 1}));
  log.add(std::make_shared<Slice>(slice_at(2, {2})), {&a, &b});
  EXPECT_EQ(read_frame(*log.frame(a)).t, (std::vector<double>{2}));
  EXPECT_EQ(read_frame(*log.frame(b)).t, (std::vector<double>{0.5, 1, 2}));
  EXPECT_EQ(read_frame(*log.frame(b)).rows, 0U);
}

TEST(LiveRows, ClientsInStepShareTheirBytes) {
  RowLog log;
  ReadMark a, b;
  log.add(std::make_shared<Slice>(slice_at(1, {1})), {&a, &b});
  EXPECT_EQ(log.frame(a), log.frame(b));
}

TEST(LiveRows, MuchIsThinnedWithItsEndsKept) {
  RowLog log;
  ReadMark late;
  for (int i = 0; i <= 5000; ++i) log.add(std::make_shared<Slice>(slice_at(i, {static_cast<double>(i)})), {&late});
  const Read read = read_frame(*log.frame(late));
  EXPECT_EQ(read.rows, RowLog::most_rows_in_a_frame);
  EXPECT_EQ(read.t.front(), 0);
  EXPECT_EQ(read.t.back(), 5000);
}

TEST(LiveRows, WhatIsVoidIsTakenBack) {
  RowLog log;
  ReadMark had, late;
  log.add(std::make_shared<Slice>(slice_at(3, {1, 2, 3})), {&had, &late});
  log.frame(had);
  Slice back = slice_at(2.5, {2, 2.5});
  back.rewound_to = 2;
  log.add(std::make_shared<Slice>(back), {&had, &late});
  const Read of_had = read_frame(*log.frame(had)), of_late = read_frame(*log.frame(late));
  EXPECT_EQ(of_had.flags & frame_rewound, frame_rewound);
  EXPECT_EQ(of_had.t, (std::vector<double>{2, 2.5}));
  EXPECT_EQ(of_late.flags & frame_rewound, 0U);
  EXPECT_EQ(of_late.t, (std::vector<double>{1, 2, 2.5}));
}

TEST(LiveRows, AreBounded) {
  RowLog log;
  ReadMark never;
  for (int i = 0; i < 100'000; ++i) log.add(std::make_shared<Slice>(slice_at(i, {static_cast<double>(i)})), {&never});
  EXPECT_GT(read_frame(*log.frame(never)).t.front(), 60'000);
}

TEST(LiveCommands, AreObjectsWithAWordThatIsKnown) {
  EXPECT_TRUE(read_command(R"({"do": "play"})"));
  for (const char* wrong :
       {"", "play", "[]", "{}", R"({"do": 1})", R"({"do": "rm -rf"})", "{\"do\": \"play\"", "\xff\xfe"})
    EXPECT_EQ(read_command(wrong).status().ending, Ending::invalid_input) << wrong;
  EXPECT_FALSE(read_command(std::string(1'000'000, '[')));
}

TEST(LivePage, ComesOutOfGzipAsItWentIn) {
  std::string page;
  for (int i = 0; i < 30'000; ++i) page += "<p>" + std::to_string(i);
  EXPECT_EQ(unzipped(stored(page)), page);
  EXPECT_EQ(unzipped(stored("")), "");
  EXPECT_EQ(unzipped("no gzip at all, whatever it says it is"), "");
}

}  // namespace
}  // namespace continuo::live
