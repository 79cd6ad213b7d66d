// A file or standard output, written through a buffer that keeps the first failure.
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include <continuo/results/output_file.hpp>

namespace continuo::results {
namespace {
constexpr std::size_t buffer_bytes = 1 << 16;
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  file_ = path_ == "-" ? stdout : std::fopen(path_.c_str(), "wb");
  if (file_ == nullptr) fail();
}

OutputFile::~OutputFile() {
  (void)close();
}

void OutputFile::write(std::string_view bytes) {
  if (!status_) return;
  buffer_ += bytes;
  if (buffer_.size() >= buffer_bytes) flush();
}

void OutputFile::flush() {
  if (file_ == nullptr) return;
  if (status_ && std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size()) fail();
  buffer_.clear();
}

void OutputFile::fail() {
  if (!status_) return;
  status_ = {.ending = Ending::unwritable,
             .message = "cannot write " + (path_ == "-" ? std::string("to standard output") : path_) + ": " +
                        std::strerror(errno)};
}

Status OutputFile::close() {
  flush();
  if (file_ != nullptr) {
    if ((file_ == stdout ? std::fflush(file_) : std::fclose(file_)) != 0) fail();
    file_ = nullptr;
  }
  return status_;
}

Status write_file(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  return file.close();
}

}  // namespace continuo::results
