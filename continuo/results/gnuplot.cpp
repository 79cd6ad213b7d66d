// Writes a figure as a gnuplot script with its data, and runs gnuplot on it.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX wants it declared by its user

namespace continuo::results {
namespace {

constexpr int width = 960, panel_height = 300, square_height = 720, title_height = 40;  // pixels
constexpr double closest_marks = 4;          // pixels; nearer ones would join to a grey block
constexpr std::size_t most_long_marks = 40;  // more would paint the background, and stand at its foot alone

// Okabe and Ito's colours, told apart by all common kinds of colour vision. M. Okabe, K. Ito, "Color universal design"
// (2008). Yellow is left out, too pale on white, and black, which marks what others are compared with.
constexpr std::string_view palette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// A text in gnuplot's double quotes, what is special there by its octal number: a backquote would run a command.
/// Not in single quotes, where gnuplot stumbles over two quotes in a row, as in x''.
std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '`') {
      result += fmt::format("\\{:03o}", static_cast<unsigned>(c));
    } else {
      result += c == '\n' ? ' ' : c;
    }
  }
  return result + "\"";
}

std::string ending_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

int height_of(const Panel& panel) {
  return panel.equal_scale || panel.tall ? square_height : panel_height;
}

int height_of(const Figure& figure) {
  int height = title_height;
  for (const Panel& panel : figure.panels) height += height_of(panel);
  return height;
}

/// Where a value stands on an axis; what has no place is no number. Of an axis of decades gnuplot knows no more.
double place_of(bool is_logarithmic, double value) {
  if (!is_logarithmic) return value;
  return value >= 1e-300 && value <= 1e300 ? std::log10(value) : NAN;
}
bool has_place(const Panel& panel, const Curve& curve, std::size_t i) {
  return std::isfinite(place_of(panel.logarithmic_x, curve.x[i])) &&
         std::isfinite(place_of(panel.logarithmic_y, curve.y[i]));
}

void append_disc(std::string& script, const Curve::Disc& disc) {
  script += ' ';
  append_number(script, disc.radius);
  script += fmt::format(" 0x{}", disc.color.substr(1));  // without its '#'
}

void append_data(std::string& script, const Panel& panel, const std::string& name, const Curve& curve) {
  script += fmt::format("{} << END\n", name);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (has_place(panel, curve, i)) {
      append_number(script, curve.x[i]);
      script += ' ';
      append_number(script, curve.y[i]);
      if (curve.style == Curve::Style::discs) append_disc(script, curve.discs[i]);
    }
    script += '\n';  // an empty line breaks the curve
  }
  script += "END\n";
}

/// `own`: a colour, or none.
std::string style_of(Curve::Style style, std::string_view own, std::size_t number) {
  const std::string_view color = own.empty() ? color_of(number) : own;
  // Dashes tell the second round of colours from the first.
  const std::size_t round = own.empty() ? number / std::size(palette) : 0;
  switch (style) {
    case Curve::Style::dashed_line:
      return fmt::format("lines lw 1.8 dt '-' lc rgb '{}'", color);
    case Curve::Style::dotted_line:
      return fmt::format("lines lw 1 dt 3 lc rgb '{}'", color);
    case Curve::Style::line_with_points:
      return fmt::format("linespoints lw 1.8 pt 7 ps 0.4 dt {} lc rgb '{}'", round + 1, color);
    case Curve::Style::thin_line:
      return fmt::format("lines lw 0.9 lc rgb '{}'", color);
    case Curve::Style::full_points:
      return fmt::format("points pt 7 ps 1.0 lc rgb '{}'", color);
    case Curve::Style::empty_points:
      return fmt::format("points pt 6 lw 2 ps 1.0 lc rgb '{}'", color);
    case Curve::Style::dots:
      return fmt::format("points pt 7 ps 0.45 lc rgb '{}'", color);
    case Curve::Style::area:
      return fmt::format("filledcurves closed fs transparent solid 0.12 noborder lc rgb '{}'", color);
    case Curve::Style::discs:
      return "circles fs solid border lc rgb '#ffffff' lw 0.5 lc rgb variable";
    case Curve::Style::line:
      break;
  }
  return fmt::format("lines lw 1.8 dt {} lc rgb '{}'", round + 1, color);
}

