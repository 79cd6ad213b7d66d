// The colours of methods in pictures that compare them: a method has the same one in every panel of every picture.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace continuo::results {

/// For each name the number of its colour (`color_of`, Curve::number). A method that stands there again, as with
/// another step, has its colour with other dashes.
[[nodiscard]] std::vector<std::size_t> colors_of_methods(std::span<const std::string> names);

}  // namespace continuo::results
