// apps/continuo/terminal/terminal.hpp
// What people read: messages on standard error, colours only on a terminal and never against NO_COLOR.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/status/status.hpp>

namespace continuo::app {

/// "continuo: MESSAGE" on standard error, and in the answer to --json: what is wrong, and with `mention` what is not.
void say(std::string_view message);
void mention(std::string_view message);

/// False, after saying why, where a file could not be written or a picture not be drawn.
bool written(const Status& status);

/// Text that is data: standard output.
void print(std::string_view text);

/// Whether all that was printed has arrived, not on a full disk; says so where not.
bool all_printed();

/// Whether messages may have colours: standard error is a terminal and NO_COLOR is not set (no-color.org).
bool colors_wanted();

/// Whether somebody watches: standard error is a terminal.
bool watched();

}  // namespace continuo::app
