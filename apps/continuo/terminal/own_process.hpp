// This command, called by itself: what another verb prints, as text.
#pragma once
#include <string>
#include <vector>

namespace continuo::app {

struct Printed {
  int exit = -1;  // -1: it could not be started
  std::string out, err;
};

/// `continuo ARGUMENTS...`, its output caught; its standard input is the file `input`.
Printed call_self(const std::vector<std::string>& arguments, const std::string& input);

/// A folder that goes when the value does.
class ScratchFolder {
 public:
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  /// A file in it; the folder's name is empty where it could not be made.
  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  bool exists() const { return !folder_.empty(); }

 private:
  std::string folder_;
};

/// The whole file, empty where there is none; of `-`, standard input to its end.
std::string contents_of(const std::string& path);

/// Words of a command line; double quotes hold spaces together.
std::vector<std::string> words_of(const std::string& line);

}  // namespace continuo::app
