// continuo/language/check/world/members.hpp
// The states of a body by name.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace continuo::model::detail {

struct Member {
  std::string_view name;
  int order;
};
inline constexpr std::array<Member, 3> plane_members = {{{"x", 2}, {"y", 2}, {"angle", 2}}};
inline constexpr std::array<Member, 10> space_members = {{{"x", 2},
                                                          {"y", 2},
                                                          {"z", 2},
                                                          {"q_w", 1},
                                                          {"q_x", 1},
                                                          {"q_y", 1},
                                                          {"q_z", 1},
                                                          {"spin_x", 1},
                                                          {"spin_y", 1},
                                                          {"spin_z", 1}}};

[[nodiscard]] inline std::span<const Member> members_of(int dimension) {
  if (dimension == 2) return plane_members;
  return space_members;
}

}  // namespace continuo::model::detail
