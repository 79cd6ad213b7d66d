// continuo/live/session/commands.hpp
// What a client says, read and obeyed. Nothing that comes over a wire can do more than what stands here.
#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <continuo/live/session.hpp>
#include <continuo/status/result.hpp>

namespace continuo::live {

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