/// What one axis spans: all values and a little air, so that no curve lies on the frame.
Range range_of(const Panel& panel, std::vector<double> Curve::* values, double air) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : panel.curves) {
    if (!curve.widens_axes) continue;
    for (std::size_t i = 0; i < (curve.*values).size(); ++i) {
      const double v = (curve.*values)[i], around = curve.discs.empty() ? 0 : curve.discs[i].radius;
      if (std::isfinite(v)) low = std::min(low, v - around), high = std::max(high, v + around);
    }
  }
  return axis_over(low, high, air);
}
/// The same about its middle, where it would show less than is known.
Range at_least(const Range& range, double extent) {
  const double more = (extent - (range.high - range.low)) / 2;
  return more > 0 ? Range{range.low - more, range.high + more} : range;
}
Range range_of_x(const Panel& panel) {
  return at_least(range_of(panel, &Curve::x, panel.equal_scale ? 0.05 : 0), panel.least_width);
}
Range range_of_y(const Panel& panel) {
  return at_least(range_of(panel, &Curve::y, 0.05), panel.least_height);
}
std::string range_text(const Range& range) {
  return fmt::format("[{}:{}]", range.low, range.high);
}

/// The least and the greatest place with a point.
std::array<double, 2> places_of(const Panel& panel) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : panel.curves) {
    for (const double x : curve.x) {
      const double place = place_of(panel.logarithmic_x, x);
      if (std::isfinite(place)) low = std::min(low, place), high = std::max(high, place);
    }
  }
  return {low, high};
}

/// The marks that can be told apart.
std::vector<double> distinct_marks(const Panel& panel) {
  const auto [low, high] = places_of(panel);
  std::vector<double> marks;
  for (const double mark : panel.marks) {
    const double place = place_of(panel.logarithmic_x, mark);
    if (!std::isfinite(place)) continue;
    const double before = marks.empty() ? -INFINITY : place_of(panel.logarithmic_x, marks.back());
    if (place - before >= closest_marks * (high - low) / width) marks.push_back(mark);
  }
  return marks;
}

constexpr double least_decades = 1e-12;  // less is round-off

/// Of a logarithmic axis with one value, or none.
std::string decades_about(double value) {
  const double middle = std::isfinite(value) ? value : 1;
  return range_text({middle / 10, middle * 10});
}

std::string x_range_text(const Panel& panel) {
  if (!panel.logarithmic_x) return range_text(range_of_x(panel));
  const auto [low, high] = places_of(panel);
  return high - low > least_decades ? range_text({std::pow(10, low), std::pow(10, high)})
                                    : decades_about(std::pow(10, low));
}

std::string y_range_text(const Panel& panel) {
  if (!panel.logarithmic_y) return range_text(range_of_y(panel));
  double low = INFINITY, high = 0;
  for (const Curve& curve : panel.curves)
    for (std::size_t i = 0; i < curve.y.size(); ++i)
      if (has_place(panel, curve, i)) low = std::min(low, curve.y[i]), high = std::max(high, curve.y[i]);
  return std::log10(high / low) > least_decades ? "[*:*]" : decades_about(low);  // to whole decades
}

std::size_t shown_points(const Panel& panel, const Curve& curve) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < curve.y.size(); ++i) count += has_place(panel, curve, i) ? 1 : 0;
  return count;
}

bool is_line(Curve::Style style) {
  return style == Curve::Style::line || style == Curve::Style::dashed_line || style == Curve::Style::thin_line ||
         style == Curve::Style::dotted_line || style == Curve::Style::line_with_points;
}

/// Ticks between the powers of ten, where there are few enough of these.
std::string_view small_ticks(const Panel& panel, std::vector<double> Curve::* values, bool logarithmic) {
  constexpr double most_decades = 6;
  double low = INFINITY, high = 0;
  for (const Curve& curve : panel.curves)
    for (const double v : curve.*values)
      if (std::isfinite(v) && v > 0) low = std::min(low, v), high = std::max(high, v);
  return logarithmic && high > low * std::pow(10, most_decades) ? "1" : "default";
}

