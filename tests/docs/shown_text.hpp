// tests/docs/shown_text.hpp
// Whether a page still shows what a command prints: the same words, and numbers that say the same. The last digits of
// a number, how long a run took and the hash of a manifest differ from machine to machine; a reader does not mind.
#pragma once
#include <string>

namespace continuo::docs {

/// Line by line. `...` on a line of its own in `shown` stands for any lines, `…` within a line for any text.
bool shows(const std::string& shown, const std::string& printed);

}  // namespace continuo::docs
