// Collects the files of a command line, and refuses what would be written over another one.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <continuo/language/syntax/parser.hpp>
#include <continuo/language/text/source.hpp>
#include <continuo/results/file_place.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/table_file.hpp>

namespace continuo::app {
namespace {

namespace fs = std::filesystem;
using results::FilePlace;
using Use = FileOption::Use;

/// A file of the command line, with the words that it has in messages.
struct NamedFile {
  std::string path, role;  // "ball.sim", "the model"; "--guess"
  FilePlace place{};
  bool is_folder_of_pictures = false;
};

/// "-o"; of what stands without an option "the file".
std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return "the " + option.get_name(true);
  return option.get_snames().empty() ? "--" + option.get_lnames().front() : "-" + option.get_snames().front();
}

/// "--plot ball.svg"
std::string role_and_path(const NamedFile& file) {
  return file.path.empty() ? file.role : file.role + " " + file.path;
}

CLI::Option* declare(CLI::App& verb, FileOption file, CLI::Option* option) {
  file.option = option;
  option->type_name(option->get_positional() ? "" : file.use == Use::written_as_pictures ? "PATH" : "FILE");
  dynamic_cast<Verb&>(verb).files.push_back(std::move(file));
  return option;
}

bool is_picture_of(const NamedFile& file, const NamedFile& pictures) {
  if (!pictures.is_folder_of_pictures || file.place.path.parent_path() != pictures.place.path) return false;
  const std::string name = file.place.path.filename().string();
  return name.ends_with(".png") &&
         std::all_of(name.begin(), name.end() - 4, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_one_file(const NamedFile& a, const NamedFile& b) {
  return a.place == b.place || is_picture_of(a, b) || is_picture_of(b, a);
}

/// Standard output or the messages, where these go into a file.
std::optional<NamedFile> redirected(int descriptor, const char* role) {
  NamedFile file{.path = "", .role = role, .place = results::place_of_open(descriptor)};
  return file.place.kind == FilePlace::Kind::file ? std::optional(std::move(file)) : std::nullopt;
}

/// All files of a command line.
class Files {
 public:
  explicit Files(const std::vector<FileOption>& options) {
    for (const FileOption& option : options)
      for (const std::string& path : option.option->results()) add(option, path);
    if (!written_.empty()) {
      for (const auto& file :
           {redirected(STDOUT_FILENO, "standard output"), redirected(STDERR_FILENO, "standard error")})
        if (file) streams_.push_back(*file);
    }
  }

  std::string fault(bool prints_data) const {
    for (std::size_t i = 0; i < written_.size(); ++i) {
      const auto& [file, option] = written_[i];
      for (const auto& fault : {fault_of_inputs(file), fault_of_others(i), fault_of_streams(file, prints_data),
                                fault_of_place(file, *option)})
        if (!fault.empty()) return fault;
    }
    return {};
  }

 private:
  void add(const FileOption& option, const std::string& path) {
    if (option.names_file && !option.names_file(path)) return;
    NamedFile file{.path = path, .role = name_of(*option.option), .place = results::place_of(path)};
    if (option.use == Use::read) {
      if (path == "-") file.place = results::place_of_open(STDIN_FILENO);
      read_.emplace_back(std::move(file), &option);
      return;
    }
    file.is_folder_of_pictures = option.use == Use::written_as_pictures && fs::path(path).extension().empty();
    const bool has_beside = !option.beside.empty() && file.place.kind == FilePlace::Kind::file &&
                            !file.place.descriptor && option.instead_of->count() == 0;
    written_.emplace_back(std::move(file), &option);
    if (has_beside)
      written_.emplace_back(NamedFile{.path = path + option.beside,
                                      .role = "the file beside " + name_of(*option.option),
                                      .place = results::place_of(path + option.beside)},
                            &beside_);
  }

  static std::string fault_of_place(const NamedFile& file, const FileOption& option) {
    if (option.use == Use::written_as_table) return results::check_table(file.path).message;
    if (option.use == Use::written_as_pictures && file.path == "-")
      return fmt::format("{} takes the name of a folder or of a film; pictures do not go to standard output",
                         file.role);
    if (option.use == Use::written_as_pictures && file.is_folder_of_pictures) return {};
    const bool has_ending =
        option.endings.empty() || file.place.kind == FilePlace::Kind::stream || file.place.descriptor ||
        std::ranges::find(option.endings, fs::path(file.path).extension().string()) != option.endings.end();
    if (!has_ending)
      return fmt::format("cannot write {}: the ending of its name says the format, and {} writes {}", file.path,
                         file.role, fmt::join(option.endings, " or "));
    return results::check_writable(file.path).message;
  }

  std::string fault_of_inputs(const NamedFile& output) const {
    for (const auto& [input, option] : read_) {
      if (is_one_file(input, output)) return is_input(output, role_and_path(input));
      if (!option->files_of) continue;
      for (const std::string& path : option->files_of(input.path))
        if (is_one_file({.path = path, .role = "", .place = results::place_of(path)}, output))
          return is_input(output, fmt::format("{}, which {} reads", path, role_and_path(input)));
    }
    return {};
  }
  static std::string is_input(const NamedFile& output, const std::string& input) {
    return fmt::format("cannot write {} ({}): it is read as input, {}; give another name", output.path, output.role,
                       input);
  }

  std::string fault_of_others(std::size_t i) const {
    const NamedFile& file = written_[i].first;
    for (std::size_t k = 0; k < i; ++k) {
      const NamedFile& other = written_[k].first;
      if (file.place.descriptor && file.place.descriptor == other.place.descriptor)
        return fmt::format("{} and {} would be mixed: give one of them the name of a file", role_and_path(other),
                           role_and_path(file));
      if (is_one_file(file, other))
        return fmt::format("cannot write {} twice, as {} and as {}: each output needs a name of its own", file.path,
                           other.role, file.role);
    }
    return {};
  }

  /// What is printed goes nowhere else where standard output is that file.
  std::string fault_of_streams(const NamedFile& file, bool prints_data) const {
    if (prints_data && file.place.descriptor == STDOUT_FILENO)
      return fmt::format("{} and --json would be mixed: give {} the name of a file", role_and_path(file), file.role);
    if (file.place.descriptor) return {};
    for (const NamedFile& stream : streams_)
      if (is_one_file(file, stream))
        return fmt::format("cannot write {} ({}): {} goes there; give another name", file.path, file.role, stream.role);
    return {};
  }

  std::vector<std::pair<NamedFile, const FileOption*>> read_, written_;
  std::vector<NamedFile> streams_;
  FileOption beside_{.use = Use::written};
};

}  // namespace

CLI::Option* reads_file(CLI::App& verb, CLI::Option* option, FilesOf files_of) {
  return declare(verb, {.use = Use::read, .files_of = std::move(files_of)}, option);
}
CLI::Option* writes_file(CLI::App& verb, CLI::Option* option, std::vector<std::string_view> endings,
                         bool (*names_file)(const std::string&)) {
  return declare(verb, {.use = Use::written, .endings = std::move(endings), .names_file = names_file}, option);
}
CLI::Option* writes_table(CLI::App& verb, CLI::Option* option) {
  return declare(verb, {.use = Use::written_as_table}, option);
}
CLI::Option* writes_pictures(CLI::App& verb, CLI::Option* option) {
  return declare(verb, {.use = Use::written_as_pictures}, option);
}

void writes_beside(CLI::App& verb, const CLI::Option* option, std::string suffix, const CLI::Option* named_by) {
  auto& files = dynamic_cast<Verb&>(verb).files;
  const auto file = std::ranges::find(files, option, &FileOption::option);
  file->beside = std::move(suffix);
  file->instead_of = named_by;
}

std::string fault_of_files(const std::vector<FileOption>& options, bool prints_data) {
  return Files(options).fault(prints_data);
}

namespace {

/// The files of meshes and chains, also of those in families.
void add_files_of(const std::vector<model::ast::WorldItem>& items, const auto& add) {
  for (const model::ast::WorldItem& item : items) {
    if (const auto* family = std::get_if<model::ast::WorldFamily>(&item.node)) add_files_of(family->body, add);
    const auto* mesh = std::get_if<model::ast::WorldMesh>(&item.node);
    const auto* file = mesh ? std::get_if<model::ast::Text>(&mesh->corners.node) : nullptr;
    if (file) add(file->value);
  }
}

}  // namespace

std::vector<std::string> files_of_text(const std::string& path, const std::string& text) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& file) {
    if (!file.empty()) files.push_back((fs::path(path).parent_path() / file).string());
  };
  for (const model::ast::Statement& statement : model::parse(model::Source(path, text)).model.statements) {
    if (const auto* table = std::get_if<model::ast::Table>(&statement.node)) add(table->file);
    if (const auto* input = std::get_if<model::ast::Input>(&statement.node)) add(input->file.value_or(""));
    if (const auto* world = std::get_if<model::ast::World>(&statement.node)) add_files_of(world->items, add);
  }
  return files;
}

std::vector<std::string> files_of_model(const std::string& path) {
  const auto source = model::read_source(path);
  return source ? files_of_text(path, std::string(source->text())) : std::vector<std::string>();
}

}  // namespace continuo::app