void append_panel(std::string& script, const Panel& panel, std::size_t number, double bottom, double height) {
  script += fmt::format("set origin 0,{:.5f}\nset size 1,{:.5f}\n", bottom, height);
  script += panel.equal_scale ? "set size ratio -1\n" : "set size noratio\n";
  script += panel.zero_lines ? "set zeroaxis lw 1 dt 1 lc rgb '#999999'\n" : "unset zeroaxis\n";
  script += panel.logarithmic_x ? "set logscale x\nset format x '%.0e'\n" : "unset logscale x\nset format x '%h'\n";
  script += panel.logarithmic_y ? "set logscale y\nset format y '%.0e'\n" : "unset logscale y\nset format y '%h'\n";
  if (panel.no_numbers) script += "set format ''\n";
  script += fmt::format("set mxtics {}\nset mytics {}\n", small_ticks(panel, &Curve::x, panel.logarithmic_x),
                        small_ticks(panel, &Curve::y, panel.logarithmic_y));
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\nunset arrow\n", in_quotes(panel.x_label), in_quotes(panel.y_label));
  script += fmt::format("set xrange {}\nset yrange {}\n", x_range_text(panel), y_range_text(panel));
  const auto marks = distinct_marks(panel);
  const bool short_marks = marks.size() > most_long_marks;
  for (const double mark : marks) {
    script += fmt::format(
        "set arrow from first {0}, graph 0 to first {0}, graph {1} nohead back lw 1 dt {2} lc rgb '#999999'\n", mark,
        short_marks ? "0.04" : "1", short_marks ? 1 : 3);
  }
  script += "plot ";
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    Curve::Style style = panel.curves[i].style;
    const std::string& label = panel.curves[i].label;
    const std::size_t points = shown_points(panel, panel.curves[i]);
    if (points == 1 && is_line(style)) style = Curve::Style::full_points;  // a line to nowhere is none
    script += fmt::format(
        "{}{} with {} {}", i > 0 ? ", " : "",
        points > 0 ? fmt::format("$curve{}_{} using {}", number, i, style == Curve::Style::discs ? "1:2:3:4" : "1:2")
                   : "NaN",
        style_of(style, panel.curves[i].color, panel.curves[i].number.value_or(i)),
        label.empty() ? "notitle" : "title " + in_quotes(label));
  }
  if (!marks.empty())
    script += fmt::format(", NaN with lines lw 1 dt {} lc rgb '#999999' title {}", short_marks ? 1 : 3,
                          in_quotes(panel.mark_label));
  script += '\n';
}

/// Removes the file when the picture is drawn or not.
struct TemporaryFile {
  std::string path;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// The variables of this process, but the locale that knows UTF-8, as our scripts are written in it: in the locale C,
/// that of a bare machine, gnuplot warns that it cannot convert its sign of a degree.
std::vector<std::string> environment_for_utf8() {
  std::vector<std::string> variables{"LC_ALL=C.UTF-8"};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!std::string_view(*variable).starts_with("LC_ALL=")) variables.emplace_back(*variable);
  }
  return variables;
}

Status cannot_draw(std::string message) {
  return {.ending = Ending::unwritable, .message = std::move(message)};
}

Status run_gnuplot(const std::string& script_path) {
  std::string program = "gnuplot";
  std::string argument = script_path;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  std::vector<std::string> variables = environment_for_utf8();
  std::vector<char*> environment;
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  pid_t process = 0;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);  // standard output is for data
  const int problem = posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments, environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (problem == ENOENT)
    return cannot_draw("gnuplot draws the plots and is not installed: apt-get install gnuplot-nox");
  if (problem != 0) return cannot_draw(fmt::format("gnuplot could not be started: {}", std::strerror(problem)));
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    return cannot_draw("gnuplot draws the plots and is not installed: apt-get install gnuplot-nox");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return cannot_draw("gnuplot could not draw the plot; its message is above");
  return {};
}

}  // namespace

