// Every model of the gallery passes every check without a message.
#include <filesystem>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>

namespace continuo::model {
namespace {

TEST(CheckGallery, EveryModelLoadsWithoutAMessage) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CONTINUO_SOURCE_DIR "/models")) {
    if (entry.path().extension() != ".sim") continue;
    const Loaded loaded = load(entry.path());
    EXPECT_TRUE(loaded) << loaded.text();
    EXPECT_TRUE(loaded.diagnostics.empty()) << loaded.text();
    ++count;
  }
  EXPECT_GE(count, 20U);
}

}  // namespace
}  // namespace continuo::model
