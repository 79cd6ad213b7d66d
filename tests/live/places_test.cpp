// Who has to leave where there is no room.
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/live/server/places.hpp>

namespace continuo::live {
namespace {

struct Guests {
  explicit Guests(Places::Limits limits) : places(limits) {}
  /// False where there was no room.
  bool enter(Guest guest, const std::string& address, const std::string& name, double idle = 0) {
    auto place = places.enter(guest, address, [this, name] { left.push_back(name); }, [idle] { return idle; });
    if (!place) return false;
    held.push_back(std::move(place));
    return true;
  }
  Places places;
  std::vector<std::unique_ptr<Places::Place>> held;
  std::vector<std::string> left;
};

TEST(Places, TheOldestStrangerGoesFirst) {
  Guests guests({.strangers = 2});
  for (const char* name : {"a", "b", "c", "d"}) EXPECT_TRUE(guests.enter(Guest::stranger, "1", name));
  EXPECT_EQ(guests.left, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(guests.places.count(Guest::stranger), 2U);
}

TEST(Places, AnAddressWithManyStrangersMakesRoomForTheOthers) {
  Guests guests({.strangers = 4});
  EXPECT_TRUE(guests.enter(Guest::stranger, "honest", "h"));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(guests.enter(Guest::stranger, "flood", "f"));
  EXPECT_EQ(std::ranges::count(guests.left, "h"), 0);
}

TEST(Places, OneAddressCannotTakeThePlacesOfAllViewers) {
  Guests guests({.viewers = 4});
  for (const char* name : {"1", "2", "3", "4"}) EXPECT_TRUE(guests.enter(Guest::viewer, "greedy", name));
  EXPECT_FALSE(guests.enter(Guest::viewer, "greedy", "5"));
  EXPECT_TRUE(guests.enter(Guest::viewer, "modest", "m"));
  EXPECT_TRUE(guests.enter(Guest::viewer, "another", "n"));
  EXPECT_EQ(guests.left, (std::vector<std::string>{"4", "3"})) << "the newest: a page that comes again is refused then";
  EXPECT_FALSE(guests.enter(Guest::viewer, "greedy", "6"));
}

TEST(Places, ViewersAndStrangersTakeNoPlaceOfAPresenter) {
  Guests guests({.strangers = 1, .viewers = 1, .presenters = 2});
  for (int i = 0; i < 10; ++i) guests.enter(Guest::stranger, "x", "s"), guests.enter(Guest::viewer, "x", "v");
  guests.left.clear();
  for (const char* name : {"a", "b", "c"}) EXPECT_TRUE(guests.enter(Guest::presenter, "p", name));
  EXPECT_EQ(guests.left, (std::vector<std::string>{"a"}));
}

TEST(Places, OwnersWhoDoNothingMakeRoom) {
  Guests guests({.owners = 3, .idle = 120});
  EXPECT_TRUE(guests.enter(Guest::owner, "1", "a", 100));
  EXPECT_TRUE(guests.enter(Guest::owner, "2", "b", 119));
  EXPECT_TRUE(guests.enter(Guest::owner, "3", "c", 5));
  EXPECT_FALSE(guests.enter(Guest::owner, "4", "d")) << "all have done something of late";
  EXPECT_FALSE(guests.enter(Guest::owner, "1", "d"));
  guests.held.clear();
  for (const double idle : {130.0, 500.0, 10.0}) EXPECT_TRUE(guests.enter(Guest::owner, "1", "i", idle));
  guests.left.clear();
  EXPECT_TRUE(guests.enter(Guest::owner, "1", "e", 20));
  EXPECT_TRUE(guests.enter(Guest::owner, "1", "f", 30));
  EXPECT_FALSE(guests.enter(Guest::owner, "1", "g", 0));
  EXPECT_EQ(guests.left.size(), 2U);
}

TEST(Places, OneAddressCannotTakeTheSessionsOfAllOwners) {
  Guests guests({.owners = 4});
  const std::vector<std::pair<std::string, double>> greedy{{"1", 3}, {"2", 9}, {"3", 1}, {"4", 8}};
  for (const auto& [name, idle] : greedy) EXPECT_TRUE(guests.enter(Guest::owner, "greedy", name, idle));
  EXPECT_FALSE(guests.enter(Guest::owner, "greedy", "5"));
  EXPECT_TRUE(guests.enter(Guest::owner, "modest", "m", 50));
  EXPECT_TRUE(guests.enter(Guest::owner, "another", "n", 50));
  EXPECT_FALSE(guests.enter(Guest::owner, "greedy", "6"));
  EXPECT_EQ(guests.left, (std::vector<std::string>{"2", "4"})) << "who has been idle for longest";
}

// Any sequence of arrivals and departures: no limit is exceeded, and who has left gives back one place only.
TEST(Places, AreNeverMoreThanTheLimits) {
  std::mt19937 chance(11);
  const Places::Limits limits{.strangers = 3, .viewers = 5, .presenters = 2, .owners = 4};
  Guests guests(limits);
  for (int i = 0; i < 20'000; ++i) {
    if (chance() % 3 > 0) {
      const auto guest = static_cast<Guest>(chance() % 4);
      guests.enter(guest, std::to_string(chance() % 4), "", static_cast<double>(chance() % 200));
    } else if (!guests.held.empty()) {
      guests.held.erase(guests.held.begin() + static_cast<std::ptrdiff_t>(chance() % guests.held.size()));
    }
    ASSERT_LE(guests.places.count(Guest::stranger), limits.strangers);
    ASSERT_LE(guests.places.count(Guest::viewer), limits.viewers);
    ASSERT_LE(guests.places.count(Guest::presenter), limits.presenters);
    ASSERT_LE(guests.places.count(Guest::owner), limits.owners);
  }
  guests.held.clear();
  for (const Guest guest : {Guest::stranger, Guest::viewer, Guest::presenter, Guest::owner})
    EXPECT_EQ(guests.places.count(guest), 0U);
}

}  // namespace
}  // namespace continuo::live
