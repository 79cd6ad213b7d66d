// continuo/live/server/places.hpp
// Who is connected, and who has to go when there is no room. Those who have not shown a token are few, and the oldest
// of them makes room for a new one: idle strangers lock nobody out.
//
//   Places places({.strangers = 16, .viewers = 64, .presenters = 8});
//   auto place = places.enter(Guest::stranger, "192.168.1.7", [&] { connection.close(); });
//   place.reset();                                  // it has left
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace continuo::live {

/// An owner is a viewer who has a session of their own.
enum class Guest { stranger, viewer, presenter, owner };

class Places {
 public:
  using Leave = std::function<void()>;
  /// For how many seconds its guest has done nothing.
  using Idle = std::function<double()>;

  /// How many there may be of each.
  struct Limits {
    std::size_t strangers = 16, viewers = 64, presenters = 8, owners = 40;
    double idle = 120;  // seconds, after which an owner makes room
  };
  /// Given back when it is destroyed; the places may be gone by then.
  class Place;

  explicit Places(Limits limits);

  /// Null where there is no room: for a viewer whose address has its share. Others have to leave for strangers and
  /// presenters, the oldest first, of strangers one from the address that has most; and for a viewer, the newest one of
  /// an address that has more than this one will have, so that one computer cannot take all places. For an owner it is
  /// who has been idle for longest: of such an address, or else of all, if that is long.
  [[nodiscard]] std::unique_ptr<Place> enter(Guest guest, const std::string& address, Leave leave, Idle idle = {});

  [[nodiscard]] std::size_t count(Guest guest) const;

 private:
  struct Entry {
    Guest guest;
    std::string address;
    Leave leave;
    Idle idle;
  };
  struct All {
    std::uint64_t last = 0;
    std::map<std::uint64_t, Entry> entries;  // by their numbers, which increase: the oldest is the first
  };

  std::size_t limit(Guest guest) const;
  std::size_t count_of(Guest guest, const std::string& address) const;
  std::string fullest_address(Guest guest) const;
  bool make_room(Guest guest, const std::string& address);
  bool make_room_for_owner(const std::string* fullest);
  void turn_out(Guest guest, const std::string* address, bool oldest);
  void turn_out(std::map<std::uint64_t, Entry>::iterator chosen);

  Limits limits_;
  std::shared_ptr<All> all_ = std::make_shared<All>();
};

class Places::Place {
 public:
  Place(std::weak_ptr<All> all, std::uint64_t number) : all_(std::move(all)), number_(number) {}
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  ~Place();

 private:
  std::weak_ptr<All> all_;
  std::uint64_t number_;
};

}  // namespace continuo::live
