// A small picture of a motion in the terminal: in the graphics that the terminal is known to understand, else in
// braille.
#pragma once
#include <continuo/results/figure.hpp>

namespace continuo::app {

/// Whether a picture is welcome there: standard output is a terminal that knows UTF-8, and neither NO_COLOR nor
/// TERM=dumb asks for plain text.
bool can_show_sketch();

/// Draws the figure, as wide as the terminal at most.
void show_sketch(const results::Figure& figure);

}  // namespace continuo::app
