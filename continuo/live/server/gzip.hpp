// continuo/live/server/gzip.hpp
#pragma once
#include <string>
#include <string_view>

namespace continuo::live {

/// What gzip made of a file, back again. Empty where it is not of gzip or is damaged.
std::string unzipped(std::string_view bytes);

/// The same bytes in the form of gzip, stored as they are: for a page that was given uncompressed.
std::string stored(std::string_view bytes);

}  // namespace continuo::live
