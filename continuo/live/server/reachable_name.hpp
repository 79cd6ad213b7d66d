// continuo/live/server/reachable_name.hpp
#pragma once
#include <string>

namespace continuo::live {

/// How others reach who listens at this address: the address itself, or one of this computer's where it is 0.0.0.0 or
/// ::, which stand for all of them.
std::string reachable_name(const std::string& address);

}  // namespace continuo::live
