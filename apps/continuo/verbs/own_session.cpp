// Starts and serves the sessions of viewers.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include <apps/continuo/verbs/own_session.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <continuo/live/loop.hpp>
#include <continuo/live/session.hpp>

namespace continuo::app {
namespace {

// The descriptors that such a process begins with.
constexpr int connection = 3, letter = 4;

/// Half of the memory of this computer, shared by all that there may be.
std::size_t memory_of_each() {
  constexpr std::size_t least = std::size_t{128} << 20, enough = std::size_t{1} << 30;
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  const std::size_t all = pages > 0 && page > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page) : 0;
  return std::clamp(all / 2 / OwnSessions::most, least, enough);
}

/// A file in memory that holds this text, to be read from its beginning. -1 where there is none.
int file_with(const std::string& text) {
  const int file = ::memfd_create("session", MFD_CLOEXEC);
  if (file < 0) return -1;
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (written && ::lseek(file, 0, SEEK_SET) == 0) return file;
  ::close(file);
  return -1;
}

/// The seconds since this file was changed or touched.
double age_of(int file) {
  struct stat facts{};
  timespec now{};
  if (::fstat(file, &facts) != 0 || ::clock_gettime(CLOCK_REALTIME, &now) != 0) return 0;
  return static_cast<double>(now.tv_sec - facts.st_mtim.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec - facts.st_mtim.tv_nsec);
}

/// This program again, with these two descriptors and no other.
pid_t start_again(const std::vector<std::string>& words, int socket, int file) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  // Above those that they become.
  const int from = ::fcntl(socket, F_DUPFD_CLOEXEC, 10), text = ::fcntl(file, F_DUPFD_CLOEXEC, 10);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int standard : {0, 1, 2}) posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&actions, from, connection);
  posix_spawn_file_actions_adddup2(&actions, text, letter);
  posix_spawn_file_actions_addclosefrom_np(&actions, letter + 1);
  pid_t process = -1;
  const int error = ::posix_spawn(&process, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(from);
  ::close(text);
  return error == 0 ? process : -1;
}

/// What this process may use from here on.
void limit(std::size_t memory) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);                   // it ends with the presenter's view
  std::ofstream("/proc/self/oom_score_adj") << "1000";  // where memory is short they are the first to end
  ::setpriority(PRIO_PROCESS, 0, 19);                   // 40 of them weigh less than the presenter's thread
  const rlimit space{memory, memory}, none{0, 0};
  ::setrlimit(RLIMIT_DATA, &space);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);  // it writes nothing
}

}  // namespace

struct OwnSessions::Process {
  Process() = default;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (letter >= 0) ::close(letter);
  }

  void end() const {
    if (id > 0) ::kill(id, SIGKILL);  // of another sign it would be a group of processes, or all
  }

  pid_t id = -1;
  int letter = -1;  // what it began with; touched whenever its viewer does something
  std::unique_ptr<live::Places::Place> place;
};

OwnSessions::OwnSessions(std::vector<std::string> models) : models_(std::move(models)) {}
OwnSessions::~OwnSessions() = default;

void OwnSessions::forget_ended() {
  std::erase_if(processes_, [](const auto& process) { return ::waitpid(process->id, nullptr, WNOHANG) != 0; });
}

bool OwnSessions::start(const live::OwnSession& session) {
  forget_ended();
  const auto found = std::ranges::find_if(
      models_, [&](const std::string& path) { return std::filesystem::path(path).filename() == session.path; });
  if (found == models_.end()) return false;
  auto own = std::make_unique<Process>();
  own->place = places_.enter(
      live::Guest::owner, session.address, [process = own.get()] { process->end(); },
      [process = own.get()] { return age_of(process->letter); });
  if (!own->place) return false;
  const nlohmann::json text = {{"request", session.request}, {"text", session.text}};
  own->letter = file_with(text.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (own->letter < 0) return false;
  own->id = start_again({"continuo", "view", "--own-session", fmt::format("{}", memory_of_each()), "--", *found},
                        session.socket, own->letter);
  if (own->id < 0) return false;
  processes_.push_back(std::move(own));
  return true;
}

ExitCode serve_own_session(const std::string& file, std::vector<live::GalleryModel> gallery, std::size_t memory) {
  limit(memory);
  std::ifstream stream(fmt::format("/proc/self/fd/{}", letter), std::ios::binary);
  const auto begin = nlohmann::json::parse(std::istreambuf_iterator<char>(stream), {}, nullptr, false);
  if (begin.is_discarded() || !begin.contains("request") || !begin.contains("text")) return usage;
  live::Server server({.model_path = file, .may_save = false}, [](const std::string&) {});
  live::Session session(live::steady_seconds, server, {.path = file, .gallery = std::move(gallery), .writable = false});
  live::Loop loop(session, [&](std::uint64_t client, const std::string& problem) { server.complain(client, problem); });
  std::atomic<bool> came = false, left = false;
  server.start(
      {.command = [&](live::Command command, std::uint64_t client) { return loop.post(std::move(command), client); },
       .rate = [&](double pictures) { loop.set_rate(pictures); },
       .attached = [&](std::size_t clients) { clients > 0 ? came = true : left = came.load(); },
       .watch = [&] { return loop.watch(); },
       .acted = [] { ::futimens(letter, nullptr); }});
  const nlohmann::json run = {{"do", "run"}, {"text", begin["text"]}};
  loop.post({"run", run.dump()}, 0);
  loop.post({"play", R"({"do": "play"})"}, 0);
  loop.start();
  server.adopt(connection, begin["request"]);
  // Who leaves ends it at once, whatever it is at: there is nothing to keep.
  constexpr auto moment = std::chrono::milliseconds(50), patience = std::chrono::milliseconds(20'000);
  for (auto waited = moment; !left && (came || waited < patience); waited += moment)
    std::this_thread::sleep_for(moment);
  std::_Exit(done);
}

}  // namespace continuo::app
