// continuo/live/session/write_file.hpp
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/status/status.hpp>

namespace continuo::live {

/// The whole file at once, or as it was: written beside it and moved over it. What went wrong, if anything.
Status write_atomically(const std::string& path, std::string_view text);

}  // namespace continuo::live
