// tests/docs/shown_text.hpp
// Compares the text shown on a page with the output of a command: the same words, and numbers equal but for their last
// digits. Run times and hashes of manifests may differ, since they do so from machine to machine.
#pragma once
#include <string>

namespace continuo::docs {

/// Line by line. `...` on a line of its own in `shown` stands for any lines, `…` within a line for any text.
bool shows(const std::string& shown, const std::string& printed);

}  // namespace continuo::docs
