// A figure in characters: each character of braille has two by four dots. For terminals.
#pragma once
#include <cstddef>
#include <string>

#include <continuo/results/figure.hpp>

namespace continuo::results {

/// How large a sketch is, in characters, and whether it has colours.
struct SketchStyle {
  std::size_t columns = 72, rows = 14;  // of the whole picture with its labels
  bool color = false;                   // of a terminal: ANSI
};

/// The panel with its axes, labels and key. Every line ends with a line end, and none is wider than the columns.
[[nodiscard]] std::string sketch(const Panel& panel, const SketchStyle& style);

}  // namespace continuo::results