namespace {

/// Whether a picture has its end, which gnuplot leaves out without a word where a disk is full. What is no file on a
/// disk cannot be asked.
bool is_whole_picture(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return true;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  constexpr std::streamoff end_bytes = 16;
  const std::streamoff size = file.tellg();
  if (size < end_bytes) return false;
  std::string end(end_bytes, ' ');
  file.seekg(size - end_bytes);
  file.read(end.data(), end_bytes);
  const std::string ending = ending_of(path);
  return end.find(ending == ".png" ? "IEND" : ending == ".pdf" ? "%%EOF" : "</svg>") != std::string::npos;
}

/// What gnuplot calls a terminal: the format, its size and its letters. A PNG has two pixels for one, for screens that
/// show so many, where nobody has named its size.
std::string terminal_of(const Figure& figure, const std::string& ending, int usual_height) {
  const bool is_named = figure.size.width > 0;
  const int wide = is_named ? figure.size.width : width, high = is_named ? figure.size.height : usual_height;
  if (ending == ".png") {
    const int scale = is_named ? 1 : 2;
    return fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,{}' linewidth {}\n", scale * wide,
                       scale * high, 11 * scale, scale);
  }
  constexpr double pixels_per_inch = 96;
  if (ending == ".pdf")
    return fmt::format("set terminal pdfcairo noenhanced size {:.4f}in,{:.4f}in font 'sans,10' linewidth 1\n",
                       wide / pixels_per_inch, high / pixels_per_inch);
  return fmt::format("set terminal svg noenhanced size {},{} dynamic font 'sans-serif,13' background '#ffffff'\n", wide,
                     high);
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// As much of a curve as the picture needs.
Curve drawn(const Panel& panel, const Curve& curve) {
  if (curve.style == Curve::Style::area && !curve.widens_axes) {  // gnuplot leaves some of it beyond the frame
    return clipped(curve, range_of_x(panel), range_of_y(panel));
  }
  return is_line(curve.style) && !panel.logarithmic_x ? thinned(curve, 2 * width) : curve;
}

}  // namespace

Range axis_over(double low, double high, double air) {
  constexpr double highest = 4e307;  // gnuplot adds and subtracts such
  if (!(low <= high)) return {0, 1};
  low = std::clamp(low, -highest, highest), high = std::clamp(high, -highest, highest);
  double margin = air * (high - low);
  if (high == low || high - low < 1e-14 * std::max(std::abs(low), std::abs(high))) {
    margin = 0.01 * std::abs(low);
    if (low - margin == low) margin = 1;
  }
  return {low - margin, high + margin};
}

std::string_view color_of(std::size_t number) {
  return palette[number % std::size(palette)];
}

bool is_picture(std::string_view path) {
  const std::string ending = ending_of(std::string(path));
  return ending == ".svg" || ending == ".png" || ending == ".pdf";
}

std::string gnuplot_script(const Figure& figure, const std::string& path) {
  const int height = height_of(figure);
  std::string script;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    for (std::size_t c = 0; c < figure.panels[p].curves.size(); ++c) {
      const Panel& panel = figure.panels[p];
      append_data(script, panel, fmt::format("$curve{}_{}", p, c), drawn(panel, panel.curves[c]));
    }
  }
  script += terminal_of(figure, ending_of(path), height);
  script += fmt::format("set output {}\nset encoding utf8\n", in_quotes(path));
  script +=
      "set grid back lc rgb '#dddddd' lw 1 dt 1\nset border 3 lc rgb '#555555'\nset tics nomirror textcolor rgb "
      "'#333333'\n";
  script +=
      "set key outside top center horizontal autotitle columnhead samplen 2 spacing 1.1 textcolor rgb '#333333'\n";
  script += "set key noautotitle\nset lmargin 13\nset rmargin 3\n";
  script += fmt::format("set multiplot title {}\n", in_quotes(figure.title));
  int top = title_height;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const int own = height_of(figure.panels[p]);
    append_panel(script, figure.panels[p], p, 1 - static_cast<double>(top + own) / height,
                 static_cast<double>(own) / height);
    top += own;
  }
  return script + "unset multiplot\nunset output\n";
}

Status draw(const Figure& figure, const std::string& path) {
  if (!is_picture(path)) {
    return invalid_input(fmt::format("cannot plot to {}: the file's name ends in {}", path, picture_endings));
  }
  if (Status status = check_writable(path); !status)
    return status;  // a folder that is not there is our message, not gnuplot's

  std::string name = (std::filesystem::temp_directory_path() / "continuo-plot-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0)
    return {.ending = Ending::unwritable, .message = fmt::format("cannot write {}: {}", name, std::strerror(errno))};
  ::close(descriptor);
  const TemporaryFile file{name};
  // An older picture stays until the new one is whole.
  const bool is_file = place_of(path).kind == FilePlace::Kind::file;
  const TemporaryFile drawing{is_file ? free_unfinished_name(path) : std::string()};
  const std::string& target = is_file ? drawing.path : path;
  if (Status status = write_file(name, gnuplot_script(figure, target)); !status) return status;
  if (Status status = run_gnuplot(name); !status) return status;
  if (!is_whole_picture(target)) {
    return {.ending = Ending::unwritable,
            .message = fmt::format("cannot write {}: the picture is cut off, as where a disk is full", path)};
  }
  return is_file ? write_file(path, content_of(target)) : Status();
}

}  // namespace continuo::results
