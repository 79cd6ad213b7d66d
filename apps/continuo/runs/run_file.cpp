// Adds --record, and writes and reads the file of a recording.
#include <array>
#include <fstream>
#include <span>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/runs/run_file.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {

OutputStream::OutputStream(const std::string& path) : std::ostream(nullptr), buffer_(path) {
  rdbuf(&buffer_);
}

std::streamsize OutputStream::Buffer::xsputn(const char* bytes, std::streamsize count) {
  file.write({bytes, static_cast<std::size_t>(count)});
  return file.status() ? count : 0;
}
OutputStream::Buffer::int_type OutputStream::Buffer::overflow(int_type byte) {
  const char letter = traits_type::to_char_type(byte);
  return xsputn(&letter, 1) == 1 ? byte : traits_type::eof();
}
int OutputStream::Buffer::sync() {
  file.flush();
  return file.status() ? 0 : -1;
}

void add_record(CLI::App& verb, RecordTo& record) {
  auto* path =
      writes_file(verb, verb.add_option("--record", record.path, "Records the run, for replay and resume"), {".run"});
  verb.add_option("--snapshots", record.checkpoints,
                  "Number of snapshots in the recording, from which resume can start (20)")
      ->type_name("N")
      ->check(count_from(0, 100'000))
      ->needs(path);
}

bool can_be_written(const RecordTo& record) {
  if (record.path != "-") return true;
  say("--record takes the name of a file");
  return false;
}

runs::Log* RunFile::begin(const model::ModelProgram& program, model::RunHead head) {
  if (!is_wanted()) return nullptr;
  head.version = CONTINUO_VERSION;
  head.data = checksum_of_tables(program);
  out_.emplace(to_.path);
  log_ = std::make_unique<runs::Log>(*out_, program.model, head, to_.checkpoints);
  return log_.get();
}

bool RunFile::finish(const model::Simulated& simulated) {
  if (!out_) return true;
  results::OutputFile& file = out_->file();
  if (!simulated.run) {
    file.discard();
    return true;
  }
  const bool is_interrupted = simulated.run->outcome.ending == Ending::interrupted;
  if (!written(is_interrupted ? file.leave() : file.close())) return false;
  if (is_interrupted && !file.present_name().empty()) {
    say(fmt::format("the recording is in {}{}", file.present_name(),
                    to_.checkpoints > 0 ? "; it goes on by continuo resume " + file.present_name() : ""));
  }
  return true;
}

std::optional<runs::Recording> read_run(const std::string& path) {
  if (!readable(path)) return std::nullopt;
  const std::string text = contents_of(path);
  Result<runs::Recording> recording = runs::read_recording(std::as_bytes(std::span(text)));
  if (recording) return *std::move(recording);
  say(fmt::format("{}: {}", name_of_file(path), recording.status().message));
  return std::nullopt;
}

bool has_changed(const model::RunHead& head, const model::ModelProgram& program, const std::string& path) {
  if (head.version != CONTINUO_VERSION) {
    say(fmt::format("{} was recorded by Continuo {}, this is {}: its steps may differ; run the model again", path,
                    head.version, CONTINUO_VERSION));
    return true;
  }
  if (head.data != checksum_of_tables(program)) {
    say(fmt::format("{}: a file that {} reads has changed since: run the model again", path, head.file));
    return true;
  }
  return false;
}

std::vector<std::string> files_of_recording(const std::string& path) {
  constexpr std::size_t beginning = std::size_t{16} << 20;  // bytes; the text of the model is in the first block
  std::ifstream file(path, std::ios::binary);
  Bytes bytes(beginning);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  // A file that ends anywhere is read as far as it goes.
  const Result<runs::Recording> recording = runs::read_recording(bytes);
  if (!recording) return {};
  const model::RunHead& head = runs::head_of(*recording);
  std::vector<std::string> files = files_of_text(head.file, head.text);
  files.push_back(head.file);  // the recording has its text, and yet it is somebody's model
  return files;
}

}  // namespace continuo::app
