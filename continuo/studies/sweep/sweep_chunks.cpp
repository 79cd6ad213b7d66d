// Writes and reads the files of chunks: a head, the numbers of each run, messages, and the hash of all that.
#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <continuo/results/output_file.hpp>
#include <continuo/results/sha256.hpp>
#include <continuo/studies/sweep/sweep_chunks.hpp>

namespace continuo::studies {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kind_of_file = "continuo sweep chunk 1\n", kind_of_folder = "continuo sweep folder 1\n";
constexpr std::string_view name_of_folder_file = "sweep.txt";
constexpr std::uint64_t many_chunks = 1024, most_bytes = std::uint64_t{8} << 20;
constexpr std::size_t hash_digits = 64;

/// Bytes from the lowest on, whatever the machine has.
void append(std::string& bytes, std::uint64_t number) {
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFF);
}
void append(std::string& bytes, double number) {
  append(bytes, std::bit_cast<std::uint64_t>(number));
}

/// Takes numbers and texts from the beginning of bytes; once they do not suffice, nothing more.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  std::string_view text(std::uint64_t size) {
    if (size > rest_.size()) fits_ = false;
    if (!fits_) return {};
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::uint64_t integer() {
    const std::string_view taken = text(8);
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < taken.size(); ++i)
      number |= static_cast<std::uint64_t>(static_cast<unsigned char>(taken[i])) << (8 * i);
    return number;
  }
  double number() { return std::bit_cast<double>(integer()); }
  bool fits() const { return fits_; }
  bool is_at_end() const { return fits_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool fits_ = true;
};

std::optional<std::string> content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return std::nullopt;
  std::string content(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)), '\0');
  file.seekg(0);
  file.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(file.gcount()));
  return file.bad() ? std::nullopt : std::optional(std::move(content));
}

std::string text_of(const SweepIdentity& identity) {
  return fmt::format("{}{}\n{} runs, {} in a chunk at most, {} numbers of each\n", kind_of_folder, identity.hash,
                     identity.runs, identity.per_chunk(), identity.width);
}

std::string head_of(const SweepIdentity& identity, std::uint64_t first, std::uint64_t size) {
  std::string bytes(kind_of_file);
  bytes += identity.hash + '\n';
  for (const std::uint64_t number : {first, size, identity.width}) append(bytes, number);
  return bytes;
}

Status unreadable(const std::string& path, std::string why) {
  return {.ending = Ending::unreadable, .message = std::move(why), .place = path};
}

/// Writes the file under another name and renames it. It need not be on the disk then: what a computer that stops
/// leaves of it is seen by its hash, and made again.
Status write_beside(const std::string& path, const std::string& bytes) {
  const std::string beside = fmt::format("{}.{:08x}.part", path, std::random_device()());
  const auto fail = [&] {
    const std::string reason = std::strerror(errno);
    std::remove(beside.c_str());
    return Status{.ending = Ending::unwritable, .message = fmt::format("cannot write {}: {}", path, reason)};
  };
  std::FILE* const file = std::fopen(beside.c_str(), "wbx");
  if (file == nullptr) return fail();
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool is_closed = std::fclose(file) == 0;
  return is_written && is_closed && std::rename(beside.c_str(), path.c_str()) == 0 ? Status() : fail();
}

/// The content without its hash; nothing where that is another one.
std::optional<std::string_view> proved(std::string_view content) {
  if (content.size() < hash_digits) return std::nullopt;
  const std::string_view body = content.substr(0, content.size() - hash_digits);
  if (results::sha256(body) != content.substr(body.size())) return std::nullopt;
  return body;
}

}  // namespace

std::uint64_t SweepIdentity::per_chunk() const {
  const std::uint64_t by_number = runs / many_chunks + 1;
  return std::max<std::uint64_t>(1, std::min(by_number, most_bytes / (8 * (width + 2))));
}

// With P runs in a chunk at most, chunk c has min(2^c, P): those before chunk L, the first with 2^L >= P, have 2^L - 1
// runs together.
std::uint64_t SweepIdentity::first_run(std::uint64_t chunk) const {
  const std::uint64_t most = per_chunk(), growing = std::bit_width(most - 1);
  if (chunk <= growing) return (std::uint64_t{1} << chunk) - 1;
  return (std::uint64_t{1} << growing) - 1 + (chunk - growing) * most;
}

std::uint64_t SweepIdentity::size(std::uint64_t chunk) const {
  return std::min(first_run(chunk + 1), runs) - first_run(chunk);
}

std::uint64_t SweepIdentity::chunks() const {
  const std::uint64_t most = per_chunk(), growing = std::bit_width(most - 1);
  const std::uint64_t before = (std::uint64_t{1} << growing) - 1;
  if (runs <= before) return std::bit_width(runs);
  return growing + (runs - before + most - 1) / most;
}

