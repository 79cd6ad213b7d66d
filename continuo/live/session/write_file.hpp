// continuo/live/session/write_file.hpp
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace continuo::live {

/// The whole file at once, or as it was: written beside it and moved over it. What went wrong, if anything.
std::optional<std::string> write_atomically(const std::string& path, std::string_view text);

}  // namespace continuo::live
