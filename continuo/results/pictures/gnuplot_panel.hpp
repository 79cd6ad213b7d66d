// The part of a gnuplot script that draws one panel of a figure. Internal to gnuplot.cpp.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include <continuo/results/figure.hpp>

namespace continuo::results {

inline constexpr int width_of_pictures = 960;  // pixels, where nobody has named a size

/// The colours of what is no curve: "#rrggbb".
struct Theme {
  std::string_view background, text, frame, grid, mark;
};
/// On white, and for screens with a dark background.
[[nodiscard]] const Theme& theme_of(bool is_dark);

/// A text in gnuplot's double quotes, what is special there by its octal number: a backquote would run a command.
/// Not in single quotes, where gnuplot stumbles over two quotes in a row, as in x''.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The data of panel number `number`.
void append_panel_data(std::string& script, const Panel& panel, std::size_t number);
/// What draws them, in a part of the height of the picture; both from 0 to 1. Their data come before.
void append_panel(std::string& script, const Panel& panel, std::size_t number, bool is_dark, double bottom,
                  double height);

}  // namespace continuo::results
