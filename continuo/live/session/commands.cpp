// continuo/live/session/commands.cpp
// Reads commands from JSON, and calls the session.
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <continuo/live/session/commands.hpp>

namespace continuo::live {

namespace {

using nlohmann::json;

/// A part that is not there, or of another kind.
struct Unfit {
  std::string part;
};

double number(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || !found->is_number()) throw Unfit{std::string(part) + ", a number"};
  return found->get<double>();
}

std::string word(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || !found->is_string()) throw Unfit{std::string(part) + ", a text"};
  return found->get<std::string>();
}

std::optional<double> perhaps_number(const json& command, const char* part) {
  const auto found = command.find(part);
  return found == command.end() || found->is_null() ? std::nullopt : std::optional(number(command, part));
}

bool perhaps_true(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || found->is_null()) return false;
  if (!found->is_boolean()) throw Unfit{std::string(part) + ", true or false"};
  return found->get<bool>();
}

std::size_t index(const json& command, const char* part) {
  const double value = number(command, part);
  if (!(value >= 0 && value < 1e9)) throw Unfit{std::string(part) + ", the number of a thing"};
  return static_cast<std::size_t>(value);
}

MethodChoice method_of(const json& command) {
  return {
      .name = word(command, "name"), .step = perhaps_number(command, "step"), .rtol = perhaps_number(command, "rtol")};
}

void drag(Session& session, const json& command) {
  const auto to = command.find("to");
  if (to == command.end() || !to->is_array() || to->size() > 3) throw Unfit{"to, two or three numbers"};
  std::vector<double> point;
  for (const json& coordinate : *to) {
    if (!coordinate.is_number()) throw Unfit{"to, two or three numbers"};
    point.push_back(coordinate.get<double>());
  }
  if (command.contains("body")) return session.drag_body(index(command, "body"), point);
  session.drag(index(command, "item"), point);
}

using Doing = void (*)(Session&, const json&);

/// What a command touches, which decides who may give it. One that is not classified is refused to everybody.
enum class Touches {
  unclassified,
  connection,  // of who gives it: anybody
  session,     // the one that is looked at: whose it is
  file,        // that of the model: the presenter, where saving is allowed
};

struct Entry {
  std::string_view name;
  Touches touches = Touches::unclassified;
  Doing doing = nullptr;  // null: the server's business
};

void take_ghost(Session& session, const json& command) {
  const auto name = command.find("name");
  if (name == command.end() || name->is_null()) {
    session.take_ghost(std::nullopt);
  } else {
    session.take_ghost(method_of(command));
  }
}

/// The one table of commands: the server refuses by it, and tells the page what to offer.
constexpr std::array table = {
    Entry{"ping", Touches::connection},
    Entry{"rate", Touches::connection},
    Entry{"check", Touches::session},
    Entry{"play", Touches::session, [](Session& s, const json&) { s.play(); }},
    Entry{"pause", Touches::session, [](Session& s, const json&) { s.pause(); }},
    Entry{"cancel", Touches::session, [](Session& s, const json&) { s.pause(); }},
    Entry{"step", Touches::session, [](Session& s, const json&) { s.step(); }},
    Entry{"back", Touches::session, [](Session& s, const json&) { s.back(); }},
    Entry{"reset", Touches::session, [](Session& s, const json&) { s.reset(); }},
    Entry{"until_event", Touches::session, [](Session& s, const json&) { s.until_event(); }},
    Entry{"restore", Touches::session, [](Session& s, const json&) { s.restore_parameters(); }},
    Entry{"undo", Touches::session, [](Session& s, const json&) { s.undo(); }},
    Entry{"release", Touches::session, [](Session& s, const json& c) { s.release(perhaps_true(c, "still")); }},
    Entry{"seek", Touches::session, [](Session& s, const json& c) { s.seek(number(c, "t")); }},
    Entry{"speed", Touches::session, [](Session& s, const json& c) { s.set_speed(number(c, "value")); }},
    Entry{"set", Touches::session,
          [](Session& s, const json& c) { s.set_parameter(word(c, "parameter"), number(c, "value")); }},
    Entry{"input", Touches::session,
          [](Session& s, const json& c) { s.move_input(word(c, "name"), number(c, "value")); }},
    Entry{"method", Touches::session, [](Session& s, const json& c) { s.take_method(method_of(c)); }},
    Entry{"ghost", Touches::session, take_ghost},
    Entry{"drag", Touches::session, drag},
    Entry{"pick", Touches::session, [](Session& s, const json& c) { s.pick(index(c, "body")); }},
    Entry{"open", Touches::session, [](Session& s, const json& c) { s.open_gallery(word(c, "model")); }},
    Entry{"run", Touches::session, [](Session& s, const json& c) { s.run_text(word(c, "text")); }},
    Entry{"save", Touches::file, [](Session& s, const json& c) { s.save_text(word(c, "text")); }},
};

const Entry* entry_of(std::string_view command) {
  const auto found = std::ranges::find(table, command, &Entry::name);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

bool may(const Rights& rights, std::string_view command) {
  const Entry* entry = entry_of(command);
  if (!entry) return false;
  switch (entry->touches) {
    case Touches::connection:
      return true;
    case Touches::session:
      return rights.role == Role::presenter || rights.role == Role::owner;
    case Touches::file:
      return rights.role == Role::presenter && rights.may_save;
    case Touches::unclassified:
      return false;
  }
  return false;
}

std::vector<std::string_view> all_commands() {
  std::vector<std::string_view> names;
  for (const Entry& entry : table) names.push_back(entry.name);
  return names;
}

std::vector<std::string_view> allowed(const Rights& rights) {
  std::vector<std::string_view> names = all_commands();
  std::erase_if(names, [&](std::string_view name) { return !may(rights, name); });
  return names;
}

Result<Command> read_command(std::string text) {
  const json command = json::parse(text, nullptr, false);
  if (command.is_discarded()) return invalid_input("this is no JSON");
  if (!command.is_object()) return invalid_input("a command is an object");
  const auto what = command.find("do");
  if (what == command.end() || !what->is_string()) return invalid_input("a command has a text `do`");
  std::string name = what->get<std::string>();
  if (!entry_of(name)) return invalid_input("there is no such command");
  return Command{std::move(name), std::move(text)};
}

Status obey(Session& session, const Command& command) {
  const Entry* entry = entry_of(command.what);
  if (!entry || !entry->doing) return invalid_input("there is no such command");
  const bool opens = command.what == "run" || command.what == "open";
  if (!session.is_open() && !opens) return invalid_input("there is no model yet");
  try {
    entry->doing(session, json::parse(command.text));
  } catch (const Unfit& unfit) {
    return invalid_input("`" + command.what + "` needs " + unfit.part);
  }
  return {};
}

Result<Asked> asked(const Command& command) {
  const json all = json::parse(command.text);
  try {
    if (command.what == "check") return Asked{number(all, "id"), word(all, "text")};
    if (command.what == "ping") return Asked{number(all, "id"), {}};
    if (command.what == "rate") return Asked{number(all, "fps"), {}};
  } catch (const Unfit&) {
  }
  return invalid_input("`" + command.what + "` has a part that does not fit");
}

}  // namespace continuo::live
