// Chunks on disk: what is read is what was written, nothing damaged is read, and the outcomes of a sweep do not depend
// on how its chunks are made.
#include <atomic>
#include <bit>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include <continuo/language/load.hpp>
#include <continuo/studies/sweep/sweep_work.hpp>

namespace continuo::studies {
namespace {

namespace fs = std::filesystem;

class SweepChunks : public ::testing::Test {
 protected:
  void SetUp() override {
    root = fs::path(::testing::TempDir()) / ("continuo-chunks-" + std::to_string(::getpid()));
    fs::remove_all(root);
    fs::create_directories(root);
  }
  void TearDown() override { fs::remove_all(root); }
  std::string path(const std::string& name) const { return (root / name).string(); }

  fs::path root;
};

PreparedSweep decay() {
  model::Loaded loaded = model::load(
      model::Source("decay.sim",
                    "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..1\nsweep { k uniform(0.5, 2); runs 1500 sobol seed 5\n"
                    "  keep x at end, max(x^2) as peak }\n"));
  return *PreparedSweep::create(*std::move(loaded.model), {});
}

bool same_bits(const SweepOutcome& a, const SweepOutcome& b) {
  const auto bits = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return a.ending == b.ending && bits(a.t, b.t) && std::ranges::equal(a.kept, b.kept, bits) && a.message == b.message;
}

std::vector<SweepOutcome> random_outcomes(std::size_t count, std::size_t width, std::mt19937_64& random) {
  std::vector<SweepOutcome> made(count);
  for (SweepOutcome& one : made) {
    one.ending = static_cast<Ending>(random() % (static_cast<std::uint64_t>(last_ending) + 1));
    one.t = std::bit_cast<double>(random());
    for (std::size_t i = 0; i < width; ++i) one.kept.push_back(std::bit_cast<double>(random()));
    if (random() % 3 == 0) one.message = std::string(random() % 50, static_cast<char>('a' + random() % 26));
  }
  return made;
}

TEST_F(SweepChunks, EveryBitComesBack) {
  std::mt19937_64 random(3);
  for (const std::uint64_t runs : {1U, 7U, 1024U, 1025U, 5000U}) {
    for (const std::uint64_t width : {0U, 1U, 9U}) {
      const SweepIdentity identity{.hash = std::string(64, 'a'), .runs = runs, .width = width};
      const auto folder = SweepFolder::open(path("f" + std::to_string(runs) + "_" + std::to_string(width)), identity);
      ASSERT_TRUE(folder) << describe(folder.status());
      std::uint64_t all = 0;
      for (std::uint64_t chunk = 0; chunk < identity.chunks(); ++chunk) all += identity.size(chunk);
      EXPECT_EQ(all, runs);
      for (const std::uint64_t chunk : std::set<std::uint64_t>{0, identity.chunks() / 2, identity.chunks() - 1}) {
        const auto written = random_outcomes(static_cast<std::size_t>(identity.size(chunk)), width, random);
        EXPECT_EQ(folder->state(chunk), ChunkState::missing);
        ASSERT_TRUE(folder->write(chunk, written));
        EXPECT_EQ(folder->state(chunk), ChunkState::whole);
        const auto read = folder->read(chunk);
        ASSERT_TRUE(read) << describe(read.status());
        EXPECT_TRUE(std::ranges::equal(*read, written, same_bits));
      }
    }
  }
}

TEST_F(SweepChunks, ADamagedChunkIsNone) {
  const SweepIdentity identity{.hash = std::string(64, 'b'), .runs = 3000, .width = 2};
  const auto folder = SweepFolder::open(path("f"), identity);
  std::mt19937_64 random(4);
  const auto outcomes = random_outcomes(static_cast<std::size_t>(identity.size(5)), 2, random);
  ASSERT_TRUE(folder->write(5, outcomes));
  std::ifstream in(folder->file(5), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto put = [&](const std::string& bytes) { std::ofstream(folder->file(5), std::ios::binary) << bytes; };
  for (int tries = 0; tries < 200; ++tries) {
    std::string bytes = whole;
    if (tries % 2 == 0) {
      bytes.resize(random() % whole.size());  // cut short, to nothing as well
    } else {
      bytes[random() % whole.size()] ^= static_cast<char>(1 << random() % 8);
    }
    put(bytes);
    EXPECT_EQ(folder->state(5), ChunkState::damaged) << tries;
    EXPECT_FALSE(folder->read(5)) << tries;
  }
  // One of another place, and one of another sweep.
  put(whole);
  fs::copy_file(folder->file(5), folder->file(4));
  EXPECT_EQ(folder->state(4), ChunkState::damaged);
  const auto other = SweepFolder::open(path("g"), {.hash = std::string(64, 'c'), .runs = 3000, .width = 2});
  fs::copy_file(folder->file(5), other->file(5));
  EXPECT_EQ(other->state(5), ChunkState::damaged);
  EXPECT_EQ(folder->missing().size(), identity.chunks() - 1);
}

TEST_F(SweepChunks, AFolderIsOfOneSweep) {
  const SweepIdentity identity{.hash = std::string(64, 'd'), .runs = 10, .width = 1};
  ASSERT_TRUE(SweepFolder::open(path("f"), identity));
  EXPECT_TRUE(SweepFolder::open(path("f"), identity));
  SweepIdentity other = identity;
  other.hash = std::string(64, 'e');
  EXPECT_EQ(SweepFolder::open(path("f"), other).status().ending, Ending::invalid_input);
  fs::create_directory(path("own"));
  std::ofstream(path("own") + "/letter.txt") << "dear";
  EXPECT_EQ(SweepFolder::open(path("own"), identity).status().ending, Ending::invalid_input);
  EXPECT_EQ(SweepFolder::open(path("no/such"), identity).status().ending, Ending::unwritable);
}

TEST_F(SweepChunks, OutcomesDoNotDependOnThreadsOrOrder) {
  const PreparedSweep sweep = decay();
  const SweepIdentity identity = identity_of(sweep, "1");
  std::vector<SweepOutcome> one_by_one;
  for (std::uint64_t run = 0; run < sweep.runs(); ++run) one_by_one.push_back(sweep.run(run));
  for (const std::size_t threads : {1U, 2U, 5U}) {
    for (const bool in_order : {false, true}) {
      std::vector<SweepOutcome> made(one_by_one.size());
      std::uint64_t last = 0, seen = 0;
      SweepWork work{.chunks = {}, .threads = threads, .in_order = in_order};
      for (std::uint64_t chunk = 0; chunk < identity.chunks(); ++chunk) work.chunks.push_back(chunk);
      work.on_chunk = [&](std::uint64_t chunk, std::vector<SweepOutcome> outcomes) {
        EXPECT_TRUE(!in_order || seen == 0 || chunk == last + 1);
        last = chunk, ++seen;
        std::ranges::copy(outcomes, made.begin() + static_cast<std::ptrdiff_t>(identity.first_run(chunk)));
        return Status();
      };
      ASSERT_TRUE(run_chunks(sweep, identity, work));
      EXPECT_TRUE(std::ranges::equal(made, one_by_one, same_bits)) << threads;
    }
  }
}

// The first results of a sweep do not wait for a thousandth of it.
TEST_F(SweepChunks, BeginWithOneRunAndGrowToTwiceTheSizeAtMost) {
  for (std::uint64_t runs = 1; runs < 20'000'000; runs += 1 + runs / 7) {
    const SweepIdentity identity{.hash = {}, .runs = runs, .width = runs % 5 * 1000};
    EXPECT_EQ(identity.size(0), 1u);
    std::uint64_t next = 0, before = 1;
    for (std::uint64_t chunk = 0; chunk < identity.chunks(); ++chunk) {
      ASSERT_EQ(identity.first_run(chunk), next);
      ASSERT_GE(identity.size(chunk), 1u);
      ASSERT_LE(identity.size(chunk), std::min(2 * before, identity.per_chunk()));
      before = identity.size(chunk), next += before;
    }
    ASSERT_EQ(next, runs);
  }
}

TEST_F(SweepChunks, PartsAreAllChunksOnce) {
  for (const std::uint64_t runs : {1U, 5U, 1000U, 5000U}) {
    const SweepIdentity identity{.hash = {}, .runs = runs, .width = 1};
    for (const std::uint64_t parts : {1U, 2U, 3U, 16U}) {
      std::vector<std::uint64_t> all;
      for (std::uint64_t part = 1; part <= parts; ++part)
        for (const std::uint64_t chunk : chunks_of_part(identity, part, parts)) all.push_back(chunk);
      ASSERT_EQ(all.size(), identity.chunks());
      for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
    }
  }
}

TEST_F(SweepChunks, ThreadsMayHandThemOnAtTheSameTime) {
  const PreparedSweep sweep = decay();
  const SweepIdentity identity = identity_of(sweep, "1");
  const auto folder = SweepFolder::open(path("at_once"), identity);
  ASSERT_TRUE(folder);
  SweepWork work{.chunks = folder->missing(), .threads = 4, .at_once = true};
  work.on_chunk = [&](std::uint64_t chunk, const std::vector<SweepOutcome>& made) {
    return folder->write(chunk, made);
  };
  ASSERT_TRUE(run_chunks(sweep, identity, work));
  for (std::uint64_t chunk = 0; chunk < identity.chunks(); ++chunk) {
    const auto made = folder->read(chunk);
    ASSERT_TRUE(made) << describe(made.status());
    for (std::uint64_t i = 0; i < made->size(); ++i)
      EXPECT_TRUE(same_bits((*made)[i], sweep.run(identity.first_run(chunk) + i)));
  }
  work.on_chunk = [&](std::uint64_t chunk, const std::vector<SweepOutcome>&) {
    return chunk == 3 ? Status{.ending = Ending::unwritable, .message = "the disk is full"} : Status();
  };
  EXPECT_EQ(run_chunks(sweep, identity, work).ending, Ending::unwritable);
}

TEST_F(SweepChunks, AFailureEndsTheWorkAndAnInterruptLosesTheChunksAtWork) {
  const PreparedSweep sweep = decay();
  const SweepIdentity identity = identity_of(sweep, "1");
  SweepWork work{.chunks = {0, 1, 2, 3, 4, 5}, .threads = 2};
  int calls = 0;
  work.on_chunk = [&](std::uint64_t, const std::vector<SweepOutcome>&) {
    ++calls;
    return Status{.ending = Ending::unwritable, .message = "the disk is full"};
  };
  EXPECT_EQ(run_chunks(sweep, identity, work).ending, Ending::unwritable);
  EXPECT_EQ(calls, 1);
  std::atomic<bool> interrupt = false;
  work.interrupt = &interrupt;
  std::vector<std::uint64_t> kept;
  work.on_chunk = [&](std::uint64_t chunk, const std::vector<SweepOutcome>& outcomes) {
    EXPECT_EQ(outcomes.size(), identity.size(chunk));
    kept.push_back(chunk);
    interrupt = true;
    return Status();
  };
  EXPECT_EQ(run_chunks(sweep, identity, work).ending, Ending::interrupted);
  EXPECT_LT(kept.size(), work.chunks.size());
}

}  // namespace
}  // namespace continuo::studies
