// continuo/live/session/commands.hpp
// What a client says, who may say it, and what it does. Nothing that comes over a wire can do more than what stands
// here.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <continuo/live/session.hpp>
#include <continuo/status/result.hpp>

namespace continuo::live {

/// Who a client is: by the token it came with.
enum class Role {
  presenter,  // whose session it is
  viewer,     // sees it
  owner,      // a viewer in a session of their own
};

/// What a client may do.
struct Rights {
  Role role = Role::viewer;
  bool may_save = false;  // the presenter: the file of the model
};

/// Whether the command is known, is classified, and is one that this client may give.
[[nodiscard]] bool may(const Rights& rights, std::string_view command);
/// All such commands, for a page to offer.
[[nodiscard]] std::vector<std::string_view> allowed(const Rights& rights);
/// All commands there are.
[[nodiscard]] std::vector<std::string_view> all_commands();

/// A text of docs/protocol.md as JSON: an object with a member `do`, its parts of the right kind.
struct Command {
  std::string what;  // of "do"
  std::string text;  // the whole
};
Result<Command> read_command(std::string text);

Status obey(Session& session, const Command& command);

/// `check {id, text}`, `ping {id}`, `rate {fps}`: of whom the session does not know.
struct Asked {
  double number = 0;
  std::string text;
};
Result<Asked> asked(const Command& command);

}  // namespace continuo::live