SweepIdentity identity_of(const PreparedSweep& sweep, const std::string& program) {
  return {.hash = results::sha256(program + '\n' + sweep.identity()), .runs = sweep.runs(), .width = sweep.width()};
}

bool SweepFolder::exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

Result<SweepFolder> SweepFolder::open(const std::string& path, SweepIdentity identity) {
  std::error_code error;
  fs::create_directory(path, error);
  if (error && !fs::is_directory(path))
    return Status{.ending = Ending::unwritable,
                  .message = fmt::format("cannot make the folder {}: {}", path, error.message())};
  const std::string wanted = text_of(identity), file = (fs::path(path) / name_of_folder_file).string();
  if (const auto found = content_of(file)) {
    if (*found == wanted) return SweepFolder(path, std::move(identity));
    return invalid_input(
        fmt::format("the folder {} is of another sweep, or of the same with other values, options, or "
                    "another version of Continuo: remove it, or write to another file",
                    path));
  }
  if (!fs::is_empty(path, error))
    return invalid_input(fmt::format("the folder {} is there already, and no folder of a sweep", path));
  if (Status status = results::write_file(file, wanted); !status) return status;
  return SweepFolder(path, std::move(identity));
}

std::string SweepFolder::file(std::uint64_t chunk) const {
  return (fs::path(path_) / fmt::format("{:07}.chunk", chunk)).string();
}

Status SweepFolder::write(std::uint64_t chunk, const std::vector<SweepOutcome>& outcomes) const {
  if (outcomes.size() != identity_.size(chunk)) return invalid_input("a chunk is stored with all of its runs");
  std::string bytes = head_of(identity_, identity_.first_run(chunk), outcomes.size());
  std::uint64_t messages = 0;
  for (const SweepOutcome& outcome : outcomes) {
    append(bytes, static_cast<std::uint64_t>(outcome.ending));
    append(bytes, outcome.t);
    for (const double value : outcome.kept) append(bytes, value);
    messages += outcome.message.empty() ? 0 : 1;
  }
  append(bytes, messages);
  for (std::uint64_t i = 0; i < outcomes.size(); ++i) {
    const std::string& message = outcomes[static_cast<std::size_t>(i)].message;
    if (message.empty()) continue;
    append(bytes, i);
    append(bytes, std::uint64_t{message.size()});
    bytes += message;
  }
  bytes += results::sha256(bytes);
  return write_beside(file(chunk), bytes);
}

Result<std::vector<SweepOutcome>> SweepFolder::read(std::uint64_t chunk) const {
  const std::string path = file(chunk);
  const auto content = content_of(path);
  if (!content) return unreadable(path, "this chunk is missing");
  const auto body = proved(*content);
  const std::string head = head_of(identity_, identity_.first_run(chunk), identity_.size(chunk));
  if (!body || !body->starts_with(head)) return unreadable(path, "this chunk is cut short or damaged");
  Bytes bytes(body->substr(head.size()));
  std::vector<SweepOutcome> outcomes(static_cast<std::size_t>(identity_.size(chunk)));
  for (SweepOutcome& outcome : outcomes) {
    const std::uint64_t ending = bytes.integer();
    if (ending > static_cast<std::uint64_t>(last_ending)) return unreadable(path, "this chunk is damaged");
    outcome.ending = static_cast<Ending>(ending);
    outcome.t = bytes.number();
    outcome.kept.resize(static_cast<std::size_t>(identity_.width));
    for (double& value : outcome.kept) value = bytes.number();
  }
  for (std::uint64_t left = bytes.integer(); left > 0 && bytes.fits(); --left) {
    const std::uint64_t run = bytes.integer(), length = bytes.integer();
    const std::string_view message = bytes.text(length);
    if (run < outcomes.size()) outcomes[static_cast<std::size_t>(run)].message = message;
  }
  if (!bytes.is_at_end()) return unreadable(path, "this chunk is damaged");
  return outcomes;
}

ChunkState SweepFolder::state(std::uint64_t chunk) const {
  const auto content = content_of(file(chunk));
  if (!content) return ChunkState::missing;
  const auto body = proved(*content);
  const bool is_whole =
      body && body->starts_with(head_of(identity_, identity_.first_run(chunk), identity_.size(chunk)));
  return is_whole ? ChunkState::whole : ChunkState::damaged;
}

std::vector<std::uint64_t> SweepFolder::missing() const {
  std::vector<std::uint64_t> left;
  for (std::uint64_t chunk = 0; chunk < identity_.chunks(); ++chunk)
    if (state(chunk) != ChunkState::whole) left.push_back(chunk);
  return left;
}

Status SweepFolder::remove() const {
  std::error_code error;
  fs::remove_all(path_, error);
  if (!error) return {};
  return {.ending = Ending::unwritable, .message = fmt::format("cannot remove {}: {}", path_, error.message())};
}

}  // namespace continuo::studies
