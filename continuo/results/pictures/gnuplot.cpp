// Writes a figure as a gnuplot script with its data, and runs gnuplot on it.
#include <cerrno>
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

#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/pictures/gnuplot_panel.hpp>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX wants it declared by its user

namespace continuo::results {
namespace {

constexpr int panel_height = 300, square_height = 720, title_height = 40;  // pixels

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
  const int wide = is_named ? figure.size.width : width_of_pictures,
            high = is_named ? figure.size.height : usual_height;
  const std::string behind =
      figure.is_dark ? fmt::format(" background '{}'", theme_of(true).background) : std::string();
  if (ending == ".png") {
    const int scale = is_named ? 1 : 2;
    return fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,{}' linewidth {}{}\n", scale * wide,
                       scale * high, 11 * scale, scale, behind);
  }
  constexpr double pixels_per_inch = 96;
  if (ending == ".pdf")
    return fmt::format("set terminal pdfcairo noenhanced size {:.4f}in,{:.4f}in font 'sans,10' linewidth 1{}\n",
                       wide / pixels_per_inch, high / pixels_per_inch, behind);
  return fmt::format("set terminal svg noenhanced size {},{} dynamic font 'sans-serif,13' background '{}'\n", wide,
                     high, theme_of(figure.is_dark).background);
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

bool is_picture(std::string_view path) {
  const std::string ending = ending_of(std::string(path));
  return ending == ".svg" || ending == ".png" || ending == ".pdf";
}

std::string gnuplot_script(const Figure& figure, const std::string& path) {
  const int height = height_of(figure);
  std::string script;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) append_panel_data(script, figure.panels[p], p);
  script += terminal_of(figure, ending_of(path), height);
  script += fmt::format("set output {}\nset encoding utf8\n", in_quotes(path));
  const Theme& theme = theme_of(figure.is_dark);
  script += fmt::format(
      "set grid back lc rgb '{0}' lw 1 dt 1\nset border 3 lc rgb '{1}'\nset tics nomirror textcolor rgb '{2}'\n",
      theme.grid, theme.frame, theme.text);
  script += fmt::format(
      "set key outside top center horizontal autotitle columnhead samplen 2 spacing 1.1 textcolor rgb '{}'\n",
      theme.text);
  script += "set key noautotitle\nset lmargin 13\n";
  if (figure.is_dark)
    script +=
        fmt::format("set xlabel textcolor rgb '{0}'\nset ylabel textcolor rgb '{0}'\nset cblabel textcolor rgb '{0}'\n",
                    theme.text);
  script += fmt::format("set multiplot title {}{}\n", in_quotes(figure.title),
                        figure.is_dark ? fmt::format(" textcolor rgb '{}'", theme.text) : "");
  int top = title_height;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const int own = height_of(figure.panels[p]);
    append_panel(script, figure.panels[p], p, figure.is_dark, 1 - static_cast<double>(top + own) / height,
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
