// continuo/solve/direction.hpp
#pragma once

namespace continuo {

/// The sign change of an event's guard that counts: from above zero to below, from below to above, either.
enum class Direction { falls, rises, crosses };

}  // namespace continuo
