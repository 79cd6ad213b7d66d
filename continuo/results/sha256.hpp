// continuo/results/sha256.hpp
// The hash that ties a result file to its manifest and a manifest to the text of its model.
#pragma once
#include <string>
#include <string_view>

namespace continuo::results {

/// 64 hexadecimal digits. FIPS 180-4, section 6.2.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace continuo::results
