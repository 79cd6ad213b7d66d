// apps/continuo/browser.cpp
#include <array>

#include <apps/continuo/browser.hpp>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace continuo::app {

void open_browser(const std::string& url) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // By a shell that ends at once: the browser is nobody's child, and is not waited for.
  std::string shell = "sh", option = "-c", script = "command -v xdg-open >/dev/null && (xdg-open \"$1\" &)",
              name = "view", address = url;
  std::array<char*, 6> words = {shell.data(), option.data(), script.data(), name.data(), address.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "sh", &actions, nullptr, words.data(), environ) == 0) waitpid(child, nullptr, 0);
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace continuo::app
