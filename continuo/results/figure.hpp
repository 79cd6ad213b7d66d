// continuo/results/figure.hpp
// Pictures through gnuplot: panels one below the other, each with curves over a common axis.
//
//   Figure figure{.title = "Ball", .panels = {{.x_label = "t [s]", .y_label = "h [m]", .curves = {{"h", t, h}}}}};
//   if (const Status status = draw(figure, "ball.svg"); !status) fmt::print(stderr, "{}\n", status.message);
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/status.hpp>

namespace continuo::results {

/// The numbers from low to high.
struct Range {
  double low, high;
};

/// A curve, or a set of points, of a panel.
struct Curve {
  std::string label;
  std::vector<double> x, y;  // of equal length; a NaN breaks the line
  std::string color{};       // "#rrggbb"; empty: the next of the palette
  /// An area is a closed path, filled. Discs have a radius each, on the scale of x, and a colour. Bars stand on 0, with
  /// an interval at the top of each.
  enum class Style {
    line,
    dashed_line,
    dotted_line,
    thin_line,
    line_with_points,
    full_points,
    empty_points,
    dots,
    area,
    discs,
    bars
  };
  Style style = Style::line;
  std::optional<std::size_t> number{};  // of its colour in the palette; else its place in the panel
  bool widens_axes = true;              // false: the axes do not reach for it
  /// A disc at a point of the curve.
  struct Disc {
    double radius = 0;
    std::string_view color;  // "#rrggbb", of a text that lasts
  };
  std::vector<Disc> discs{};       // one for each point of that style
  std::vector<Range> intervals{};  // one for each bar; NaN where there is none
  double fill = 0.12;              // of an area: from 0, nothing, to 1, its colour alone
  double bar_width = 0.8;          // on the scale of x
};

/// A plane in cells, each with the colour of its value.
struct Cells {
  std::vector<double> x_edges{}, y_edges{};  // rising, one more than there are cells
  std::vector<double> values{};              // row by row from below; NaN: none
  std::string label{};                       // of the scale of colours
};

/// A pair of axes with its curves.
struct Panel {
  std::string x_label, y_label;
  std::vector<Curve> curves;
  std::vector<double> marks{};  // positions on the x axis: events
  std::string mark_label = "event";
  bool equal_scale = false;    // one unit is as long upwards as to the right
  bool logarithmic_x = false;  // what is not positive has no place there
  bool logarithmic_y = false;
  bool tall = false;                         // as high as wide pictures allow: for planes
  bool zero_lines = false;                   // through the origin
  double least_width = 0, least_height = 0;  // of the values that the axes show: they magnify nothing smaller
  bool no_numbers = false;                   // at the axes
  std::vector<std::string> x_names{};        // of the places 0, 1, 2, ... on the x axis, instead of numbers
  Cells cells{};                             // below the curves
};

/// How large a picture is, in pixels; zero where nobody has said.
struct PictureSize {
  int width = 0, height = 0;
};

/// A picture: panels from top to bottom.
struct Figure {
  std::string title;
  std::vector<Panel> panels;
  PictureSize size{};
  bool is_dark = false;  // light on a dark background
};

/// The colour of the curve of this number where it names none.
[[nodiscard]] std::string_view color_of(std::size_t number);

/// The endings of files that can be drawn into, as people read them.
inline constexpr std::string_view picture_endings = ".svg, .png or .pdf";
/// Whether the file's ending is one of them.
[[nodiscard]] bool is_picture(std::string_view path);

/// The file's ending says the format: .svg, .png or .pdf. Returns what went wrong, if anything: unknown ending, gnuplot
/// not installed, folder not writable.
Status draw(const Figure& figure, const std::string& path);

/// The program for gnuplot that `draw` runs.
[[nodiscard]] std::string gnuplot_script(const Figure& figure, const std::string& path);

/// An axis shows at least so many times the tolerance of its quantity: what a run has not computed is not magnified,
/// and an energy that is conserved is a level line.
inline constexpr double least_tolerances_of_axis = 100;

/// What an axis shows of values from low to high, with so much air as a part of these. It has an extent even over a
/// constant (with its round-off) and over nothing at all (low > high): left to choose, gnuplot warns of the one and
/// ends at the other.
[[nodiscard]] Range axis_over(double low, double high, double air);

/// What of a closed path without gaps lies in a rectangle.
[[nodiscard]] Curve clipped(const Curve& path, Range x, Range y);

/// Where a point of space is seen in the plane of a picture: from above the corner, along (-1, 1, -1). So x leads to
/// the right and towards us, y to the right and away, z upwards, and all three axes are as long.
[[nodiscard]] inline double right_in_space(double x, double y) {
  return (x + y) * 0.86602540378443864676;  // sqrt(3/4)
}
/// Its other coordinate there.
[[nodiscard]] inline double up_in_space(double x, double y, double z) {
  return z + (y - x) / 2;
}
/// The larger, the nearer to us.
[[nodiscard]] inline double nearness_in_space(double x, double y, double z) {
  return x - y + z;
}
/// Of a unit of length across the line of sight, in the picture.
inline constexpr double size_in_space = 1.2247448713915890;  // sqrt(3/2)

/// A curve of many points without those that no eye can tell apart on a picture `pixels` wide. Peaks stay.
[[nodiscard]] Curve thinned(const Curve& curve, std::size_t pixels);

}  // namespace continuo::results
