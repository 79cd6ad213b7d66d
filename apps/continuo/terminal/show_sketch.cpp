// Chooses between pictures and braille by what the environment says of the terminal. Nothing is asked of the terminal
// itself: one that does not understand the question, or answers late, would leave its answer in the user's next line.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include <apps/continuo/terminal/base64.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/show_sketch.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <continuo/results/sketch.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t widest = 100, usual_width = 80, least_width = 30;  // characters
constexpr std::size_t most_panels = 2;                                   // below each other; a file shows all

std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

bool knows_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    std::string value(variable(name));
    if (value.empty()) continue;
    std::ranges::transform(value, value.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return value.find("utf-8") != std::string::npos || value.find("utf8") != std::string::npos;
  }
  return false;
}

std::size_t width_of_terminal() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return usual_width;
}

/// What shows pictures that are sent as text. Programs that divide a terminal among several would swallow them.
enum class Graphics { none, kitty, iterm };
Graphics graphics_of_terminal() {
  const std::string_view term = variable("TERM"), program = variable("TERM_PROGRAM");
  if (!variable("TMUX").empty() || term.starts_with("screen") || term.starts_with("tmux")) return Graphics::none;
  if (term == "xterm-kitty" || term == "xterm-ghostty" || program == "ghostty") return Graphics::kitty;
  if (program == "iTerm.app" || program == "WezTerm") return Graphics::iterm;
  return Graphics::none;
}

/// A PNG for https://sw.kovidgoyal.net/kitty/graphics-protocol/, which nobody answers (q=2), or for
/// https://iterm2.com/documentation-images.html.
std::string as_graphics(Graphics graphics, const std::string& png, std::size_t columns) {
  constexpr std::size_t chunk = 4096;
  const std::string letters = base64(png);
  if (graphics == Graphics::iterm)
    return fmt::format("\033]1337;File=inline=1;width={};preserveAspectRatio=1;size={}:{}\a\n", columns, png.size(),
                       letters);
  std::string text;
  for (std::size_t begin = 0; begin < letters.size(); begin += chunk) {
    text += fmt::format("\033_G{}m={};{}\033\\", begin == 0 ? fmt::format("a=T,f=100,q=2,c={},", columns) : "q=2,",
                        begin + chunk < letters.size() ? 1 : 0, letters.substr(begin, chunk));
  }
  return text + "\n";
}

bool show_graphics(Graphics graphics, results::Figure figure, std::size_t columns) {
  constexpr int pixels_of_character = 10;
  const ScratchFolder scratch;
  if (!scratch.exists()) return false;
  const std::string path = scratch.file("sketch.png");
  const int width = static_cast<int>(columns) * pixels_of_character;
  figure.size = {width, static_cast<int>(figure.panels.size()) * width * 3 / 8 + 40};
  if (!results::draw(figure, path)) return false;  // without gnuplot braille will do
  print(as_graphics(graphics, contents_of(path), columns));
  return true;
}

}  // namespace

bool can_show_sketch() {
  const std::string_view term = variable("TERM");
  return isatty(STDOUT_FILENO) == 1 && variable("NO_COLOR").empty() && !term.empty() && term != "dumb" &&
         term != "linux" && knows_utf8() && width_of_terminal() >= least_width;
}

void show_sketch(const results::Figure& figure) {
  results::Figure first = figure;
  if (first.panels.size() > most_panels) first.panels.resize(most_panels);
  const std::size_t columns = std::min(width_of_terminal() - 1, widest);
  const Graphics graphics = graphics_of_terminal();
  if (graphics != Graphics::none && show_graphics(graphics, first, columns)) return;
  for (const results::Panel& panel : first.panels)
    print("\n" + results::sketch(panel, {.columns = columns, .rows = panel.equal_scale ? 20U : 12U, .color = true}));
}

}  // namespace continuo::app
