// The files that a verb reads and writes, declared with the options that name them. Before a verb does anything, every
// file that it is to write is held against all that it reads and all others that it writes: no verb can forget it.
//
//   reads_file(*verb, verb->add_option("file", options.file, "The model")->required(), files_of_model);
//   writes_file(*verb, verb->add_option("--plot", options.plot, "Writes a plot"));
#pragma once
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>

namespace continuo::app {

/// What a file reads in turn: the tables of a model.
using FilesOf = std::function<std::vector<std::string>(const std::string& file)>;

/// What an option has to do with the file that it names.
struct FileOption {
  enum class Use { read, written, written_as_table, written_as_pictures };  // the last: a folder, or a film
  const CLI::Option* option = nullptr;
  Use use = Use::read;
  FilesOf files_of{};                                // of a file that is read
  std::vector<std::string_view> endings{};           // that the name may have; empty for any
  bool (*names_file)(const std::string&) = nullptr;  // of an option that takes other texts as well
  std::string beside{};                              // what a file written beside it has behind its name,
  const CLI::Option* instead_of = nullptr;           // unless this option names that one
};

/// The option names a file that is read, or several. "-" is standard input.
CLI::Option* reads_file(CLI::App& verb, CLI::Option* option, FilesOf files_of = {});
/// The option names a file that is written; "-" is standard output. Its name has one of the endings where there are
/// any. `names_file` tells names of files from other texts that the option takes.
CLI::Option* writes_file(CLI::App& verb, CLI::Option* option, std::vector<std::string_view> endings = {},
                         bool (*names_file)(const std::string&) = nullptr);
/// A table, whose format is said by its ending (results/table_file.hpp).
CLI::Option* writes_table(CLI::App& verb, CLI::Option* option);
/// A folder of pictures, or a film.
CLI::Option* writes_pictures(CLI::App& verb, CLI::Option* option);
/// With the file of `option` comes another one, of its name and `suffix`, unless `named_by` names that one.
void writes_beside(CLI::App& verb, const CLI::Option* option, std::string suffix, const CLI::Option* named_by);

/// The names of all options of all verbs that write a file.
inline constexpr std::array<std::string_view, 7> options_that_write{"-o",       "--out",    "--events", "--manifest",
                                                                    "--record", "--export", "--plot"};

/// What is wrong with the files of a command line: "cannot write ball.sim (-o): ..."; empty for nothing. `prints_data`:
/// standard output is for data already.
[[nodiscard]] std::string fault_of_files(const std::vector<FileOption>& options, bool prints_data);

/// The files that the text of a model names: its tables, the values of its inputs, its meshes and chains.
[[nodiscard]] std::vector<std::string> files_of_model(const std::string& path);
[[nodiscard]] std::vector<std::string> files_of_text(const std::string& path, const std::string& text);

}  // namespace continuo::app
